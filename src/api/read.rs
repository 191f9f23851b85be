//! Reads files of other programs as states.

use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::import::mapping::preset::Preset;
use crate::import::raw_row::SolvedBody;
use crate::import::runs::{are_tables, files_of, runs_of};
use clap::ValueEnum;
use std::path::PathBuf;

/// Reads files with the mapping of a preset (tables with the convention), one list of states per mesh. `time_step` is
/// that of `--set-time-step`, s.
///
/// # Errors
/// When a file cannot be read or does not fit, with its name.
pub fn read(
    files: &[PathBuf],
    preset: &str,
    time_step: Option<f64>,
    height: f64,
) -> Result<Vec<Vec<SampledState>>, String> {
    let preset = Preset::from_str(preset, false)?;
    let body = SolvedBody { height, length: None, seconds_per_time_factor: 1.0 };
    let given = files_of(files).map_err(|error| error.to_string())?;
    let is_tables = are_tables(&given).map_err(|error| error.to_string())?;
    let mapping = Mapping::resolve(Some(preset).filter(|_| !is_tables), None, false);
    let mut mapping = mapping.map_err(|error| error.to_string())?;
    mapping.time.step = time_step;
    let runs = runs_of(&given, &mapping, body).map_err(|error| error.to_string())?;
    Ok(runs.into_iter().map(|run| run.states).collect())
}
