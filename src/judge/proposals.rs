//! Proposes expectations that the present results meet, for a study without any.
//!
//! Every series along an axis that is refined gets one: the order, where its class has one, and the error at the finest
//! level. The room is less than what a worse solver takes: half an order, or twice the error.

use crate::case::{Case, KEYS, Key, Quantity, Sample, Tier, Value};
use crate::judge::paths::{Path, StudyPaths, first_measure};
use crate::judge::verdict::judge_expectation;
use crate::measure::soundness::is_sound;
use crate::study::check::Study;
use crate::study::check::outputs::output_at;
use crate::study::expectation::{Axis, Measure, NEXT_FINER, Selection, SeriesExpectation};
use oedometer_convergence::{Class, ErrorBound, OrderBand, SeriesDemand};
use oedometer_problem::method::Method;

/// Room about an order: less than the half order that it is to catch.
pub const ROOM_OF_ORDER: f64 = 0.25;
/// Room over an error: less than the factor of two that it is to catch, with two digits of the bound.
pub const ROOM_OF_ERROR: f64 = 1.5;
/// More cases than a person reads expectations of; records of more are not kept whole for them.
const MOST_CASES: usize = 1000;
/// Digits behind the first one of a number that has all of them.
const DIGITS: usize = 17;
/// Digits behind the first one that tables show.
const SHOWN: usize = 3;

/// Whether expectations are proposed for a study: it has none, and no race expects any.
pub fn are_wanted(study: &Study) -> bool {
    let expects = !study.expectations.is_empty() || !study.case_expectations.is_empty();
    !expects && !study.is_race && study.planned.len() <= MOST_CASES
}

/// The expectations as TOML, one `[[expect]]` each, in the order of the study; none where it has some already.
pub fn proposals(study: &Study, paths: &StudyPaths<'_>) -> Vec<String> {
    if !are_wanted(study) {
        return Vec::new();
    }
    let all = Axis::REFINEMENTS.into_iter().flat_map(|axis| paths.along(axis));
    all.filter_map(|path| proposal(study, path)).map(|one| to_toml(study, &one)).collect()
}

/// The strictest expectation that a series meets.
fn proposal(study: &Study, path: &Path<'_>) -> Option<SeriesExpectation> {
    // What a check speaks against is nothing to hold to.
    if !path.records.iter().all(|record| is_sound(record)) {
        return None;
    }
    let selection = Selection(selection_of(study, path)?);
    let meets = |(measure, demand): (Measure, SeriesDemand)| {
        let selection = selection.clone();
        let tier = tier_of(study, path);
        let one = SeriesExpectation {
            selection,
            measure,
            reference: None,
            axis: path.axis,
            any_places: false,
            demand,
            tier,
            line: 0,
        };
        let judged = judge_expectation(&one, std::slice::from_ref(path));
        (!judged.is_empty() && judged.iter().all(|judgement| judgement.verdict.pass)).then_some(one)
    };
    let measures = measures_of(study, path);
    let with_order = measures.iter().filter_map(|measure| demand_of(path, measure, true));
    let with_error = measures.iter().filter_map(|measure| demand_of(path, measure, false));
    with_order.chain(with_error).find_map(meets)
}

/// What may be judged, the latest time first: against the scene's own solution, or along steps against the next finer
/// one, whose differences do not end at the error of the mesh.
fn measures_of(study: &Study, path: &Path<'_>) -> Vec<Measure> {
    let own = study.references.first().map(|kind| kind.name());
    let reference = if path.axis == Axis::TimeStep { Some(NEXT_FINER) } else { own };
    let quantity = |time: f64, (quantity, sample)| {
        Some(path.own_measure(&first_measure(quantity, sample, reference?, time)))
    };
    let times = path.records[0].case.time_factors.iter().rev();
    let panels = [
        (Quantity::Pressure, Sample::Points),
        (Quantity::LoadFactor, Sample::Surface),
        (Quantity::Settlement, Sample::Surface),
    ];
    panels.iter().flat_map(|panel| times.clone().filter_map(|time| quantity(*time, *panel))).collect()
}

/// The measured order and error of a series with their room; `None` where they are not what is asked for.
fn demand_of(path: &Path<'_>, measure: &Measure, with_order: bool) -> Option<(Measure, SeriesDemand)> {
    let found = path.summary(measure);
    let finest = found.series.levels().last()?;
    let error = finest.positive_error().ok()?;
    // A bound of 100 % or more would let a result of zero pass.
    let is_result = ROOM_OF_ERROR * error < 1.0;
    if !is_result {
        return None;
    }
    let below = format!("{:.1e}", ROOM_OF_ERROR * error).parse().ok()?;
    let order = found.classification.order.filter(|_| found.classification.class == Class::Asymptotic);
    let band = |order: f64| OrderBand {
        value: (100.0 * order).round() / 100.0,
        minus: ROOM_OF_ORDER,
        plus: ROOM_OF_ORDER,
    };
    let order = if with_order { Some(band(order?)) } else { None };
    let at = Some(ErrorBound { size: finest.size, below, above: 0.0 });
    Some((measure.clone(), SeriesDemand { order, at, ..SeriesDemand::default() }))
}

/// The inputs that tell the series from the others of its study, the method first; `None` where a file has no word for
/// one of them.
fn selection_of(study: &Study, path: &Path<'_>) -> Option<Vec<(&'static Key, Value)>> {
    let case = &path.records[0].case;
    let differs = |key: &Key| study.planned.iter().any(|other| key.get(&other.case) != key.get(case));
    let is_own = |key: &Key| key.tables.contains(&"sweep") && key.in_place_of.is_empty();
    let keys = KEYS.iter().filter(|key| is_own(key) && key.name != path.axis.name());
    let named = keys.filter(|key| key.name == "method" || key.counts_for(case) && differs(key));
    named.map(|key| toml_of(key.get(case)).map(|_| (key, key.get(case)))).collect()
}

fn tier_of(study: &Study, path: &Path<'_>) -> Tier {
    let is_of = |case: &Case| path.records.iter().any(|record| record.case == *case);
    let tiers = study.planned.iter().filter(|planned| is_of(&planned.case)).map(|planned| planned.tier);
    tiers.max().unwrap_or(Tier::Ci)
}

/// A value as a study file has it.
fn toml_of(value: Value) -> Option<String> {
    Some(match value {
        Value::Method(method) => {
            let name = method.to_string();
            if method.built_in().is_some() && Method::named(&name).is_none() {
                return None;
            }
            format!("{name:?}")
        }
        Value::TimeStep(rule) => format!("{{ {} = {:?} }}", rule.kind().word, rule.number()),
        Value::Word(word) => format!("{word:?}"),
        Value::Flag(flag) => flag.to_string(),
        Value::Count(count) => count.to_string(),
        Value::Number(number) => format!("{number:?}"),
        Value::Absent => return None,
    })
}

/// An expectation as a study file has it.
fn to_toml(study: &Study, one: &SeriesExpectation) -> String {
    let mut lines = vec!["[[expect]]".to_owned()];
    let inputs = one.selection.0.iter().filter_map(|(key, value)| Some((key.name, toml_of(*value)?)));
    lines.extend(inputs.map(|(name, value)| format!("{name} = {value}")));
    let measure = &one.measure;
    lines.push(format!("quantity = \"{}\"", measure.quantity.name()));
    if !measure.quantity.is_of_surface() {
        lines.push(format!("sample = \"{}\"", measure.sample.name()));
    }
    if one.axis != Axis::Cells {
        lines.push(format!("axis = \"{}\"", one.axis.name()));
    }
    if study.references.first().is_none_or(|kind| kind.name() != measure.reference) {
        lines.push(format!("reference = \"{}\"", measure.reference));
    }
    lines.push(time_of(study, one));
    if let Some(OrderBand { value, minus, plus }) = one.demand.order {
        lines.push(format!("order = {{ value = {value:?}, minus = {minus:?}, plus = {plus:?} }}"));
    }
    if let Some(at) = one.demand.at {
        lines.push(format!("at = {{ {}, below = {:e} }}", level_of(study, one, at.size), at.below));
    }
    if one.tier == Tier::Full {
        lines.push("tier = \"full\"".to_owned());
    }
    lines.join("\n") + "\n"
}

/// The time of an expectation: its time factor, with no more digits than it takes to name one output of the cases.
fn time_of(study: &Study, one: &SeriesExpectation) -> String {
    let time_factor = one.measure.time_factor;
    let cases = || study.planned.iter().map(|planned| &planned.case);
    let selected = || cases().filter(|case| one.selection.fits_along(one.axis.name(), case));
    let short = |digits: usize| format!("{time_factor:.digits$e}").parse::<f64>().ok();
    let is_named = |typed: &f64| output_at(*typed, selected()) == time_factor;
    let typed = (SHOWN..DIGITS).filter_map(short).find(is_named).unwrap_or(time_factor);
    format!("time_factor = {typed:?}")
}

/// A level of a series in the words of its axis.
fn level_of(study: &Study, one: &SeriesExpectation, size: f64) -> String {
    let cases = || study.planned.iter().map(|planned| &planned.case);
    let of_series = |case: &&Case| one.selection.fits_along(one.axis.name(), case);
    match one.axis {
        Axis::Cells => {
            let is_level = |case: &&Case| (case.cell_size() - size).abs() <= 1e-9 * size;
            let cells = cases().filter(of_series).find(is_level).map_or(0, |case| case.cells);
            format!("cells = {cells}")
        }
        Axis::TimeStep => format!("seconds = {size:?}"),
        Axis::PointsPerCell => format!("points_per_cell = {}", (1.0 / size).round()),
        Axis::WaterBulkModulus => format!("water_bulk_modulus = {:?}", 1.0 / size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{RunOptions, run_study};
    use crate::judge::verdict::{Judgement, judge_paths};
    use crate::record::Record;
    use crate::study::file::StudySource;

    const HEAD: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n";

    fn study_with(text: &str) -> Study {
        let source = StudySource { name: "s.toml".to_owned(), text: text.to_owned() };
        Study::check(&source).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    fn run(study: &Study, tier: Tier) -> Vec<Record> {
        run_study(study, &RunOptions::whole(tier, 1), None, &|_| {}).records
    }

    fn verdicts_on(study: &Study, tier: Tier) -> Vec<Judgement> {
        let records = run(study, tier);
        judge_paths(study, &records, &StudyPaths::of(&records), tier)
    }

    /// The proposed lines of a study, and the study with them.
    fn pasted(text: &str) -> (Vec<String>, Study) {
        let study = study_with(text);
        let records = run(&study, Tier::Full);
        let proposed = proposals(&study, &StudyPaths::of(&records));
        let whole = study_with(&format!("{text}\n{}", proposed.join("\n")));
        (proposed, whole)
    }

    #[test]
    fn what_needs_a_level_of_the_full_tier_is_expected_of_the_full_tier() {
        for tiers in [
            ["ci", "ci", "ci"],
            ["smoke", "smoke", "smoke"],
            ["full", "ci", "ci"],
            ["ci", "full", "smoke"],
            ["smoke", "ci", "full"],
            ["full", "full", "full"],
        ] {
            let sweep = |(cells, tier): (u32, &str)| {
                format!(
                    "[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [{cells}]\ntier = '{tier}'\n"
                )
            };
            let sweeps: String = [4, 8, 16].into_iter().zip(tiers).map(sweep).collect();
            let (proposed, whole) = pasted(&(HEAD.to_owned() + &sweeps));
            assert_eq!(proposed.len(), 1, "{tiers:?}: {proposed:?}");
            let needs_all = tiers.contains(&"full");
            assert_eq!(proposed[0].contains("tier = \"full\""), needs_all, "{tiers:?}: {proposed:?}");
            for (tier, judged) in [(Tier::Ci, usize::from(!needs_all)), (Tier::Full, 1)] {
                let judgements = verdicts_on(&whole, tier);
                assert!(judgements.iter().all(|one| one.verdict.pass), "{tiers:?} {tier:?}: {judgements:?}");
                assert_eq!(judgements.len(), judged, "{tiers:?} {tier:?}");
            }
        }
    }

    #[test]
    fn nothing_is_proposed_of_runs_that_a_check_speaks_against() {
        let text =
            HEAD.to_owned() + "[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [4, 8, 16]\n";
        let study = study_with(&text);
        let mut records = run(&study, Tier::Full);
        assert_eq!(proposals(&study, &StudyPaths::of(&records)).len(), 1);
        records[1].balance[0].solid_mass_drift = 1.0;
        assert_eq!(proposals(&study, &StudyPaths::of(&records)), Vec::<String>::new());
    }

    /// 20 s are `T_v` = 0.244648… in the default column.
    #[test]
    fn a_time_factor_that_follows_from_a_time_is_proposed_with_four_digits() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.times = ['20 s']\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16]\n";
        let (proposed, whole) = pasted(text);
        assert!(proposed.len() == 1 && proposed[0].contains("time_factor = 0.2446\n"), "{proposed:?}");
        let judgements = verdicts_on(&whole, Tier::Full);
        assert!(judgements.len() == 1 && judgements[0].verdict.pass, "{judgements:?}");
    }

    #[test]
    fn each_series_has_an_expectation_of_its_own_in_the_words_of_its_axis_and_inputs() {
        let implicit = "integrator = ['implicit']\n";
        let explicit = "integrator = ['explicit']\n";
        for (swept, series, words) in [
            (
                format!("{implicit}cells = [4, 8, 16]\nporosity = [0.3, 0.4]"),
                2,
                ["method = \"MPM\"\n", "porosity = 0.4\n", "at = { cells = 16, below ="],
            ),
            (
                format!("{implicit}cells = [4]\npoints_per_cell = [2, 3, 4]"),
                1,
                [
                    "axis = \"points_per_cell\"\n",
                    "sample = \"points\"\n",
                    "at = { points_per_cell = 4, below =",
                ],
            ),
            (
                format!(
                    "{implicit}cells = [4]\ntime_step = [{{ seconds = 20.0 }}, {{ seconds = 10.0 }}, {{ seconds = 5.0 }}]"
                ),
                1,
                ["axis = \"time_step\"\n", "reference = \"next-finer\"\n", "at = { seconds = "],
            ),
            (
                format!(
                    "{implicit}cells = [2, 4, 8]\ntime_step = [{{ seconds = 20.0 }}, {{ growth = 0.1 }}]"
                ),
                2,
                [
                    "time_step = { seconds = 20.0 }\n",
                    "time_step = { growth = 0.1 }\n",
                    "at = { cells = 8, below =",
                ],
            ),
            (
                format!("{explicit}cells = [2, 4, 8]\ntime_step = [{{ stable = 0.5 }}, {{ courant = 0.2 }}]"),
                2,
                [
                    "time_step = { stable = 0.5 }\n",
                    "time_step = { courant = 0.2 }\n",
                    "at = { cells = 8, below =",
                ],
            ),
        ] {
            let (proposed, whole) = pasted(&format!("{HEAD}[[sweep]]\nmethod = ['MPM']\n{swept}\n"));
            assert_eq!(proposed.len(), series, "{swept}: {proposed:?}");
            let all = proposed.join("\n");
            for word in words {
                assert!(all.contains(word), "{word}: {all}");
            }
            let judgements = verdicts_on(&whole, Tier::Ci);
            assert_eq!(judgements.len(), series, "each is of one series: {all}");
            assert!(judgements.iter().all(|one| one.verdict.pass), "{judgements:?}");
        }
    }
}
