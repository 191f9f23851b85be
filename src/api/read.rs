//! Reads files of other programs as states.

use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::import::mapping::preset::Preset;
use crate::import::raw_row::SolvedBody;
use crate::import::runs::{Run, are_tables, files_of, runs_of};
use crate::study::file::StudySource;
use clap::ValueEnum;
use oedometer_formats::input_file;
use std::path::PathBuf;

/// What the columns or arrays of files mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meaning {
    /// The program that wrote them; for tables and where nothing is named the convention.
    pub preset: Option<String>,
    /// A mapping file, which overrides the preset key by key.
    pub mapping: Option<PathBuf>,
    /// Seconds from one numbered step to the next, where file names have the number of the step.
    pub time_step: Option<f64>,
}

/// Reads files with a preset's mapping (tables with the convention), one list of states per mesh. `time_step` is
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
    let body = SolvedBody { height, length: None, seconds_per_time_factor: 1.0 };
    let meaning = Meaning { preset: Some(preset.to_owned()), mapping: None, time_step };
    let (_, runs) = runs_with(files, &meaning, body, false)?;
    Ok(runs.into_iter().map(|run| run.states).collect())
}

/// The mapping of files, and their results, one per mesh.
pub(crate) fn runs_with(
    files: &[PathBuf],
    meaning: &Meaning,
    body: SolvedBody,
    is_plane: bool,
) -> Result<(Mapping, Vec<Run>), String> {
    let told = |error: &dyn std::fmt::Display| error.to_string();
    let given = files_of(files).map_err(|error| told(&error))?;
    let is_tables = are_tables(&given).map_err(|error| told(&error))?;
    let own = meaning.mapping.as_ref().map(|path| {
        let text = input_file::read_text(path);
        let text = text.map_err(|error| format!("cannot read the mapping {}: {error}", path.display()))?;
        Ok::<_, String>(StudySource { name: path.display().to_string(), text })
    });
    let own = own.transpose()?;
    let default = (own.is_none() && !is_tables).then_some("meshio");
    let named = meaning.preset.as_deref().filter(|_| !is_tables).or(default);
    let preset = named.map(|name| Preset::from_str(name, false)).transpose()?;
    let mut mapping = Mapping::resolve(preset, own.as_ref(), is_plane).map_err(|error| told(&error))?;
    if let Some(step) = meaning.time_step {
        if !(step.is_finite() && step > 0.0) {
            return Err(format!("a time step of {step} is invalid: give seconds above 0"));
        }
        mapping.time.step = Some(step);
    }
    let runs = runs_of(&given, &mapping, body).map_err(|error| told(&error))?;
    if mapping.is_sample_open
        && let Some(sample) = runs.iter().find_map(|run| run.sample)
    {
        mapping.sample = sample;
    }
    Ok((mapping, runs))
}
