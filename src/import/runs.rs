//! From what a user names to runs: files found, their states grouped by mesh, times and rows read.

use crate::case::quantity::Sample;
use crate::import::expected::Expected;
use crate::import::frame_rows::{FrameReader, Start, cells_over_height, wanted_names};
use crate::import::mapping::Mapping;
use crate::import::opened_csv::is_ended;
use crate::import::raw_row::SolvedBody;
use crate::import::rows::Rows;
use crate::import::sample_row::take_rows;
use crate::import::settlement_series::attach;
use crate::import::step_times::{declared_time, fits, step_of};
use crate::import::table::SampledState;
use oedometer_formats::frame::{Association, Frame, Wanted};
use oedometer_formats::hints::collection_of;
use oedometer_formats::import_error::ImportError;
use oedometer_formats::steps::{Frames, Kind, Step, steps_of};
use std::path::{Component, Path, PathBuf};

/// An argument with the files that it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// As it was typed.
    pub typed: PathBuf,
    /// Its files, in the order of their numbers.
    pub files: Vec<PathBuf>,
}

/// The states of one mesh.
#[derive(Debug, Default)]
pub struct Run {
    /// What the user named.
    pub files: Vec<PathBuf>,
    /// Cells over the height, where the files have cells.
    pub cells: Option<usize>,
    /// Its states, by time.
    pub states: Vec<SampledState>,
    /// What was taken from where, and what was left out.
    pub notes: Vec<String>,
    /// What the samples are, where the files show it.
    pub sample: Option<Sample>,
    /// What every state must have.
    pub expected: Expected,
    /// Tables whose last line does not end: they may be cut inside a number.
    pub unended: Vec<PathBuf>,
}

/// Files of arguments; `*` and `?` stand for what a shell would put there.
///
/// # Errors
/// When a pattern fits no file.
pub fn files_of(arguments: &[PathBuf]) -> Result<Vec<Given>, ImportError> {
    let mut all = Vec::new();
    for typed in arguments {
        let is_pattern = typed.to_string_lossy().contains(['*', '?']) && !typed.exists();
        let files = if is_pattern { fitting(typed) } else { vec![typed.clone()] };
        if files.is_empty() {
            return Err(ImportError::table(typed, "no file fits this pattern"));
        }
        all.push(Given { typed: typed.clone(), files });
    }
    Ok(all)
}

/// Files that fit a pattern, by the numbers in their names.
fn fitting(pattern: &Path) -> Vec<PathBuf> {
    let mut found = vec![PathBuf::new()];
    for part in pattern.components() {
        let Component::Normal(part) = part else {
            for path in &mut found {
                path.push(part);
            }
            continue;
        };
        let part = part.to_string_lossy();
        if !part.contains(['*', '?']) {
            for path in &mut found {
                path.push(&*part);
            }
            continue;
        }
        let mut next = Vec::new();
        for path in &found {
            let folder = if path.as_os_str().is_empty() { Path::new(".") } else { path.as_path() };
            let Ok(entries) = std::fs::read_dir(folder) else { continue };
            for entry in entries.flatten() {
                let name = entry.file_name().to_string_lossy().into_owned();
                if fits(&name, &part) {
                    next.push(path.join(name));
                }
            }
        }
        found = next;
    }
    found.retain(|path| path.is_file());
    found.sort();
    let number = |path: &PathBuf| step_of(&path.file_name().unwrap_or_default().to_string_lossy(), None);
    found.sort_by(|a, b| {
        a.parent().cmp(&b.parent()).then(number(a).unwrap_or(-1.0).total_cmp(&number(b).unwrap_or(-1.0)))
    });
    found
}

/// Whether all files are tables.
///
/// # Errors
/// When one cannot be read.
pub fn are_tables(given: &[Given]) -> Result<bool, ImportError> {
    for path in given.iter().flat_map(|one| &one.files) {
        if Kind::of(path)? != Kind::Table {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The run of tables.
///
/// # Errors
/// What cannot be read or taken, with file and line.
pub fn run_of_tables(files: Vec<PathBuf>, mapping: &Mapping, body: SolvedBody) -> Result<Run, ImportError> {
    let mut rows = Rows::default();
    for (place, path) in files.iter().enumerate() {
        take_rows(path, place, mapping, body, &mut rows)?;
    }
    let states = rows.states()?;
    let mut run = Run { files, expected: Expected::of_states(&states), states, ..Run::default() };
    for file in &run.files {
        if !is_ended(file)? {
            run.unended.push(file.clone());
        }
    }
    run.finish(mapping, body)?;
    Ok(run)
}

/// A run that is still being read.
struct Reading {
    key: (PathBuf, String, Option<usize>, usize),
    run: Run,
    start: Option<Start>,
    rows: Rows,
    steps: usize,
}

/// Runs of files with arrays: those of one mesh are one.
///
/// # Errors
/// What cannot be read or taken, with its file.
pub fn runs_of_arrays(given: &[Given], mapping: &Mapping, body: SolvedBody) -> Result<Vec<Run>, ImportError> {
    let names = wanted_names(mapping);
    let mut readings: Vec<Reading> = Vec::new();
    let mut frames = Frames::default();
    for path in given.iter().flat_map(|one| &one.files) {
        let mut notes = Vec::new();
        let steps = steps_of(path, &mut notes)?;
        let is_one_of_many = steps.len() > 1;
        for step in steps {
            if step.kind == Kind::Table {
                return Err(ImportError::table(
                    &step.file,
                    "it is a table among files with arrays: score them apart",
                ));
            }
            let frame = frames.frame(&step, Wanted(&names))?;
            let cells = cells_over_height(&frame, mapping, body.height);
            let key = key_of(&step, is_one_of_many, &frame, cells);
            let place = readings.iter().position(|one| one.key == key).unwrap_or_else(|| {
                let run = Run { cells, expected: Expected::promised(mapping), ..Run::default() };
                readings.push(Reading { key, run, start: None, rows: Rows::default(), steps: 0 });
                readings.len() - 1
            });
            readings[place].take(&step, &frame, mapping, body)?;
            readings[place].run.notes.append(&mut notes);
        }
    }
    readings.into_iter().map(|reading| reading.done(mapping, body)).collect()
}

/// What tells runs apart: the file of several states, or the file name without its numbers; and the mesh.
fn key_of(
    step: &Step,
    is_one_of_many: bool,
    frame: &Frame,
    cells: Option<usize>,
) -> (PathBuf, String, Option<usize>, usize) {
    let file = step.named.file_name().unwrap_or_default().to_string_lossy();
    let name = if is_one_of_many { file.into_owned() } else { without_numbers(&file) };
    let points = if cells.is_some() { 0 } else { frame.coordinates.len() };
    (step.named.parent().unwrap_or(Path::new("")).to_owned(), name, cells, points)
}

/// A name with each number replaced by one mark.
fn without_numbers(name: &str) -> String {
    let mut blank = String::new();
    for symbol in name.chars() {
        if !symbol.is_ascii_digit() {
            blank.push(symbol);
        } else if !blank.ends_with('#') {
            blank.push('#');
        }
    }
    blank
}

impl Reading {
    /// Takes a state.
    fn take(
        &mut self,
        step: &Step,
        frame: &Frame,
        mapping: &Mapping,
        body: SolvedBody,
    ) -> Result<(), ImportError> {
        let reader = FrameReader { frame, path: &step.file, mapping, body };
        let columns = reader.columns()?;
        let (time, from) = self.time_of(step, &reader)?;
        if self.steps == 0 {
            let cells =
                self.run.cells.map_or(String::new(), |cells| format!("; {cells} cells over the height"));
            self.run
                .notes
                .extend(columns.notes.iter().map(|note| format!("{note}; time from {from}{cells}")));
            self.run.sample = Some(match (columns.on(), &frame.cells) {
                (Association::Cells, _) => Sample::Centres,
                (_, Some(cells)) if cells.dimension() > 0 => Sample::Nodes,
                _ => Sample::Points,
            });
            let hint = reader.hint_of_program();
            if !hint.is_empty() {
                self.run.notes.push(format!("{}{hint}", step.file.display()));
            }
            if mapping.displacement.is_some() {
                self.start = Some(reader.start()?);
            }
        }
        self.run.notes.extend(frame.notes.iter().cloned());
        self.run.expected.add(columns.quantities());
        reader.take_rows(&columns, time, self.start.as_ref(), &mut self.rows)?;
        if !self.run.files.contains(&step.named) {
            self.run.files.push(step.named.clone());
        }
        self.steps += 1;
        Ok(())
    }

    /// The time of a state, s, and what tells it.
    fn time_of(&self, step: &Step, reader: &FrameReader) -> Result<(f64, String), ImportError> {
        let refused = |why: String| ImportError::table(&step.file, why);
        let (mapping, body) = (reader.mapping, reader.body);
        let declared = declared_time(&step.file, self.steps, mapping, body).map_err(refused)?;
        if let Some(seconds) = declared {
            return Ok((seconds, "the mapping's [time] or --set-time-step".to_owned()));
        }
        let of_array = reader.time_of_array()?.map(|time| (time, "an array of the file".to_owned()));
        let of_step = || step.time.map(|time| (time, step.named.display().to_string()));
        let of_file = || reader.frame.time.map(|time| (time, "the file".to_owned()));
        let (time, from) = of_array.or_else(of_step).or_else(of_file).ok_or_else(|| {
            let listed = collection_of(&step.file).map_or_else(
                || "the .pvd or .series that lists it".to_owned(),
                |collection| format!("{}, which lists it", collection.display()),
            );
            refused(format!(
                "its time is told nowhere: score {listed}, give --set-time-step SECONDS where its name has the number \
                 of a step, or write [time] into a mapping{}",
                reader.hint_of_program()
            ))
        })?;
        if !time.is_finite() {
            return Err(refused(format!("its time is {time}")));
        }
        Ok((mapping.units.time.seconds(time, body.seconds_per_time_factor), from))
    }

    /// The run, with its states by time.
    fn done(mut self, mapping: &Mapping, body: SolvedBody) -> Result<Run, ImportError> {
        self.run.states = std::mem::take(&mut self.rows).states()?;
        let states = &mut self.run.states;
        if self.start.is_some() && states.len() < 2 {
            for state in states.iter_mut() {
                state.displacement.clear();
                state.horizontal_displacement.clear();
            }
            self.run.notes.push(
                "one state alone shows no displacement: give the first state too, from which it counts"
                    .to_owned(),
            );
        }
        let before = states.len();
        states.retain(|state| {
            state.time > 0.0
                || state.pressure.is_empty()
                || state.pressure.iter().any(|pressure| *pressure != 0.0)
        });
        if states.len() < before && !states.is_empty() {
            self.run
                .notes
                .push("the state at t = 0 is left out: its pressure is 0, the load is not on yet".to_owned());
        }
        self.run.finish(mapping, body)?;
        let mut seen = std::collections::BTreeSet::new();
        self.run.notes.retain(|note| seen.insert(note.clone()));
        Ok(self.run)
    }
}

impl Run {
    /// Adds what stands in files of its own.
    fn finish(&mut self, mapping: &Mapping, body: SolvedBody) -> Result<(), ImportError> {
        let Some(series) = &mapping.settlement else { return Ok(()) };
        let folder = self.files.first().and_then(|file| file.parent()).unwrap_or(Path::new(""));
        let (matched, file) = attach(series, folder, &mut self.states, mapping, body)?;
        self.unended.extend((!is_ended(&file)?).then_some(file));
        self.expected.settlement = matched > 0;
        self.notes.push(format!(
            "settlement from {} at {matched} of {} times, the nearest within 0.1 % each",
            series.file,
            self.states.len()
        ));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_find_files_in_the_order_of_their_numbers() {
        let folder = tempfile::TempDir::new().expect("a folder");
        for name in ["a_10.vtk", "a_9.vtk", "b_1.vtk", "a_100.vtk"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        let given = files_of(&[folder.path().join("a_*.vtk")]).expect("files");
        let names: Vec<_> = given[0].files.iter().map(|path| path.file_name().expect("a name")).collect();
        assert_eq!(names, ["a_9.vtk", "a_10.vtk", "a_100.vtk"]);
        assert!(files_of(&[folder.path().join("c*")]).is_err());
        assert_eq!(without_numbers("col_ts_50_t_4.0875.vtu"), "col_ts_#_t_#.#.vtu");
    }
}
