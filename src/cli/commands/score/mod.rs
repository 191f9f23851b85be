//! `oedometer score`: compares a result of another program with the references of a scene.

mod scored_files;

use crate::case::grouping::distinct;
use crate::case::{Case, Norm, Quantity};
use crate::cli::exit::{Ended, Exit};
use crate::cli::help::EXPERT;
use crate::cli::output::{TableFormat, csv_of, json_of, print_data, print_tables, say, write_document};
use crate::cli::study_files::tell_warnings;
use crate::import::mapping::Axes;
use crate::import::mapping::preset::convention_of;
use crate::record::ERROR_COLUMNS;
use crate::report::junit::{ScoredCase, junit_of_score};
use crate::report::tables::scores;
use crate::score::completeness::{Finding, Lack};
use crate::score::results::{Comparison, Results, Scored};
use crate::score::score_series::ScoredSeries;
use crate::study::asked::Asked;
use crate::study::overrides::Outputs;
use crate::study::solver::Preset;
use oedometer_exact::{ExactError, ReferenceKind};
use oedometer_scenes::Scene;
use oedometer_wording::{count_of, typed};
use std::path::PathBuf;

/// Columns behind those of the errors, for results on several meshes.
const SERIES_COLUMNS: [&str; 3] = ["cells", "order", "class"];

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files of a result: CSV, VTU, PVTU, PVD, .series, legacy VTK, NPZ, HDF5, XDMF, Exodus, gmsh. CSV files are one result, with --cells
    /// one argument per mesh; other files are grouped by their meshes. Patterns with `*` and `?` are expanded
    #[arg(required_unless_present = "show_mapping", value_name = "FILE")]
    results: Vec<PathBuf>,
    /// Benchmark problem that the result is of, like `terzaghi`
    #[arg(long, required_unless_present = "show_mapping", default_value = "", hide_default_value = true)]
    scene: String,
    /// Program that wrote the files: says what its arrays mean. --mapping overrides it key by key
    #[arg(long, value_enum)]
    preset: Option<Preset>,
    /// Seconds per step, where file names contain a step number; comma-separated, one per mesh, where each argument is
    /// a mesh
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    set_time_step: Option<String>,
    /// What the columns mean; see --show-mapping [default: columns t, y, p, `u_y` in SI units]
    #[arg(long, value_name = "FILE.toml")]
    mapping: Option<PathBuf>,
    /// Print a mapping to edit: the default one, that of --scene, or that of --preset
    #[arg(long)]
    show_mapping: bool,
    #[command(flatten)]
    outputs: Outputs,
    /// Largest relative difference between a time and the requested one, or that of another mesh
    #[arg(long, value_name = "SHARE", default_value_t = 1e-3, allow_hyphen_values = true, help_heading = EXPERT)]
    time_tolerance: f64,
    /// Cells over the height of each result, comma-separated: adds orders and classes
    #[arg(long, value_name = "LIST")]
    cells: Option<String>,
    /// Fail (exit code 1) unless the result is complete and every error against the first reference is below this
    /// (relative L2 error; relative error of the settlement)
    #[arg(long, value_name = "ERROR")]
    below: Option<f64>,
    /// Quantities intentionally missing from the files, comma-separated: pressure, `effective_stress`, displacement,
    /// settlement
    #[arg(long, value_name = "QUANTITY", value_delimiter = ',', value_parser = quantity_of)]
    without: Vec<Quantity>,
    /// Fail (exit code 1) if the result is incomplete (volume, height, rows, times), or if something cannot be judged:
    /// the settlement, or nodes at the surface or the base
    #[arg(long)]
    strict: bool,
    /// Write a `JUnit` report of what --below and --strict judge
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Scores and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.show_mapping {
        if let Some(preset) = arguments.preset {
            print_data(preset.text())?;
            return Ok(Exit::Pass);
        }
        let axes = Scene::named(&arguments.scene).map_or(Axes::Column, Axes::of);
        print_data(convention_of(axes))?;
        return Ok(Exit::Pass);
    }
    if arguments.junit.is_some() && !arguments.strict && arguments.below.is_none() {
        return Err(Ended::usage("`--junit` has no verdict to report: add --below ERROR or --strict"));
    }
    let tolerance = arguments.time_tolerance;
    if !(0.0..1.0).contains(&tolerance) {
        return Err(Ended::usage(format!(
            "`--time-tolerance {tolerance}` is invalid: expected a number from 0 to below 1"
        )));
    }
    let asked = Asked::of_scene(&arguments.scene, &arguments.outputs)?;
    tell_warnings(&asked.study);
    // Whatever the files have, there is nothing to compare them with.
    if asked.references.contains(&ReferenceKind::Footing) {
        return Err(ExactError::NoFields.into());
    }
    let case = asked.case();
    let (mapping, mut runs) = scored_files::read(arguments, case, &asked.requested)?;
    for run in &mut runs {
        run.leave_out(&arguments.without);
    }
    let are_cells_found = arguments.cells.is_none();
    let comparison = Comparison { tolerance, are_cells_found, ..asked.comparison(&mapping) };
    let mut results = Results::of(runs, &comparison)?;
    let series = results.join_meshes();
    if let Some(series) = &series {
        results.diagnose_water(series)?;
    }
    let lacks = results.all.iter().flat_map(|scored| arguments.lacks_of(scored, &results)).collect();
    let reference = comparison.references.first().map(|kind| kind.name());
    let errors = arguments.below.map(|bound| errors_below(bound, &results.all, reference)).transpose()?;
    let judged = [lacks, errors.unwrap_or_default()];
    lead(&results, arguments, &judged)?;
    match arguments.format {
        TableFormat::Json => print_data(&json_of(&results.scores())?)?,
        TableFormat::Csv => {
            print_data(&errors_csv(&results, series.as_deref())?)?;
        }
        _ => {
            let mut tables = Vec::new();
            tables.extend(series.as_deref().map(scores::series_table));
            for scored in &results.all {
                let title = format!("{}: {}", arguments.scene, scored.name());
                tables.push(scores::errors_table(&scored.score, &title));
            }
            print_tables(&tables, arguments.format)?;
        }
    }
    say!("{}", groups_of(case));
    tell(&results, arguments, &judged);
    let passes = judged.iter().flatten().all(|case| case.failure.is_none());
    if let Some(path) = &arguments.junit {
        let notes = results.all.iter().flat_map(|scored| {
            scored.score.diagnosis.iter().map(move |sentence| format!("{}: {sentence}", scored.name()))
        });
        write_document(path, &junit_of_score(&arguments.scene, &judged.concat(), notes)?)?;
    }
    Ok(if passes || !arguments.is_gate() { Exit::Pass } else { Exit::VerdictFailed })
}

/// The first lines: what fails, and what seems to be wrong.
fn lead(
    results: &Results,
    arguments: &Arguments,
    [lacks, errors]: &[Vec<ScoredCase>; 2],
) -> anyhow::Result<()> {
    let is_gate = arguments.is_gate();
    let lacks = lacks.iter().filter(|_| is_gate);
    let reasons: Vec<&String> = errors.iter().chain(lacks).filter_map(|case| case.failure.as_ref()).collect();
    let more = match reasons.len() {
        0 | 1 => String::new(),
        all => format!(" (and {} more below)", all - 1),
    };
    match (reasons.first(), arguments.below) {
        (Some(first), _) => say!("✗ {first}{more}"),
        (None, Some(bound)) => {
            say!("✓ {} below {bound:e}", count_of(errors.len(), "error is", "errors are"));
        }
        (None, None) if is_gate => say!("✓ the results are complete"),
        (None, None) => {}
    }
    for scored in &results.all {
        let name = arguments.name_of(scored, results);
        for sentence in &scored.score.diagnosis {
            say!("diagnosis: {name}{sentence}");
            if arguments.format == TableFormat::Markdown {
                print_data(&format!("**Diagnosis:** {name}{sentence}\n\n"))?;
            }
        }
    }
    Ok(())
}

/// The last lines: what is incomplete, notes, and each error that is too large.
fn tell(results: &Results, arguments: &Arguments, [lacks, errors]: &[Vec<ScoredCase>; 2]) {
    let is_gate = arguments.is_gate();
    let word = if is_gate { "fail" } else { "warning" };
    for lack in distinct(lacks.iter().filter_map(|case| case.failure.as_ref())) {
        say!("{word}: {lack}");
    }
    for scored in &results.all {
        let name = arguments.name_of(scored, results);
        for note in &scored.run.notes {
            say!("note: {name}{note}");
        }
        for lack in scored.score.not_judged.iter().filter(|_| !arguments.strict) {
            let but = if is_gate { "; `--strict` fails on this" } else { "" };
            say!("note: {name}{}{but}", lack.sentence);
        }
    }
    if is_gate && !results.are_times_known() {
        say!("note: missing times were not checked: name the required times with --time-factor");
    }
    for failure in errors.iter().filter_map(|case| case.failure.as_ref()) {
        say!("fail: {failure}");
    }
}

impl Arguments {
    /// Whether results are judged: then incomplete ones fail, with `--strict` also those that leave something unjudged.
    fn is_gate(&self) -> bool {
        self.strict || self.below.is_some()
    }

    /// The name of a result before a sentence, where there are several or they are judged.
    fn name_of(&self, scored: &Scored, results: &Results) -> String {
        let is_named = self.is_gate() || results.all.len() > 1;
        if is_named { format!("{}: ", scored.name()) } else { String::new() }
    }

    /// What a result lacks, or that it is complete.
    fn lacks_of(&self, scored: &Scored, results: &Results) -> Vec<ScoredCase> {
        let not_judged = scored.score.not_judged.iter().filter(|_| self.strict);
        let case = |lack: &Finding| {
            // What the mapping does not declare is the same in every result.
            let is_of_mapping = lack.name == Lack::Undeclared;
            let name = if is_of_mapping { String::new() } else { self.name_of(scored, results) };
            let (word, sentence) = (lack.name.name(), &lack.sentence);
            let subject = format!("{}/{word}", scored.name());
            ScoredCase { subject, failure: Some(format!("{name}{word}: {sentence}")) }
        };
        let lacks: Vec<ScoredCase> = scored.score.warnings.iter().chain(not_judged).map(case).collect();
        if !lacks.is_empty() {
            return lacks;
        }
        let is_nothing = scored.score.errors.is_empty() && scored.score.unresolved.is_empty();
        let failure =
            is_nothing.then(|| format!("{}nothing of it is compared", self.name_of(scored, results)));
        vec![ScoredCase { subject: format!("{}/complete", scored.name()), failure }]
    }
}

/// A quantity by its name.
fn quantity_of(name: &str) -> Result<Quantity, String> {
    Quantity::named(name).ok_or_else(|| format!("expected one of {}", Quantity::NAMES.join(", ")))
}

/// The size of what the reference neglects, in one line.
fn groups_of(case: &Case) -> String {
    let soil = &case.material;
    format!(
        "groups: storage n E_oed/K_w = {:.2e}, finite strain m_vl q = {:.2e}; errors of this size can come from \
         the reference's assumptions",
        soil.oedometric_modulus() / soil.coupling_modulus(),
        case.column.load / soil.oedometric_modulus()
    )
}

/// The errors as CSV. Several results have their name in front; several meshes have their cells, order and class behind.
fn errors_csv(results: &Results, series: Option<&[ScoredSeries]>) -> anyhow::Result<String> {
    let several = results.all.len() > 1;
    let of_series = series.map_or(&[][..], |_| &SERIES_COLUMNS);
    let header =
        several.then_some("result").into_iter().chain(ERROR_COLUMNS).chain(of_series.iter().copied());
    let rows = results.all.iter().enumerate().flat_map(|(place, scored)| {
        let name = scored.run.files.first().filter(|_| several).map(|file| file.display().to_string());
        scored.score.errors.iter().map(move |row| {
            let known = series.map(|series| series_fields(results.series_of_row(place, row, series)));
            name.clone().into_iter().chain(row.csv_fields()).chain(known.into_iter().flatten()).collect()
        })
    });
    csv_of(header, rows)
}

/// The fields of [`SERIES_COLUMNS`]: empty if a norm has no series, the order also if the class has none.
fn series_fields(series_of_mesh: Option<(usize, &ScoredSeries)>) -> [String; 3] {
    let Some((cells, series)) = series_of_mesh else { return Default::default() };
    let class = &series.classification;
    let order = class.order.map_or(String::new(), |order| format!("{order:.16e}"));
    [cells.to_string(), order, class.class.name().to_owned()]
}

/// Share of the load, or of the final settlement, below which an exact value all but vanishes and errors are judged on
/// that scale.
const VANISHING: f64 = 1e-3;

/// Whether every main error against the first reference is below a bound; NaN is not. Where the exact value all but
/// vanishes, as a displacement does at `t = 0`, the error is judged on the scale of the load.
fn errors_below(bound: f64, results: &[Scored], reference: Option<&str>) -> anyhow::Result<Vec<ScoredCase>> {
    if !(bound.is_finite() && bound > 0.0) {
        return Err(Ended::usage(format!("`--below {bound}` is invalid: expected a positive number")));
    }
    let is_judged = |of_row: &str| Some(of_row) == reference;
    let mut findings = Vec::new();
    for scored in results {
        let rows = scored
            .score
            .errors
            .iter()
            .filter(|row| matches!(row.norm, Norm::L2 | Norm::Relative) && is_judged(&row.reference));
        let scaled =
            |quantity, time_factor, absolute| (quantity, time_factor, absolute, "error over the load");
        let errors = rows.map(|row| {
            // An exact value that all but vanishes: an error relative to it says nothing.
            if row.absolute.abs() < VANISHING * row.value.abs() {
                return scaled(row.quantity, row.time_factor, row.absolute);
            }
            let unit = if row.quantity == Quantity::Settlement { "relative error" } else { "L2 error" };
            (row.quantity, row.time_factor, row.value, unit)
        });
        let vanished = scored.score.unresolved.iter().filter(|row| is_judged(&row.reference));
        let vanished = vanished.map(|row| scaled(row.quantity, row.time_factor, row.absolute));
        findings.extend(errors.chain(vanished).map(|error| finding_below(bound, &scored.name(), error)));
    }
    if findings.is_empty() {
        return Err(Ended::with(Exit::NothingSelected, "the result has no error that can be judged"));
    }
    Ok(findings)
}

/// One error of a result held below a bound; NaN is not.
fn finding_below(
    bound: f64,
    file: &str,
    (quantity, time_factor, error, unit): (Quantity, f64, f64, &str),
) -> ScoredCase {
    let (name, time) = (quantity.name(), typed(time_factor));
    let scale = match (unit, quantity) {
        ("error over the load", Quantity::Displacement | Quantity::Settlement) => {
            "error over the final settlement"
        }
        _ => unit,
    };
    let article = if scale.starts_with('e') || scale.starts_with('L') { "an" } else { "a" };
    let failure =
        format!("{file}: {name} at T_v = {time} has {article} {scale} of {error:.3e}, not below {bound:e}");
    let passes = error.abs() < bound;
    ScoredCase { subject: format!("{file}/{name}/T_v={time}"), failure: (!passes).then_some(failure) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::quantity::Sample;
    use crate::import::run::Run;
    use crate::record::ErrorRow;
    use crate::score::Score;

    fn end_of(findings: &[ScoredCase]) -> Exit {
        let passes = findings.iter().all(|finding| finding.failure.is_none());
        if passes { Exit::Pass } else { Exit::VerdictFailed }
    }

    #[test]
    fn every_quantity_of_every_result_is_held_below_the_bound() {
        let row = |quantity, norm, reference: &str, value: f64| ErrorRow {
            time_factor: 0.1,
            quantity,
            sample: Sample::Points,
            norm,
            reference: reference.to_owned(),
            value,
            absolute: value,
        };
        let rows = [
            (Quantity::Pressure, Norm::L2),
            (Quantity::EffectiveStress, Norm::L2),
            (Quantity::Displacement, Norm::L2),
            (Quantity::Settlement, Norm::Relative),
        ];
        let exit = |wrong: usize, value: f64| {
            // Each result has all rows, and what another reference or another norm says does not count.
            let result = |result: usize| {
                let mut score = Score::default();
                for (place, (quantity, norm)) in rows.into_iter().enumerate() {
                    let is_wrong = result * rows.len() + place == wrong;
                    score.errors.push(row(quantity, norm, "own", if is_wrong { value } else { 0.9e-3 }));
                    score.errors.push(row(quantity, norm, "other", 1.0));
                    score.errors.push(row(quantity, Norm::Linf, "own", 1.0));
                }
                Scored { run: Run::default(), score }
            };
            end_of(&errors_below(1e-3, &[result(0), result(1), result(2)], Some("own")).expect("errors"))
        };
        for wrong in 0..3 * rows.len() {
            for (value, end) in [
                (0.9e-3, Exit::Pass),
                (-0.9e-3, Exit::Pass),
                (1e-3, Exit::VerdictFailed),
                (1.1e-3, Exit::VerdictFailed),
                (-1.1e-3, Exit::VerdictFailed),
                (f64::NAN, Exit::VerdictFailed),
            ] {
                assert_eq!(exit(wrong, value), end, "{value} at {wrong}");
            }
        }
        assert!(errors_below(1e-3, &[], Some("own")).is_err(), "nothing to judge is no pass");
    }

    #[test]
    fn what_vanishes_is_judged_over_the_load_and_nothing_to_judge_is_no_pass() {
        use crate::score::Unresolved;

        let row = |value: f64, absolute: f64| ErrorRow {
            time_factor: 0.1,
            quantity: Quantity::Displacement,
            sample: Sample::Nodes,
            norm: Norm::L2,
            reference: "own".to_owned(),
            value,
            absolute,
        };
        let exit = |errors: Vec<ErrorRow>, unresolved: Vec<Unresolved>| {
            let scored =
                Scored { run: Run::default(), score: Score { errors, unresolved, ..Score::default() } };
            let judged = errors_below(1e-2, &[scored], Some("own"));
            judged.map(|findings| end_of(&findings)).map_err(|error| Exit::of(&error))
        };
        // The exact value all but vanishes where the error over the load is below a thousandth of the relative one.
        for (value, absolute, end) in [
            (50.0, 0.009, Exit::Pass),
            (-50.0, -0.009, Exit::Pass),
            (50.0, 0.011, Exit::VerdictFailed),
            (8.0, 0.009, Exit::VerdictFailed),
            (0.009, 1.0, Exit::Pass),
            (0.011, 1.0, Exit::VerdictFailed),
        ] {
            assert_eq!(exit(vec![row(value, absolute)], Vec::new()), Ok(end), "{value} {absolute}");
        }
        let unresolved = |reference: &str, absolute| Unresolved {
            time_factor: 0.0,
            quantity: Quantity::Displacement,
            sample: Sample::Nodes,
            reference: reference.to_owned(),
            absolute,
        };
        for (absolute, end) in
            [(-0.009, Exit::Pass), (0.011, Exit::VerdictFailed), (f64::NAN, Exit::VerdictFailed)]
        {
            assert_eq!(exit(Vec::new(), vec![unresolved("own", absolute)]), Ok(end), "{absolute}");
        }
        assert_eq!(exit(Vec::new(), vec![unresolved("other", 1.0)]), Err(Exit::NothingSelected));
        let scored = [Scored { run: Run::default(), score: Score::default() }];
        for bound in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let told = errors_below(bound, &scored, Some("own")).expect_err("no bound").to_string();
            assert_eq!(told, format!("`--below {bound}` is invalid: expected a positive number"));
        }
    }
}
