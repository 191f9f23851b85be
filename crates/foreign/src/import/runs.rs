//! Groups the files that a user gives into runs by mesh, and reads their times and rows.

use crate::import::expected::Expected;
use crate::import::frame_rows::{FrameRows, Start, cells_over_height, said_unit, wanted_names};
use crate::import::mapping::{Column, Mapping};
use crate::import::nodes::weigh;
use crate::import::origins::{Origin, Origins, PartKind};
use crate::import::raw_row::SolvedBody;
use crate::import::said_units::SaidUnit;
use crate::import::samples::{SampleRow, SampledState, states_of};
use crate::import::spelling::spellings;
use crate::import::step_times::{declared_time, have_steps_in_folders, join, members, numbers_in};
use crate::import::table_rows::{Curve, take_rows};
use oedometer_case::quantity::{Quantity, Sample};
use oedometer_formats::{
    Array, Association, Axis, Frame, ImportError, Kind, Step, Use, Wanted, collection_of, read_states,
    states_by_time, steps_of,
};
use std::cmp::Ordering;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Most doubts that are kept of a run.
const MOST_DOUBTS: usize = 4;
/// Where a time comes from that the files do not say.
const DECLARED: &str = "the mapping's [time] or --set-time-step";

/// The states of one mesh.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// What the user gave.
    pub files: Vec<PathBuf>,
    /// Number of cells over the height, if the files have cells.
    pub cells: Option<usize>,
    /// Its states, by time.
    pub states: Vec<SampledState>,
    /// What was read from where, and what was left out.
    pub notes: Vec<String>,
    /// What the samples are, if the files show it.
    pub sample: Option<Sample>,
    /// What every state must have.
    pub expected: Expected,
    /// Tables whose last line does not end: they may be cut inside a number.
    pub unended: Vec<PathBuf>,
    /// What files say in two ways: a header that does not fit its data.
    pub doubts: Vec<String>,
    /// What states say in two ways: other values at one place and time, times that go back.
    pub contradictions: Vec<String>,
    /// Width of a body whose files show it, m.
    pub width: Option<f64>,
    /// Whether its mesh changes with time; its cells are then those of the finest.
    pub has_changing_mesh: bool,
    /// Quantities that are left out on purpose.
    pub without: Vec<Quantity>,
}

impl Run {
    /// What the samples are: as the mapping declares, or as the files show where it leaves that open. What lies on cells is
    /// at no node, whatever is declared.
    pub fn sample(&self, mapping: &Mapping) -> Sample {
        let is_wrong = mapping.sample == Sample::Nodes && self.sample == Some(Sample::Centres);
        self.sample.filter(|_| mapping.is_sample_open || is_wrong).unwrap_or(mapping.sample)
    }
}

/// The files of each argument; `*` and `?` stand for what a shell would put there.
///
/// # Errors
/// When no file matches a pattern.
pub fn files_of(arguments: &[PathBuf]) -> Result<Vec<Vec<PathBuf>>, ImportError> {
    let of_argument = |typed: &PathBuf| {
        let pattern = typed.to_string_lossy();
        if !pattern.contains(['*', '?']) || typed.exists() {
            return Ok(vec![typed.clone()]);
        }
        let refused = |why: &str| ImportError::content(typed, why);
        let matches = |pattern: &str| -> Result<Vec<PathBuf>, glob::PatternError> {
            Ok(glob::glob(pattern)?.flatten().filter(|path| path.is_file()).collect())
        };
        let mut files = matches(&pattern).unwrap_or_default();
        if files.is_empty() {
            // Brackets may be letters of a name.
            files = matches(&pattern.replace('[', "[[]")).map_err(|error| refused(error.msg))?;
        }
        if files.is_empty() {
            return Err(refused("no file matches this pattern"));
        }
        files.sort_by(|a, b| by_numbers(a, b));
        Ok(files)
    };
    arguments.iter().map(of_argument).collect()
}

/// The order of files by the numbers in the names of their folders (`Cycle10/data.pvtu` is after `Cycle9/data.pvtu`), then by
/// those in their own.
fn by_numbers(a: &Path, b: &Path) -> Ordering {
    let above = |path: &Path| path.parent().and_then(Path::parent).map(Path::to_owned);
    let compare = |a: &str, b: &str| numbers_in(a).partial_cmp(&numbers_in(b)).unwrap_or(Ordering::Equal);
    (above(a).cmp(&above(b)))
        .then_with(|| compare(&folder_of(a), &folder_of(b)))
        .then_with(|| a.parent().cmp(&b.parent()))
        .then_with(|| compare(&stem_of(a), &stem_of(b)))
}

/// Whether the names of two files, or of their folders, differ by their numbers alone and these fall.
fn goes_back(before: &Path, after: &Path) -> bool {
    let falls = |before: &str, after: &str| {
        without_numbers(before) == without_numbers(after) && numbers_in(after) < numbers_in(before)
    };
    let above = |path: &Path| path.parent().and_then(Path::parent).map(Path::to_owned);
    if before.parent() == after.parent() {
        return falls(&stem_of(before), &stem_of(after));
    }
    before.file_name() == after.file_name()
        && above(before) == above(after)
        && falls(&folder_of(before), &folder_of(after))
}

/// The name of a file without its extension.
fn stem_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The name of the folder that a file is in.
fn folder_of(path: &Path) -> String {
    path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether all files are tables.
///
/// # Errors
/// When one cannot be read.
pub fn are_tables(given: &[Vec<PathBuf>]) -> Result<bool, ImportError> {
    for path in given.iter().flatten() {
        if Kind::of(path)? != Kind::Table {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The runs of files: tables are one run, and of files with arrays those of one mesh.
///
/// # Errors
/// What cannot be read, with file and line.
pub fn runs_of(given: &[Vec<PathBuf>], mapping: &Mapping, body: SolvedBody) -> Result<Vec<Run>, ImportError> {
    if !are_tables(given)? {
        runs_of_arrays(given, mapping, body)
    } else if mapping.has_fields() {
        Ok(vec![run_of_tables(given.concat(), mapping, body)?])
    } else {
        Ok(vec![run_of_curve(given.concat(), mapping, body)?])
    }
}

fn run_of_tables(files: Vec<PathBuf>, mapping: &Mapping, body: SolvedBody) -> Result<Run, ImportError> {
    let mut rows = Vec::new();
    let (mut unended, mut notes, mut doubts) = (Vec::new(), Vec::new(), Vec::new());
    let mut origins = Origins::new(mapping);
    for (place, path) in files.iter().enumerate() {
        let told = take_rows(path, place, mapping, body, &mut origins, &mut rows)?;
        unended.extend((!told.is_ended).then(|| path.clone()));
        notes.extend(told.notes);
        doubts.extend(told.doubts);
    }
    let (states, contradictions) = states_of(&rows, &origins)?;
    let expected = Expected::of_states(&states);
    let mut run = Run { files, states, notes, expected, unended, doubts, contradictions, ..Run::default() };
    if mapping.columns.t.is_none() {
        run.files_are_in_order(mapping)?;
    }
    run.note_repeated(rows.len());
    run.leave_out_unloaded();
    run.weigh_nodes(mapping, body);
    run.attach_settlement(mapping, body)?;
    Ok(run)
}

/// A settlement curve alone.
fn run_of_curve(files: Vec<PathBuf>, mapping: &Mapping, body: SolvedBody) -> Result<Run, ImportError> {
    let mut run = Run { files, sample: Some(Sample::Surface), ..Run::default() };
    if let Some(series) = &mapping.settlement {
        let curve = Curve::read(series, run.files.first().map(PathBuf::as_path), mapping, body)?;
        run.states = curve.states();
        run.contradictions = curve.contradictions;
        run.expected.settlement = true;
        run.unended.extend((!curve.told.is_ended).then_some(curve.file));
        run.notes = curve.told.notes;
        run.doubts = curve.told.doubts;
    }
    Ok(run)
}

fn runs_of_arrays(
    given: &[Vec<PathBuf>],
    mapping: &Mapping,
    body: SolvedBody,
) -> Result<Vec<Run>, ImportError> {
    let names = wanted_names(mapping);
    let mut readings: Vec<Reading> = Vec::new();
    let mut origins = Origins::new(mapping);
    let mut joined = HashSet::new();
    for files in given {
        let are_folders = have_steps_in_folders(files);
        for path in files {
            let mut notes = Vec::new();
            let mut steps = steps_of(path, &mut notes)?;
            steps.retain(|step| match &members(&step.file, &mapping.join)[..] {
                [first, _, ..] => joined.insert(first.clone()),
                _ => true,
            });
            if let Some(table) = steps.iter().find(|step| step.kind == Kind::Table) {
                let reason = "it is a table among files with arrays: score it separately";
                return Err(ImportError::content(&table.file, reason));
            }
            read_states(&steps, Wanted(&names), &mut |step, mut frame| {
                join(step, &mapping.join, Wanted(&names), &mut frame)?;
                let mut of_times = Vec::new();
                each_time(step, &frame, mapping, &mut of_times, &mut |listed, frame, count| {
                    let cells = cells_over_height(frame, mapping, body.height);
                    let is_one_of_many = steps.len() > 1 || count > 1;
                    let key = key_of(step, is_one_of_many, are_folders, frame, cells);
                    let place = readings.iter().position(|known| known.key == key).unwrap_or_else(|| {
                        let run = Run { cells, expected: Expected::promised(mapping), ..Run::default() };
                        readings.push(Reading {
                            key,
                            are_folders,
                            is_one_of_many,
                            run,
                            start: None,
                            rows: Vec::new(),
                            steps: 0,
                        });
                        readings.len() - 1
                    });
                    readings[place].take(step, frame, listed.as_ref(), &mut origins, mapping, body)?;
                    readings[place].run.notes.append(&mut notes);
                    Ok(())
                })?;
                if let Some(reading) = readings.last_mut() {
                    reading
                        .run
                        .notes
                        .extend(of_times.iter().map(|note| format!("{}: {note}", step.file.display())));
                }
                Ok(())
            })?;
        }
    }
    let readings = with_changing_meshes(readings);
    readings.into_iter().map(|reading| reading.done(&origins, mapping, body)).collect()
}

/// Joins what was read of one list of states where its mesh changes with time: several meshes, and no time on two of them.
fn with_changing_meshes(readings: Vec<Reading>) -> Vec<Reading> {
    let mut joined: Vec<Reading> = Vec::new();
    for reading in readings {
        let is_other_mesh = |known: &&mut Reading| {
            let is_of_list = known.is_one_of_many && reading.is_one_of_many && known.start.is_none();
            let is_same_list = (&known.key.0, &known.key.1) == (&reading.key.0, &reading.key.1);
            let times =
                |rows: &[SampleRow]| rows.iter().map(|row| row.time.to_bits()).collect::<HashSet<u64>>();
            is_of_list && is_same_list && times(&known.rows).is_disjoint(&times(&reading.rows))
        };
        match joined.iter_mut().find(is_other_mesh) {
            Some(known) => known.change_mesh(reading),
            None => joined.push(reading),
        }
    }
    joined
}

/// A state of a frame whose arrays run over times.
struct Listed<'a> {
    time: f64,
    /// Its place among the times, from 1.
    number: usize,
    /// Its rows, where each has its own time.
    rows: &'a [usize],
}

/// What is done with a state: its place in a list of times, its frame and how many there are.
type TakeState<'a> = dyn FnMut(Option<Listed>, &Frame, usize) -> Result<(), ImportError> + 'a;

/// Hands over the states of a frame, with their time where its arrays run over times, and how many there are.
fn each_time(
    step: &Step,
    frame: &Frame,
    mapping: &Mapping,
    notes: &mut Vec<String>,
    take: &mut TakeState<'_>,
) -> Result<(), ImportError> {
    let refused = |why: String| ImportError::content(&step.file, why);
    let times = times_in(frame, mapping, notes);
    if times.is_empty() {
        let names_time = |column: Column| {
            let spelled = mapping.columns.get(column).into_iter().flat_map(|typed| spellings(typed));
            spelled.filter_map(|spelled| spelled.axes).any(|axes| axes.contains(&Axis::Time))
        };
        if Column::ALL.into_iter().any(names_time) {
            return Err(refused("its times are not known: name their array as `t` in [columns]".to_owned()));
        }
        return take(None, frame, 1);
    }
    let used = |array: &Array| use_of(array, frame, mapping);
    let states = states_by_time(frame, &times, &used).map_err(refused)?;
    for place in 0..states.count() {
        if let Some((time, frame)) = states.state(place) {
            let listed = Listed { time, number: place + 1, rows: states.rows_of(place) };
            take(Some(listed), &frame, states.count())?;
        }
    }
    Ok(())
}

/// The times over which the arrays of a frame run, in the mapping's unit: those of the array that the mapping names, or of the
/// file's own list.
fn times_in(frame: &Frame, mapping: &Mapping, notes: &mut Vec<String>) -> Vec<f64> {
    let mut in_unit = |array: &str, times: Vec<f64>| match said_unit(frame, array, Column::Time, mapping) {
        SaidUnit::Factor(factor, note) => {
            notes.push(note);
            times.into_iter().map(|time| time * factor).collect()
        }
        SaidUnit::AsMapped | SaidUnit::Unfit(_) => times,
    };
    let spelled = mapping.columns.t.as_deref().into_iter().flat_map(spellings);
    let of_array = |array: &Array, component: Option<usize>| -> Vec<f64> {
        array
            .values
            .iter()
            .skip(component.unwrap_or(0))
            .step_by(component.map_or(1, |_| array.components))
            .copied()
            .collect()
    };
    let named = spelled
        .filter_map(|spelled| Some((frame.array(spelled.name, spelled.on)?, spelled.component)))
        .find(|(array, _)| !array.values.is_empty());
    match named {
        // Each point of a mesh has the time of its state.
        Some((array, _)) if array.on != Association::Whole && frame.cells.is_some() => Vec::new(),
        Some((array, component)) => {
            let times = of_array(array, component);
            if times.len() > 1 || !frame.times.is_empty() { in_unit(&array.name, times) } else { Vec::new() }
        }
        None => {
            let is_list =
                |array: &&Array| array.values == frame.times && frame.units.contains_key(&array.name);
            let name = frame.arrays.iter().find(is_list).map_or("", |array| &array.name);
            in_unit(name, frame.times.clone())
        }
    }
}

/// How the mapping uses an array, if it does.
fn use_of(array: &Array, frame: &Frame, mapping: &Mapping) -> Option<Use> {
    let mut found: Option<Use> = None;
    let id = mapping.displacement.as_ref().and_then(|source| source.id.as_ref());
    let columns = Column::ALL.into_iter().filter(|column| *column != Column::Time);
    let columns =
        columns.filter_map(|column| Some((mapping.columns.get(column)?, column.quantity().is_some())));
    let others = id.into_iter().chain(mapping.rows.equals.keys()).map(|typed| (typed, false));
    for (typed, is_quantity) in columns.chain(others) {
        // The first alternative that is there is the one that is read.
        let first = spellings(typed).find(|spelled| frame.array(spelled.name, spelled.on).is_some());
        let Some(spelled) = first.filter(|spelled| {
            frame.array(spelled.name, spelled.on).is_some_and(|named| std::ptr::eq(named, array))
        }) else {
            continue;
        };
        let usage = found.get_or_insert_default();
        usage.is_quantity |= is_quantity;
        usage.has_component |= spelled.component.is_some();
        usage.axes = usage.axes.take().or(spelled.axes);
    }
    found
}

/// What distinguishes runs: folder, file name, cells over the height, points.
type Key = (PathBuf, String, Option<usize>, usize);

/// The key of a state's run. Of files with one state each, the name counts without its numbers, and where the folders are
/// the steps, these too.
fn key_of(step: &Step, is_one_of_many: bool, are_folders: bool, frame: &Frame, cells: Option<usize>) -> Key {
    let file = step.named.file_name().unwrap_or_default().to_string_lossy();
    let name = if is_one_of_many { file.into_owned() } else { without_numbers(&file) };
    let points = if cells.is_some() { 0 } else { frame.coordinates.len() };
    let folder = step.named.parent().unwrap_or(Path::new(""));
    let folder = if are_folders {
        folder.with_file_name(without_numbers(&folder.file_name().unwrap_or_default().to_string_lossy()))
    } else {
        folder.to_owned()
    };
    (folder, name, cells, points)
}

/// A name with each number replaced by one `#`.
fn without_numbers(name: &str) -> String {
    let mut blank = name.replace(|symbol: char| symbol.is_ascii_digit(), "#");
    while blank.contains("##") {
        blank = blank.replace("##", "#");
    }
    blank
}

/// A run that is being read.
struct Reading {
    key: Key,
    /// Whether folders count the steps.
    are_folders: bool,
    /// Whether it is a state of a list.
    is_one_of_many: bool,
    run: Run,
    start: Option<Start>,
    rows: Vec<SampleRow>,
    steps: usize,
}

impl Reading {
    /// Adds the states of another mesh.
    fn change_mesh(&mut self, other: Self) {
        let (own, others) = (&mut self.run, other.run);
        let told =
            |cells: Option<usize>| cells.map_or("another number of".to_owned(), |cells| cells.to_string());
        own.notes.push(format!(
            "its mesh changes with time: {} and {} cells over the height",
            told(own.cells),
            told(others.cells)
        ));
        own.has_changing_mesh = true;
        own.cells = own.cells.max(others.cells);
        own.notes.extend(others.notes);
        own.doubts.extend(others.doubts);
        let files = others.files.into_iter().filter(|file| !own.files.contains(file)).collect::<Vec<_>>();
        own.files.extend(files);
        own.expected.add(others.expected.columns());
        self.rows.extend(other.rows);
        self.rows.sort_by_key(|row| row.origin);
    }

    /// Adds a state.
    fn take(
        &mut self,
        step: &Step,
        frame: &Frame,
        listed: Option<&Listed>,
        origins: &mut Origins,
        mapping: &Mapping,
        body: SolvedBody,
    ) -> Result<(), ImportError> {
        let columns = FrameRows::find(frame, &step.file, mapping, body)?;
        let beside = columns.beside()?;
        let of_list = listed.map(|listed| listed.time);
        let (time, from) = self.time_of(step, frame, of_list, &columns, mapping, body)?;
        if self.steps == 0 {
            let cells =
                self.run.cells.map_or(String::new(), |cells| format!("; {cells} cells over the height"));
            let note = |note: &String| format!("{note}; time from {from}{cells}");
            let notes = columns.notes.iter().chain(beside.iter().flat_map(|beside| &beside.notes));
            self.run.notes.extend(notes.map(note));
            self.run.sample = Some(match (columns.on, &frame.cells) {
                (Association::Cells, _) => Sample::Centres,
                (_, Some(cells)) if cells.dimension() > 0 => Sample::Nodes,
                _ => Sample::Points,
            });
            let hint = columns.hint_of_program();
            if !hint.is_empty() {
                self.run.notes.push(format!("{}{hint}", step.file.display()));
            }
            self.run.width = columns.width();
            self.start = mapping.displacement.is_some().then(|| columns.start());
        }
        self.run.notes.extend(frame.notes.iter().cloned());
        for doubt in frame.doubts.iter().chain(&columns.doubts) {
            let told = format!("{}: {doubt}", step.file.display());
            if self.run.doubts.len() < MOST_DOUBTS {
                self.run.doubts.push(told);
            }
        }
        let (records, kind) = match listed {
            Some(Listed { rows, .. }) if !rows.is_empty() => (*rows, PartKind::Records),
            Some(Listed { number, .. }) => (&[][..], PartKind::State(Some(*number))),
            None if matches!(step.kind, Kind::Hdf5 | Kind::Xdmf) => {
                (&[][..], PartKind::State(Some(step.place + 1)))
            }
            None => (&[][..], PartKind::State(None)),
        };
        // The order of a list says nothing of times that others declare.
        let source = if from == DECLARED { &step.file } else { &step.named };
        let part = origins.add(&step.file, source, kind);
        let line =
            |row: usize| records.get(row).map_or(0, |record| u32::try_from(record + 1).unwrap_or(u32::MAX));
        for columns in std::iter::once(&columns).chain(&beside) {
            self.run.expected.add(columns.columns());
            let origin = |row: usize| Origin { part, line: line(row) };
            columns.take_rows(time, &origin, self.start.as_ref(), &mut self.rows)?;
        }
        if !self.run.files.contains(&step.named) {
            self.run.files.push(step.named.clone());
        }
        self.steps += 1;
        Ok(())
    }

    /// The time of a state, s, and its source.
    fn time_of(
        &self,
        step: &Step,
        frame: &Frame,
        listed: Option<f64>,
        columns: &FrameRows,
        mapping: &Mapping,
        body: SolvedBody,
    ) -> Result<(f64, String), ImportError> {
        let refused = |why: String| ImportError::content(&step.file, why);
        let named = if self.are_folders { step.named.as_path() } else { step.file.as_path() };
        let declared = declared_time(named, self.steps, self.are_folders, mapping, body).map_err(refused)?;
        if let Some(seconds) = declared {
            return Ok((seconds, DECLARED.to_owned()));
        }
        let of_array = match listed {
            Some(time) => Some(time),
            None => columns.time_of_array()?,
        };
        let of_array = of_array.map(|time| (time, "an array of the file".to_owned()));
        let of_step = || step.time.map(|time| (time, step.named.display().to_string()));
        let of_file = || frame.time.map(|time| (time, "the file".to_owned()));
        let (time, from) = of_array.or_else(of_step).or_else(of_file).ok_or_else(|| {
            let listed = collection_of(&step.file).map_or_else(
                || "the .pvd or .series that lists it".to_owned(),
                |collection| format!("{}, which lists it", collection.display()),
            );
            refused(format!(
                "its time is unknown: score {listed}, give --set-time-step SECONDS if its name has a step \
                 number, or write [time] into a mapping{}",
                columns.hint_of_program()
            ))
        })?;
        if !time.is_finite() {
            return Err(refused(format!("its time is {time}")));
        }
        Ok((mapping.units.time.seconds(time, body.seconds_per_time_factor), from))
    }

    /// The run, with its states by time.
    fn done(self, origins: &Origins, mapping: &Mapping, body: SolvedBody) -> Result<Run, ImportError> {
        let Self { mut run, start, rows, .. } = self;
        (run.states, run.contradictions) = states_of(&rows, origins)?;
        run.note_repeated(rows.len());
        drop(rows);
        if start.is_some() && run.states.len() < 2 {
            for state in &mut run.states {
                state.change(&|state| {
                    state.displacement.clear();
                    state.horizontal_displacement.clear();
                });
            }
            let note = "a single state has no displacement: give the first state too, its reference";
            run.notes.push(note.to_owned());
        }
        run.files_are_in_order(mapping)?;
        run.leave_out_unloaded();
        run.weigh_nodes(mapping, body);
        run.attach_settlement(mapping, body)?;
        let mut seen = std::collections::BTreeSet::new();
        run.notes.retain(|note| seen.insert(note.clone()));
        Ok(run)
    }
}

impl Run {
    /// Leaves out quantities, which no state then has or must have.
    pub fn leave_out(&mut self, quantities: &[Quantity]) {
        for quantity in quantities {
            for state in &mut self.states {
                state.change(&|state| match quantity {
                    Quantity::Pressure => state.pressure.clear(),
                    Quantity::EffectiveStress => state.effective_stress.clear(),
                    Quantity::Displacement => {
                        state.displacement.clear();
                        state.horizontal_displacement.clear();
                    }
                    Quantity::Settlement => state.surface_displacement = None,
                    Quantity::LoadFactor => {}
                });
            }
            self.expected.leave_out(*quantity);
        }
        self.without.extend(quantities);
    }

    /// Leaves out the state at the start if its pressure is 0 everywhere.
    fn leave_out_unloaded(&mut self) {
        let is_loaded = |state: &SampledState| {
            state.time > 0.0 || state.pressure.is_empty() || state.pressure.iter().any(|p| *p != 0.0)
        };
        let before = self.states.len();
        self.states.retain(is_loaded);
        if self.states.len() < before && !self.states.is_empty() {
            let note = "the state at t = 0 is left out: its pressure is 0, so the load is not applied yet";
            self.notes.push(note.to_owned());
        }
    }

    /// Gives nodes of graded meshes the weights of the lengths that they stand for, where the file has no weights.
    fn weigh_nodes(&mut self, mapping: &Mapping, body: SolvedBody) {
        let sample = self.sample(mapping);
        if mapping.columns.volume.is_some() {
            return;
        }
        let mut is_weighed = false;
        for state in &mut self.states {
            let beside = state.beside.iter_mut().map(|set| (set.sample.unwrap_or(sample), &mut set.state));
            let sets = beside.collect::<Vec<_>>();
            for (_, set) in sets.into_iter().filter(|(sample, _)| *sample != Sample::Centres) {
                is_weighed |= weigh(set, body.height, body.length);
            }
            is_weighed |= sample != Sample::Centres && weigh(state, body.height, body.length);
        }
        if is_weighed {
            let note = "weight = the length that each node represents, because they are unevenly spaced";
            self.notes.push(note.to_owned());
        }
    }

    /// Refuses files whose times are listed in their order and whose numbers are in another one: a shell sorts `a_10` before
    /// `a_9`.
    fn files_are_in_order(&self, mapping: &Mapping) -> Result<(), ImportError> {
        let is_listed = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            !mapping.time.list.is_empty() && !mapping.time.files.contains_key(&*name)
        };
        let listed: Vec<&PathBuf> = self.files.iter().filter(|path| is_listed(path)).collect();
        let Some(pair) = listed.windows(2).find(|pair| goes_back(pair[0], pair[1])) else { return Ok(()) };
        Err(ImportError::content(
            pair[1],
            format!(
                "it comes after {}, but [time] counts the files in their order: give them in the order of \
                 their numbers, as a quoted pattern does, or write [time] files",
                pair[0].display()
            ),
        ))
    }

    /// Notes how many rows repeat another one with equal values; they count once.
    fn note_repeated(&mut self, rows: usize) {
        let kept = self.states.iter().flat_map(|state| state.sets(Sample::Points));
        let kept: usize = kept.map(|(_, state)| state.initial_height.len()).sum();
        if kept < rows {
            let note = format!(
                "{} of {rows} rows repeat the place and values of another and count once",
                rows - kept
            );
            self.notes.push(note);
        }
    }

    /// Adds the settlement curve, if the mapping names a file for it.
    fn attach_settlement(&mut self, mapping: &Mapping, body: SolvedBody) -> Result<(), ImportError> {
        let Some(series) = &mapping.settlement else { return Ok(()) };
        let curve = Curve::read(series, self.files.first().map(PathBuf::as_path), mapping, body)?;
        let matched = curve.attach(&mut self.states);
        self.contradictions.extend(curve.contradictions);
        let file = curve.file;
        let is_told = curve.told.is_ended || self.unended.contains(&file);
        for (own, of_curve) in [(&mut self.notes, curve.told.notes), (&mut self.doubts, curve.told.doubts)] {
            for told in of_curve {
                if !own.contains(&told) {
                    own.push(told);
                }
            }
        }
        self.expected.settlement = matched > 0;
        self.notes.push(format!(
            "settlement from {} at {matched} of {} times, each the nearest within 0.1 %",
            if series.file.is_empty() { file.display().to_string() } else { series.file.clone() },
            self.states.len()
        ));
        self.unended.extend((!is_told).then_some(file));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::Column;
    use oedometer_formats::Array;
    use oedometer_input::source::StudySource;

    #[test]
    fn places_are_as_declared_or_as_found_and_what_lies_on_cells_is_at_no_node() {
        use Sample::{Centres, Nodes, Points};
        let convention = Mapping::convention(crate::import::mapping::Axes::Column).expect("a constant");
        for (declared, is_sample_open, shown, told) in [
            (Nodes, false, None, Nodes),
            (Nodes, false, Some(Nodes), Nodes),
            (Nodes, false, Some(Centres), Centres),
            (Points, false, Some(Centres), Points),
            (Centres, false, Some(Nodes), Centres),
            (Points, true, Some(Nodes), Nodes),
            (Points, true, None, Points),
        ] {
            let mapping = Mapping { sample: declared, is_sample_open, ..convention.clone() };
            let run = Run { sample: shown, ..Run::default() };
            assert_eq!(run.sample(&mapping), told, "{declared:?} {shown:?}");
        }
    }

    #[test]
    fn files_go_back_where_the_numbers_of_like_names_fall() {
        for (before, after, told) in [
            ("a_9.vtu", "a_10.vtu", false),
            ("a_10.vtu", "a_9.vtu", true),
            ("a_10.vtu", "b_9.vtu", false),
            ("col_ts_50_t_4.0875.vtu", "col_ts_100_t_8.175.vtu", false),
            ("t_0.5.csv", "t_0.25.csv", true),
            ("Cycle9/a.pvtu", "Cycle10/a.pvtu", false),
            ("Cycle10/a.pvtu", "Cycle9/a.pvtu", true),
            ("x/Cycle10/a.pvtu", "y/Cycle9/a.pvtu", false),
            ("mesh-20/a_1.vtu", "mesh-10/a_2.vtu", false),
        ] {
            assert_eq!(goes_back(Path::new(before), Path::new(after)), told, "{before} {after}");
        }
    }

    #[test]
    fn patterns_find_files_in_the_order_of_their_numbers() {
        let folder = tempfile::TempDir::new().expect("a folder");
        for name in ["a_10.vtk", "a_9.vtk", "b_1.vtk", "a_100.vtk"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        let given = files_of(&[folder.path().join("a_*.vtk")]).expect("files");
        let names: Vec<_> = given[0].iter().map(|path| path.file_name().expect("a name")).collect();
        assert_eq!(names, ["a_9.vtk", "a_10.vtk", "a_100.vtk"]);
        assert!(files_of(&[folder.path().join("c*")]).is_err());
        assert_eq!(without_numbers("col_ts_50_t_4.0875.vtu"), "col_ts_#_t_#.#.vtu");
    }

    fn reading() -> Reading {
        let key = (PathBuf::new(), String::new(), None, 0);
        let run = Run::default();
        Reading {
            key,
            are_folders: false,
            is_one_of_many: false,
            run,
            start: None,
            rows: Vec::new(),
            steps: 0,
        }
    }

    const BODY: SolvedBody = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };

    #[test]
    fn a_start_is_left_out_only_where_no_place_has_a_pressure() {
        let mapping = Mapping::convention(crate::import::mapping::Axes::Column).expect("the convention");
        for (at_start, states) in [([0.0, 0.0], 1), ([1.0, 0.0], 2), ([0.0, 1.0], 2), ([1.0, 1.0], 2)] {
            let mut reading = reading();
            for (time, pressures) in [(0.0, at_start), (1.0, [0.5, 0.0])] {
                reading.rows.extend(pressures.into_iter().zip([0.0, 1.0]).map(|(pressure, height)| {
                    SampleRow { pressure, ..SampleRow::at(time, height, Origin::default()) }
                }));
            }
            let run = reading.done(&Origins::new(&mapping), &mapping, BODY).expect("two states");
            assert_eq!(run.states.len(), states, "{at_start:?}");
            assert_eq!(run.notes.iter().any(|note| note.contains("is left out")), states == 1);
        }
    }

    #[test]
    fn what_any_state_has_is_expected_of_every_other() {
        let text = "columns = { y = \"coordinates[1]\", p = \"p\", u_y = \"u\" }".to_owned();
        let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
        let mapping = Mapping { optional: vec!["u_y".to_owned()], ..mapping };
        let file = PathBuf::from("a.vtu");
        let step =
            Step { named: file.clone(), file, kind: Kind::Vtu, place: 0, time: None, others: Vec::new() };
        for lacking in 0..3_usize {
            let mut reading = reading();
            for place in 0..3_usize {
                let array = |name: &str| Array {
                    name: name.to_owned(),
                    on: Association::Points,
                    components: 1,
                    tuples: 2,
                    values: vec![1.0, 0.5],
                    shape: Vec::new(),
                };
                let names = if place == lacking { &["p"][..] } else { &["p", "u"] };
                let frame = Frame {
                    time: Some(1.0 + place as f64),
                    coordinates: vec![[0.0; 3], [0.0, 1.0, 0.0]],
                    arrays: names.iter().map(|name| array(name)).collect(),
                    ..Frame::default()
                };
                reading
                    .take(&step, &frame, None, &mut Origins::new(&mapping), &mapping, BODY)
                    .expect("a state");
            }
            let run = reading.done(&Origins::new(&mapping), &mapping, BODY).expect("three states");
            let absent = run.expected.absent(&run.states);
            let told: Vec<_> = absent.iter().map(|one| (one.column, one.states.as_slice())).collect();
            assert_eq!(told, [(Some(Column::Up), &[lacking][..])]);
        }
    }

    #[test]
    fn a_point_that_moved_stays_where_it_began_along_and_up() {
        let text = "columns = { x = \"coordinates[0]\", y = \"coordinates[1]\", p = \"p\" }\n\
                    displacement = { from = \"first-frame\" }\n";
        let source = StudySource { name: "m.toml".to_owned(), text: text.to_owned() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let file = PathBuf::from("a.vtu");
        let step =
            Step { named: file.clone(), file, kind: Kind::Vtu, place: 0, time: None, others: Vec::new() };
        let mut reading = reading();
        for (time, [along, up]) in [(1.0, [0.0, 0.0]), (2.0, [0.02, -0.01])] {
            let frame = Frame {
                time: Some(time),
                coordinates: vec![[0.3 + along, 0.5 + up, 0.0]],
                arrays: vec![Array {
                    name: "p".to_owned(),
                    on: Association::Points,
                    components: 1,
                    tuples: 1,
                    values: vec![1.0],
                    shape: Vec::new(),
                }],
                ..Frame::default()
            };
            reading.take(&step, &frame, None, &mut Origins::new(&mapping), &mapping, BODY).expect("a state");
        }
        let last =
            reading.done(&Origins::new(&mapping), &mapping, BODY).expect("two states").states.remove(1);
        let found =
            [&last.initial_distance, &last.initial_height, &last.horizontal_displacement, &last.displacement];
        let near = |(found, wanted): (&&Vec<f64>, f64)| (found[0] - wanted).abs() < 1e-15;
        assert!(found.iter().zip([0.3, 0.5, 0.02, -0.01]).all(near), "{found:?}");
    }

    #[test]
    fn files_are_one_result_where_folder_name_but_for_its_numbers_and_mesh_are_alike() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let write = |name: &str, levels: usize, has_cells: bool, time: f64| {
            let lines = |count: usize, line: &dyn Fn(usize) -> String| -> String {
                (0..count).map(line).collect::<Vec<_>>().concat()
            };
            let places = lines(levels, &|at| format!("0 {} 0\n", at as f64 / (levels - 1) as f64));
            let count = if has_cells { levels - 1 } else { 0 };
            let cells = lines(count, &|cell| format!("2 {cell} {}\n", cell + 1));
            let types = "3\n".repeat(count);
            let cells = if has_cells {
                format!("CELLS {count} {}\n{cells}CELL_TYPES {count}\n{types}", 3 * count)
            } else {
                String::new()
            };
            let text = format!(
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {levels} double\n{places}{cells}\
                 FIELD f 1\nTIME 1 1 double\n{time}\nPOINT_DATA {levels}\nSCALARS p double\nLOOKUP_TABLE default\n{}",
                "1\n".repeat(levels)
            );
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(&path, text).expect("a file");
            path
        };
        let text = "columns = { y = \"coordinates[1]\", p = \"p\", u_y = \"\" }".to_owned();
        let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
        let first = ("a/col-10.vtk", 5, true);
        for (other, cells) in [
            // Only the number in the name differs.
            (("a/col-20.vtk", 5, true), &[Some(4)][..]),
            // The mesh, the folder, the name.
            (("a/col-20.vtk", 9, true), &[Some(4), Some(8)]),
            (("b/col-10.vtk", 5, true), &[Some(4), Some(4)]),
            (("a/row-10.vtk", 5, true), &[Some(4), Some(4)]),
            (("a/col-20.vtk", 5, false), &[Some(4), None]),
        ] {
            for is_turned in [false, true] {
                let mut given = [(first, 1.0), (other, 2.0)];
                let mut wanted = cells.to_vec();
                if is_turned {
                    given.reverse();
                    wanted.reverse();
                }
                let files: Vec<Vec<PathBuf>> = given
                    .map(|((name, levels, has_cells), time)| vec![write(name, levels, has_cells, time)])
                    .into();
                let runs = runs_of(&files, &mapping, BODY).expect("two states");
                let found: Vec<Option<usize>> = runs.iter().map(|run| run.cells).collect();
                assert_eq!(found, wanted, "{other:?}");
                assert_eq!(runs.iter().map(|run| run.states.len()).sum::<usize>(), 2, "{other:?}");
            }
        }
        // Of places without cells their number tells one result from another.
        let places = |levels: [usize; 2]| {
            let files =
                levels.map(|levels| write(&format!("c/p-{levels}.vtk"), levels, false, levels as f64));
            runs_of(&[files.to_vec()], &mapping, BODY).expect("two states").len()
        };
        assert_eq!(places([5, 6]), 2);
        std::fs::copy(folder.path().join("c/p-5.vtk"), folder.path().join("c/p-7.vtk")).expect("a file");
        let again = ["c/p-5.vtk", "c/p-7.vtk"].map(|name| vec![folder.path().join(name)]);
        assert_eq!(runs_of(&again, &mapping, BODY).expect("one state, twice").len(), 1);
    }

    #[test]
    fn states_of_one_file_belong_together_by_its_whole_name() {
        let key = |name: &str, is_one_of_many| {
            let file = PathBuf::from(name);
            let step =
                Step { named: file.clone(), file, kind: Kind::Vtu, place: 0, time: None, others: Vec::new() };
            key_of(&step, is_one_of_many, false, &Frame::default(), Some(4))
        };
        assert_eq!(key("run-10.xdmf", false), key("run-20.xdmf", false));
        assert_ne!(key("run-10.xdmf", true), key("run-20.xdmf", true), "each of them is a series");
        assert_eq!(key("run-10.xdmf", true), key("run-10.xdmf", true));
    }

    /// A mapping declares a time; then that of an array that it names counts, then that of a collection, which a user may
    /// have written for files of another clock, and last the file's own. All but steps have the mapping's unit.
    #[test]
    fn a_time_is_that_of_the_mapping_then_of_its_array_then_of_the_collection_then_of_the_file() {
        let file = PathBuf::from("a_7.vtu");
        let array = |name: &str, on, value| Array {
            name: name.to_owned(),
            on,
            components: 1,
            tuples: 1,
            values: vec![value],
            shape: Vec::new(),
        };
        for (declared, of_array, of_step, of_file, wanted) in [
            ("list = [2.0]", Some(3.0), Some(5.0), Some(11.0), Some((120.0, "mapping"))),
            ("files = { \"a_7.vtu\" = 2.0 }", Some(3.0), Some(5.0), Some(11.0), Some((120.0, "mapping"))),
            ("step = 2.0", Some(3.0), Some(5.0), Some(11.0), Some((14.0, "mapping"))),
            ("", Some(3.0), Some(5.0), Some(11.0), Some((180.0, "an array"))),
            ("", Some(3.0), None, None, Some((180.0, "an array"))),
            ("", None, Some(5.0), Some(11.0), Some((300.0, "all.pvd"))),
            ("", None, Some(5.0), None, Some((300.0, "all.pvd"))),
            ("", None, None, Some(11.0), Some((660.0, "the file"))),
            ("", None, Some(f64::NAN), Some(11.0), None),
            ("", None, None, None, None),
        ] {
            let name = of_array.map_or(String::new(), |_| ", t = \"TIME\"".to_owned());
            let text = format!(
                "columns = {{ y = \"coordinates[1]\", p = \"p\", u_y = \"\"{name} }}\nunits.time = \"min\"\n\
                 [time]\n{declared}\n"
            );
            let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
            let step = Step {
                named: "all.pvd".into(),
                file: file.clone(),
                kind: Kind::Vtu,
                place: 0,
                time: of_step,
                others: Vec::new(),
            };
            let mut arrays = vec![array("p", Association::Points, 1.0)];
            arrays.extend(of_array.map(|time| array("TIME", Association::Whole, time)));
            let frame = Frame { time: of_file, coordinates: vec![[0.0; 3]], arrays, ..Frame::default() };
            let columns = FrameRows::find(&frame, &file, &mapping, BODY).expect("its columns");
            let found = reading().time_of(&step, &frame, None, &columns, &mapping, BODY);
            match wanted {
                None => {
                    let nowhere = "its time is unknown: score the .pvd or .series that lists it, give \
                                   --set-time-step SECONDS if its name has a step number, or write [time] \
                                   into a mapping";
                    let why = if of_step.is_some() { "its time is NaN" } else { nowhere };
                    assert_eq!(found.expect_err("no time").to_string(), format!("a_7.vtu: {why}"));
                }
                Some((seconds, from)) => {
                    let found = found.expect("a time");
                    assert!(found.0 == seconds && found.1.contains(from), "{declared}: {found:?}");
                }
            }
        }
    }

    /// A file of a list with levels of nodes and a time.
    fn written(folder: &Path, name: &str, levels: usize) -> String {
        let lines = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
        let places = lines(levels, &|at| format!("0 {} 0\n", at as f64 / (levels - 1) as f64));
        let cells = lines(levels - 1, &|cell| format!("2 {cell} {}\n", cell + 1));
        let text = format!(
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {levels} double\n{places}CELLS {} {}\n\
             {cells}CELL_TYPES {}\n{}POINT_DATA {levels}\nSCALARS p double\nLOOKUP_TABLE default\n{}",
            levels - 1,
            3 * (levels - 1),
            levels - 1,
            "3\n".repeat(levels - 1),
            "1\n".repeat(levels)
        );
        std::fs::write(folder.join(name), text).expect("a file");
        name.to_owned()
    }

    #[test]
    fn a_mesh_that_changes_with_time_is_one_result_and_meshes_of_the_same_times_are_several() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let text = "columns = { y = \"coordinates[1]\", p = \"p\", u_y = \"\" }".to_owned();
        let mapping = Mapping::read(&StudySource { name: "m.toml".to_owned(), text }).expect("a mapping");
        let runs = |entries: &[(f64, usize)]| {
            let listed = entries.iter().enumerate().map(|(at, (time, levels))| {
                let name = written(folder.path(), &format!("s{at}_{levels}.vtk"), *levels);
                format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"{name}\"/>")
            });
            let path = folder.path().join("a.pvd");
            let body: String = listed.collect();
            std::fs::write(
                &path,
                format!("<VTKFile type=\"Collection\"><Collection>{body}</Collection></VTKFile>"),
            )
            .expect("a file");
            let runs = runs_of(&[vec![path]], &mapping, BODY).expect("states");
            runs.iter().map(|run| (run.cells, run.states.len(), run.has_changing_mesh)).collect::<Vec<_>>()
        };
        assert_eq!(runs(&[(1.0, 5), (2.0, 7), (3.0, 9)]), [(Some(8), 3, true)]);
        assert_eq!(runs(&[(1.0, 9), (2.0, 5), (3.0, 9)]), [(Some(8), 3, true)], "it may grow coarser");
        assert_eq!(runs(&[(1.0, 5), (2.0, 5), (3.0, 5)]), [(Some(4), 3, false)]);
        assert_eq!(
            runs(&[(1.0, 5), (2.0, 5), (1.0, 9), (2.0, 9)]),
            [(Some(4), 2, false), (Some(8), 2, false)]
        );
    }
}
