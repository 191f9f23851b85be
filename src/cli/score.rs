//! `oedometer score`: hold somebody else's result against the references of a scene.

use super::exit::{Ended, Exit};
use super::output::{TableFormat, print_tables};
use super::overrides::{self, StudyLines};
use crate::assess::norms::Norm;
use crate::assess::score::{Score, score, series_of};
use crate::exact::ReferenceKind;
use crate::import::{CONVENTION, Mapping, states_of};
use crate::record::{ERROR_COLUMNS, Quantity};
use crate::render::scores;
use crate::scene::{SceneKind, column_parameters};
use crate::study::{Case, Study, StudySource};
use std::path::{Path, PathBuf};

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV files of one result; with --cells one file a mesh
    #[arg(required_unless_present = "show_mapping", value_name = "RESULT.csv")]
    results: Vec<PathBuf>,
    /// Scene that the result is of, like `terzaghi`
    #[arg(long, required_unless_present = "show_mapping", default_value = "")]
    scene: String,
    /// What the columns mean; see --show-mapping. Where none is given, the columns are t, y, p, `u_y`
    #[arg(long, value_name = "FILE.toml")]
    mapping: Option<PathBuf>,
    /// Print the mapping that holds where none is given, as a start for one's own
    #[arg(long)]
    show_mapping: bool,
    /// Hold the result against this reference only
    #[arg(long, value_name = "NAME")]
    reference: Option<String>,
    /// Cells over the height of each result, comma-separated: adds orders and classes
    #[arg(long, value_name = "LIST")]
    cells: Option<String>,
    /// Fail with exit code 1 where an error (L2, settlement relative) against the first reference is
    /// not below this
    #[arg(long, value_name = "ERROR")]
    below: Option<f64>,
    /// Set a dotted key of a study file, like material.porosity=0.45
    #[arg(long = "set", value_name = "KEY=VALUE")]
    assignments: Vec<String>,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Scores and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.show_mapping {
        print!("{CONVENTION}");
        return Ok(Exit::Pass);
    }
    let mapping = mapping_of(arguments.mapping.as_deref())?;
    let study = study_of(arguments)?;
    let Some(planned) = study.planned.first() else {
        return Err(Ended::usage("the assignments leave no column"));
    };
    let case = &planned.case;
    let references: Vec<ReferenceKind> =
        study.references.iter().map(|kind| SceneKind::reference_for(*kind, &case.material)).collect();
    let files: Vec<Vec<PathBuf>> = match &arguments.cells {
        Some(_) => arguments.results.iter().map(|file| vec![file.clone()]).collect(),
        None => vec![arguments.results.clone()],
    };
    let scores: Vec<Score> = files
        .iter()
        .map(|files| score_of(files, &mapping, case, &references))
        .collect::<anyhow::Result<_>>()?;
    let mut tables = Vec::new();
    for (score, files) in scores.iter().zip(&files) {
        let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        tables.push(scores::errors_table(score, &format!("{}: {}", case.scene.name(), names.join(", "))));
    }
    if let Some(typed) = &arguments.cells {
        let levels = levels_of(typed, &scores)?;
        let cells: Vec<usize> = levels.iter().map(|(cells, _)| *cells).collect();
        tables.push(scores::series_table(&series_of(&levels, case.column.height), &cells));
    }
    match arguments.format {
        TableFormat::Json => println!("{}", serde_json::to_string_pretty(&scores)?),
        TableFormat::Csv => print!("{}", csv_of(&scores, &arguments.results)?),
        _ => print_tables(&tables, arguments.format)?,
    }
    eprintln!("{}", groups_of(case));
    judge(arguments.below, &scores, references.first().map(|kind| kind.name()))
}

/// The declared meaning of the columns.
fn mapping_of(path: Option<&Path>) -> anyhow::Result<Mapping> {
    let Some(path) = path else {
        eprintln!(
            "note: no --mapping, so t is in s, y is the initial height over the base in m, p is in Pa and positive \
             in compression, u_y is in m and positive upward; --show-mapping prints this as a file to change"
        );
        return Ok(Mapping::convention()?);
    };
    let text = std::fs::read_to_string(path)
        .map_err(|error| Ended::usage(format!("cannot read the mapping {}: {error}", path.display())))?;
    Ok(Mapping::read(&StudySource { name: path.display().to_string(), text })?)
}

/// The scene with the column that the result is of, as a study with one case.
fn study_of(arguments: &Arguments) -> anyhow::Result<Study> {
    let mut lines = StudyLines::default();
    lines.give("title", "\"score\"", "`score`")?;
    lines.give("scene", &overrides::quoted(&arguments.scene), "`--scene`")?;
    if let Some(reference) = &arguments.reference {
        lines.give("output.references", &format!("[{}]", overrides::quoted(reference)), "`--reference`")?;
    }
    lines.assign(&arguments.assignments)?;
    lines.refuse_without_effect(&overrides::OF_RUNS)?;
    lines.study_with(["method = [\"GIMP-SRI-patch\"]", "cells = [1]"].map(str::to_owned))
}

fn score_of(
    files: &[PathBuf],
    mapping: &Mapping,
    case: &Case,
    references: &[ReferenceKind],
) -> anyhow::Result<Score> {
    let states = states_of(files, mapping, case.column.height, case.seconds_per_time_factor())?;
    Ok(score(&column_parameters(&case.column, &case.material), references, &states, mapping.sample)?)
}

/// Results from the coarsest mesh to the finest.
fn levels_of(typed: &str, scores: &[Score]) -> anyhow::Result<Vec<(usize, Score)>> {
    let cells: Vec<usize> = typed
        .split(',')
        .map(|entry| entry.trim().parse().ok().filter(|cells| *cells > 0))
        .collect::<Option<_>>()
        .ok_or_else(|| Ended::usage(format!("`--cells {typed}` is no list of numbers from 1 on")))?;
    if cells.len() != scores.len() {
        return Err(Ended::usage(format!(
            "`--cells {typed}` has {} numbers for {} results: give one a result",
            cells.len(),
            scores.len()
        )));
    }
    let mut levels: Vec<(usize, Score)> = cells.into_iter().zip(scores.iter().cloned()).collect();
    levels.sort_by_key(|(cells, _)| *cells);
    Ok(levels)
}

/// Which theory can hold, in one line.
fn groups_of(case: &Case) -> String {
    let soil = &case.material;
    format!(
        "groups: storage n E_oed/K_w = {:.2e}, finite strain m_vl q = {:.2e}; an error of their size is the model's, \
         not the solver's",
        soil.oedometric_modulus() / soil.coupling_modulus(),
        case.column.load / soil.oedometric_modulus()
    )
}

fn csv_of(scores: &[Score], results: &[PathBuf]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let several = scores.len() > 1;
    let mut header = ERROR_COLUMNS.to_vec();
    if several {
        header.insert(0, "result");
    }
    writer.write_record(&header)?;
    for (score, result) in scores.iter().zip(results) {
        for row in &score.errors {
            let mut fields = row.csv_fields().to_vec();
            if several {
                fields.insert(0, result.display().to_string());
            }
            writer.write_record(&fields)?;
        }
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Whether every main error against the first reference is below a bound; NaN is not.
fn judge(below: Option<f64>, scores: &[Score], reference: Option<&str>) -> anyhow::Result<Exit> {
    let Some(bound) = below else { return Ok(Exit::Pass) };
    if !(bound.is_finite() && bound > 0.0) {
        return Err(Ended::usage(format!("`--below {bound}` is no bound: give a positive number")));
    }
    let judged = scores.iter().flat_map(|score| &score.errors).filter(|row| {
        matches!(row.norm, Norm::L2 | Norm::Relative) && Some(row.reference.as_str()) == reference
    });
    let mut any = false;
    let mut exit = Exit::Pass;
    for row in judged {
        any = true;
        // Written so that what is no number fails.
        let passes = row.value.abs() < bound;
        if !passes {
            let unit = if row.quantity == Quantity::Settlement { "relative" } else { "L2" };
            eprintln!(
                "fail: {} at T_v = {} has a {unit} error of {:.3e}, not below {bound:e}",
                row.quantity.name(),
                row.time_factor,
                row.value
            );
            exit = Exit::VerdictFailed;
        }
    }
    if any {
        Ok(exit)
    } else {
        Err(Ended::with(Exit::NothingSelected, "the result has no error that could be judged"))
    }
}
