//! The files to score: their mapping, and their runs with numbers of cells.

use crate::case::Case;
use crate::cli::commands::score::Arguments;
use crate::cli::exit::Ended;
use crate::cli::output::say;
use crate::foreign::reading::mapping_file;
use crate::import::given_files::{are_tables, files_of};
use crate::import::mapping::{Axes, Mapping};
use crate::import::raw_row::SolvedBody;
use crate::import::run::Run;
use crate::import::runs::runs_of;
use crate::study::overrides::times;
use crate::study::solver::Preset;
use clap::ValueEnum;

/// Reads the files of the command line, which may lack some quantities: their mapping, and their runs. `requested` are
/// time factors.
pub fn read(arguments: &Arguments, case: &Case, requested: &[f64]) -> anyhow::Result<(Mapping, Vec<Run>)> {
    let body = SolvedBody::of(case);
    let given = files_of(&arguments.results)?;
    let is_tables = are_tables(&given)?;
    let mut mapping = mapping_of(arguments, Axes::of(case.scene), is_tables)?;
    mapping.let_lack(&arguments.without);
    let steps = arguments.set_time_step.as_ref().map(|typed| times("--set-time-step", typed));
    let steps = steps.transpose()?.unwrap_or_default();
    if let Some(step) = steps.iter().find(|step| !(step.is_finite() && **step > 0.0)) {
        return Err(Ended::usage(format!("`--set-time-step {step}` is invalid: give seconds above 0")));
    }
    if steps.len() > 1 && steps.len() != given.len() {
        return Err(Ended::usage(format!(
            "`--set-time-step` has {} numbers for {} arguments with files: give one, or one per mesh",
            steps.len(),
            given.len()
        )));
    }
    mapping.time.step = steps.first().copied().or(mapping.time.step);
    if mapping.time.case {
        if requested.is_empty() {
            return Err(Ended::usage(
                "the mapping uses the times of the case: give them with --time-factor, in the order of the \
                 files"
                    .to_owned(),
            ));
        }
        let seconds: Vec<f64> =
            requested.iter().map(|factor| factor * body.seconds_per_time_factor).collect();
        mapping.follow_case(&seconds, body.seconds_per_time_factor);
    }
    // With as many numbers of cells as arguments each argument is a mesh.
    let is_each = |cells: &String| is_tables || cells.split(',').count() == given.len();
    let is_by_mesh = arguments.cells.as_ref().is_some_and(is_each);
    let mut runs = if is_by_mesh || steps.len() > 1 {
        // Each argument is a mesh.
        if let Some(cells) = arguments.cells.as_ref().filter(|_| is_tables) {
            cells_of(cells, given.len())?;
        }
        let mut runs = Vec::new();
        for (place, files) in given.iter().enumerate() {
            let mut of_files = mapping.clone();
            of_files.time.step = steps.get(place).or(steps.first()).copied().or(mapping.time.step);
            runs.extend(runs_of(std::slice::from_ref(files), &of_files, body)?);
        }
        runs
    } else {
        runs_of(&given, &mapping, body)?
    };
    if let Some(cells) = &arguments.cells {
        let cells = cells_of(cells, runs.len())?;
        for (run, cells) in runs.iter_mut().zip(cells) {
            run.cells = Some(cells);
        }
    }
    if let Some(run) = runs.iter().find(|run| run.sample.is_some()) {
        mapping.sample = run.sample(&mapping);
    }
    Ok((mapping, runs))
}

/// The declared meaning of the columns or arrays; a note says what is assumed if nothing is declared.
fn mapping_of(arguments: &Arguments, axes: Axes, is_tables: bool) -> anyhow::Result<Mapping> {
    let typed = arguments.mapping.clone().map(mapping_file).transpose();
    let typed = typed.map_err(|error| Ended::usage(error.to_string()))?;
    let mut preset = arguments.preset;
    if preset.is_none() && typed.is_none() {
        if is_tables {
            let up = "y is the initial height above the base in m, p is in Pa and positive in compression, \
                      u_y is in m and \
                      positive upward";
            let along = ", x is the initial distance from the crest of the load in m, u_x is in m and positive away from it";
            let places = match axes {
                Axes::Column => up.to_owned(),
                Axes::Layer => format!("{up}{along}"),
                Axes::Slab => "x is the initial distance from the middle of the slab to its drained side in m, p is in Pa \
                               and positive in compression, u_x is in m and positive outward"
                    .to_owned(),
            };
            say!("note: no --mapping, so t is in s, {places}; --show-mapping prints this as a file to edit");
        } else {
            preset = Preset::from_str("meshio", false).ok();
            say!(
                "note: no --preset and no --mapping, so arrays are matched by the names of --preset meshio: \
                 pressure, displacement and similar ones, in SI, pressure positive in compression"
            );
        }
    }
    Ok(Mapping::resolve(preset, typed.as_ref(), axes)?)
}

/// Numbers of cells, one per result.
fn cells_of(typed: &str, results: usize) -> anyhow::Result<Vec<usize>> {
    let cells: Vec<usize> = typed
        .split(',')
        .map(|entry| entry.trim().parse().ok().filter(|cells| *cells > 0))
        .collect::<Option<_>>()
        .ok_or_else(|| {
            Ended::usage(format!("`--cells {typed}` is invalid: expected whole numbers from 1 up"))
        })?;
    if cells.len() == results {
        return Ok(cells);
    }
    Err(Ended::usage(format!(
        "`--cells {typed}` has {} numbers for {results} results: give one per result; a quoted pattern, \
         like 'mesh-10/*.csv', combines the files of one mesh into one result",
        cells.len()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_one_whole_number_a_result() {
        let of = |typed: &str, results| cells_of(typed, results).map_err(|error| error.to_string());
        assert_eq!(of("10, 20 ,5", 3), Ok(vec![10, 20, 5]));
        assert_eq!(of("7", 1), Ok(vec![7]));
        for typed in ["0,10", "10,-1", "10,", "ten", "1.5"] {
            let told = format!("`--cells {typed}` is invalid: expected whole numbers from 1 up");
            assert_eq!(of(typed, 2), Err(told));
        }
        for (typed, count, results) in [("10", 1, 2), ("10,20,40", 3, 2), ("10", 1, 0)] {
            let told = format!(
                "`--cells {typed}` has {count} numbers for {results} results: give one per result; a quoted \
                 pattern, like 'mesh-10/*.csv', combines the files of one mesh into one result"
            );
            assert_eq!(of(typed, results), Err(told));
        }
    }
}
