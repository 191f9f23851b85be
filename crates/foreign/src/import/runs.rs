//! Groups the files that a user gives into runs by mesh, and reads their times and rows.

use crate::import::expected::Expected;
use crate::import::frame_rows::{FrameRows, Start, cells_over_height, wanted_names};
use crate::import::given_files::{are_tables, without_numbers};
use crate::import::listed_states::{Listed, each_time};
use crate::import::mapping::Mapping;
use crate::import::origins::{Origin, Origins, PartKind};
use crate::import::raw_row::SolvedBody;
use crate::import::run::Run;
use crate::import::samples::{SampleRow, states_of};
use crate::import::step_times::{declared_time, have_steps_in_folders, join, members};
use crate::import::table_rows::{Curve, take_rows};
use oedometer_case::quantity::Sample;
use oedometer_formats::{
    Association, Frame, ImportError, Kind, Step, Wanted, collection_of, read_states, steps_of,
};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Most doubts that are kept of a run.
const MOST_DOUBTS: usize = 4;
/// Where a time comes from that the files do not say.
const DECLARED: &str = "the mapping's [time] or --set-time-step";

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
        let table_notes = take_rows(path, place, mapping, body, &mut origins, &mut rows)?;
        unended.extend((!table_notes.is_ended).then(|| path.clone()));
        notes.extend(table_notes.notes);
        doubts.extend(table_notes.doubts);
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
        run.unended.extend((!curve.table_notes.is_ended).then_some(curve.file));
        run.notes = curve.table_notes.notes;
        run.doubts = curve.table_notes.doubts;
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
        let shown =
            |cells: Option<usize>| cells.map_or("another number of".to_owned(), |cells| cells.to_string());
        own.notes.push(format!(
            "its mesh changes with time: {} and {} cells over the height",
            shown(own.cells),
            shown(others.cells)
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
            let doubt = format!("{}: {doubt}", step.file.display());
            if self.run.doubts.len() < MOST_DOUBTS {
                self.run.doubts.push(doubt);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::Column;
    use oedometer_formats::Array;
    use oedometer_input::source::StudySource;

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
