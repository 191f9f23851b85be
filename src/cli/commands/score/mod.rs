//! `oedometer score`: hold an external result against the references of a scene.

pub mod gate;
pub mod results;
pub mod scored_files;

use crate::case::Case;
use crate::cli::commands::score::results::{Held, Results};
use crate::cli::commands::score::scored_files::Typed;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, csv_of, json_of, print_tables};
use crate::cli::overrides;
use crate::cli::overrides::StudyLines;
use crate::cli::stream::{print_data, say};
use crate::import::mapping::convention::{CONVENTION, PLANE_CONVENTION};
use crate::import::mapping::preset::Preset;
use crate::judge::score::score_series::ScoredSeries;
use crate::record::ERROR_COLUMNS;
use crate::render::tables::scores;
use crate::study::check::Purpose;
use crate::study::check::Study;
use oedometer_mpm::scene::SceneKind;
use std::path::PathBuf;

/// Columns behind those of the errors, of results on several meshes.
const SERIES_COLUMNS: [&str; 3] = ["cells", "order", "class"];

/// Arguments of `score`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files of a result: CSV, VTU, PVD, .series, legacy VTK, NPZ, HDF5, XDMF. CSV files are one result, with --cells
    /// one argument a mesh; other files are grouped by their meshes. `*` and `?` stand for several
    #[arg(required_unless_present = "show_mapping", value_name = "FILE")]
    results: Vec<PathBuf>,
    /// Scene that the result is of, like `terzaghi`
    #[arg(long, required_unless_present = "show_mapping", default_value = "")]
    scene: String,
    /// Program that wrote the files: what its arrays mean; a --mapping goes over it
    #[arg(long, value_enum)]
    preset: Option<Preset>,
    /// Seconds from one numbered step to the next, where file names have the number of the step
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    set_time_step: Option<f64>,
    /// What the columns mean; see --show-mapping. Where none is given, the columns are t, y, p, `u_y`
    #[arg(long, value_name = "FILE.toml")]
    mapping: Option<PathBuf>,
    /// Print the mapping that holds where none is given, as a start for one's own; with --scene that
    /// of the scene, with --preset that of the program
    #[arg(long)]
    show_mapping: bool,
    /// Hold the result against this reference only
    #[arg(long, value_name = "NAME")]
    reference: Option<String>,
    /// Time factors `T_v` that the result must have, comma-separated; its other times are left out
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    time_factor: Option<String>,
    /// How far, relative, a time may lie from the one that it stands for: the requested one, or that
    /// of another mesh
    #[arg(long, value_name = "SHARE", default_value_t = 1e-3, allow_hyphen_values = true)]
    time_tolerance: f64,
    /// Cells over the height of each result, comma-separated: adds orders and classes
    #[arg(long, value_name = "LIST")]
    cells: Option<String>,
    /// Fail with exit code 1 where an error (L2, settlement relative) against the first reference is
    /// not below this, or where the result is not whole
    #[arg(long, value_name = "ERROR")]
    below: Option<f64>,
    /// Fail with exit code 1 where the result is not whole: volume, height, rows, times
    #[arg(long)]
    strict: bool,
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
        if let Some(preset) = arguments.preset {
            print_data(preset.text())?;
            return Ok(Exit::Pass);
        }
        let is_plane = SceneKind::named(&arguments.scene).is_some_and(SceneKind::has_plane_fields);
        print_data(if is_plane { PLANE_CONVENTION } else { CONVENTION })?;
        return Ok(Exit::Pass);
    }
    let tolerance = arguments.time_tolerance;
    if !(0.0..1.0).contains(&tolerance) {
        return Err(Ended::usage(format!(
            "`--time-tolerance {tolerance}` is no share: give a number from 0 to below 1"
        )));
    }
    let (study, requested) = study_of(&Asked {
        scene: &arguments.scene,
        reference: arguments.reference.as_deref(),
        time_factors: arguments.time_factor.as_deref(),
        assignments: &arguments.assignments,
    })?;
    let Some(planned) = study.planned.first() else {
        return Err(Ended::usage("the assignments leave no column"));
    };
    let case = &planned.case;
    let typed = Typed {
        results: &arguments.results,
        cells: arguments.cells.as_deref(),
        preset: arguments.preset,
        mapping: arguments.mapping.as_deref(),
        time_step: arguments.set_time_step,
    };
    let (mapping, runs) = scored_files::of(&typed, case)?;
    let names: Vec<PathBuf> = runs.iter().filter_map(|run| run.files.first().cloned()).collect();
    let held = Held {
        case,
        mapping: &mapping,
        references: &study.references.iter().map(|kind| kind.of_soil(&case.material)).collect::<Vec<_>>(),
        requested: &requested,
        tolerance,
        are_cells_found: arguments.cells.is_none(),
    };
    let mut results = Results::of(runs, &held)?;
    let series = results.series(case);
    if let Some((series, cells)) = &series {
        results.keep_series(series, cells);
    }
    match arguments.format {
        TableFormat::Json => print_data(&json_of(&results.scores())?)?,
        TableFormat::Csv => {
            print_data(&errors_csv(&results, &names, series.as_ref().map(|(series, _)| &series[..]))?)?;
        }
        _ => {
            let mut tables = Vec::new();
            for one in &results.all {
                let title = format!("{}: {}", case.scene.name(), one.name());
                tables.push(scores::errors_table(&one.score, &title));
            }
            if let Some((series, cells)) = &series {
                tables.push(scores::series_table(series, cells));
            }
            print_tables(&tables, arguments.format)?;
        }
    }
    say!("{}", groups_of(case));
    gate::judge(&results, arguments.below, arguments.strict, held.references)
}

/// What a result is held against, as it was asked for.
pub struct Asked<'a> {
    /// The scene.
    pub scene: &'a str,
    /// One of its references; all where none is named.
    pub reference: Option<&'a str>,
    /// Time factors that the result must have, comma-separated.
    pub time_factors: Option<&'a str>,
    /// Dotted keys of a study file with their values.
    pub assignments: &'a [String],
}

/// The scene with the column that the result is of, as a study with one case, and the time factors
/// that were asked for.
///
/// # Errors
/// What is wrong with the scene or an assignment.
pub fn study_of(asked: &Asked) -> anyhow::Result<(Study, Vec<f64>)> {
    let mut lines = StudyLines::of("score", asked.scene, "`--scene`")?;
    lines.give_outputs(asked.reference, asked.time_factors)?;
    lines.assign(asked.assignments)?;
    lines.refuse_without_effect(&overrides::OF_RUNS)?;
    let is_requested = lines.has("output.time_factors");
    // No grid of this program has to fit the body that another one solved.
    let sweep = ["method = [\"GIMP-SRI-patch\"]", "cells = [1]"].map(str::to_owned);
    let study = lines.study_for(Purpose::Theory, sweep)?;
    let requested = match study.planned.first() {
        Some(planned) if is_requested => planned.case.time_factors.to_vec(),
        _ => Vec::new(),
    };
    Ok((study, requested))
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

/// The errors as CSV, of several results with the name of each in front; of several meshes with their cells, and the
/// order and class of the main norms behind.
fn errors_csv(
    results: &Results,
    names: &[PathBuf],
    series: Option<&[ScoredSeries]>,
) -> anyhow::Result<String> {
    let several = results.all.len() > 1;
    let of_series = series.map_or(&[][..], |_| &SERIES_COLUMNS);
    let header =
        several.then_some("result").into_iter().chain(ERROR_COLUMNS).chain(of_series.iter().copied());
    let rows = results.all.iter().zip(names).enumerate().flat_map(|(place, (one, name))| {
        let name = several.then(|| name.display().to_string());
        one.score.errors.iter().map(move |row| {
            let known = series.map(|series| series_fields(results.series_of_row(place, row, series)));
            name.clone().into_iter().chain(row.csv_fields()).chain(known.into_iter().flatten()).collect()
        })
    });
    csv_of(header, rows)
}

/// The fields of [`SERIES_COLUMNS`]: empty where a norm has no series, the order where the class allows none.
fn series_fields(found: Option<(usize, &ScoredSeries)>) -> [String; 3] {
    let Some((cells, series)) = found else { return Default::default() };
    let class = &series.classification;
    let order = class.order.map_or(String::new(), |order| format!("{order:.16e}"));
    [cells.to_string(), order, class.class.name().to_owned()]
}
