//! What is scored: the meaning of the files, and their runs with numbers of cells.

use crate::case::Case;
use crate::cli::exit::Ended;
use crate::cli::stream::say;
use crate::import::mapping::Mapping;
use crate::import::mapping::preset::Preset;
use crate::import::raw_row::SolvedBody;
use crate::import::runs::{Given, Run, are_tables, files_of, run_of_tables, runs_of_arrays};
use crate::study::file::StudySource;
use oedometer_formats::input_file;
use std::path::{Path, PathBuf};

/// What a user types of files and their meaning.
pub struct Typed<'a> {
    /// Files and patterns.
    pub results: &'a [PathBuf],
    /// Numbers of cells, one a result.
    pub cells: Option<&'a str>,
    /// The program that wrote the files.
    pub preset: Option<Preset>,
    /// A mapping of one's own.
    pub mapping: Option<&'a Path>,
    /// Seconds from one numbered step to the next.
    pub time_step: Option<f64>,
}

/// The meaning of the files that were named, and their runs.
pub fn of(typed: &Typed, case: &Case) -> anyhow::Result<(Mapping, Vec<Run>)> {
    let column = &case.column;
    let body = SolvedBody {
        height: column.height,
        length: case.scene.has_plane_fields().then_some(column.extent()),
        seconds_per_time_factor: case.seconds_per_time_factor(),
    };
    let given = files_of(typed.results)?;
    let is_tables = are_tables(&given)?;
    let mut mapping = mapping_of(typed, case, is_tables)?;
    if let Some(step) = typed.time_step {
        if !(step.is_finite() && step > 0.0) {
            return Err(Ended::usage(format!("`--set-time-step {step}` is no step: give seconds above 0")));
        }
        mapping.time.step = Some(step);
    }
    let mut runs = if is_tables {
        tables(typed.cells, given, &mapping, body)?
    } else {
        runs_of_arrays(&given, &mapping, body)?
    };
    if let Some(cells) = typed.cells {
        let cells = cells_of(cells, runs.len())?;
        for (run, cells) in runs.iter_mut().zip(cells) {
            run.cells = Some(cells);
        }
    }
    if mapping.is_sample_open
        && let Some(sample) = runs.iter().find_map(|run| run.sample)
    {
        mapping.sample = sample;
    }
    Ok((mapping, runs))
}
/// The runs of tables: one, or with numbers of cells one an argument.
fn tables(
    cells: Option<&str>,
    given: Vec<Given>,
    mapping: &Mapping,
    body: SolvedBody,
) -> anyhow::Result<Vec<Run>> {
    let groups: Vec<_> = match cells {
        None => vec![given.into_iter().flat_map(|one| one.files).collect()],
        Some(typed) => {
            cells_of(typed, given.len())?;
            given.into_iter().map(|one| one.files).collect()
        }
    };
    groups.into_iter().map(|files| Ok(run_of_tables(files, mapping, body)?)).collect()
}

/// The declared meaning of the columns or arrays.
fn mapping_of(typed: &Typed, case: &Case, is_tables: bool) -> anyhow::Result<Mapping> {
    let is_plane = case.scene.has_plane_fields();
    let own = typed.mapping.map(source_of).transpose()?;
    let preset = typed.preset.or_else(|| (!is_tables && own.is_none()).then_some(Preset::Meshio));
    if let Some(preset) = preset {
        if typed.preset.is_none() {
            say!(
                "note: no --preset and no --mapping, so the arrays are looked for by the names of --preset meshio: \
                 pressure, displacement and their like, in SI, pressure positive in compression"
            );
        }
        return Ok(preset.mapping(own.as_ref(), is_plane)?);
    }
    let Some(source) = own else {
        let along = if is_plane {
            ", x is the initial distance from the crest of the load in m, u_x is in m and positive away from it"
        } else {
            ""
        };
        say!(
            "note: no --mapping, so t is in s, y is the initial height over the base in m, p is in Pa and positive \
             in compression, u_y is in m and positive upward{along}; --show-mapping prints this as a file to change"
        );
        return Ok(Mapping::convention(is_plane)?);
    };
    let mapping = Mapping::read(&source)?;
    if is_plane {
        mapping.check_plane(&source)?;
    }
    Ok(mapping)
}

fn source_of(path: &Path) -> anyhow::Result<StudySource> {
    let text = input_file::read_text(path)
        .map_err(|error| Ended::usage(format!("cannot read the mapping {}: {error}", path.display())))?;
    Ok(StudySource { name: path.display().to_string(), text })
}

/// Numbers of cells, one a result.
fn cells_of(typed: &str, results: usize) -> anyhow::Result<Vec<usize>> {
    let cells: Vec<usize> = typed
        .split(',')
        .map(|entry| entry.trim().parse().ok().filter(|cells| *cells > 0))
        .collect::<Option<_>>()
        .ok_or_else(|| Ended::usage(format!("`--cells {typed}` is no list of numbers from 1 on")))?;
    if cells.len() == results {
        return Ok(cells);
    }
    Err(Ended::usage(format!(
        "`--cells {typed}` has {} numbers for {results} results: give one a result; several files of one mesh are one \
         result as a quoted pattern, like 'mesh-10/*.csv'",
        cells.len()
    )))
}
