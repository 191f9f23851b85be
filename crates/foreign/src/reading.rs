//! Reads the result files of a solver as states, and reports how they were read.

use crate::import::given_files::files_of;
use crate::import::mapping::{Axes, Mapping};
use crate::import::nodes::{EVEN, SAME_PLACE, counted_otherwise, levels};
use crate::import::raw_row::SolvedBody;
use crate::import::run::Run;
use crate::import::runs::runs_of;
use crate::import::{SampledState, not_ended};
use crate::solver::ExternalSolver;
use oedometer_case::{Case, Sample};
use oedometer_formats::{ImportError, input_file, with_named};
use oedometer_input::diagnostic::StudyError;
use oedometer_input::source::StudySource;
use oedometer_wording::rounded;
use std::path::PathBuf;

/// Multiple of the load that no pressure reaches.
const IMPOSSIBLE: f64 = 100.0;

/// A result as it was read.
#[derive(Debug)]
pub struct ReadResult {
    /// Its states, by time.
    pub states: Vec<SampledState>,
    /// Kind of its places.
    pub sample: Sample,
    /// Whether its mesh changes with time, so that the number of samples does.
    pub has_changing_mesh: bool,
    /// What was taken from where.
    pub notes: Vec<String>,
    /// Digest of the content of its files.
    pub digest: String,
}

/// Why a result is missing.
#[derive(Debug)]
pub enum Unread {
    /// No file of that name.
    NoFile,
    /// A file cannot be read as its mapping says.
    Unreadable(String),
    /// It contains a value that is not finite.
    NotFinite(String),
}

/// Why a solver's mapping cannot be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MappingError {
    /// The file cannot be read.
    #[error("cannot read the mapping {path}: {source}")]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It does not say what a result means.
    #[error("{name} does not declare {taken}: write it into [units] and [sign]")]
    Undeclared {
        /// The mapping.
        name: String,
        /// What would have been taken for granted.
        taken: String,
    },
    /// It says what no file can have.
    #[error(transparent)]
    Wrong(#[from] StudyError),
}

/// A mapping file.
///
/// # Errors
/// When it cannot be read.
pub fn mapping_file(path: PathBuf) -> Result<StudySource, MappingError> {
    match input_file::read_text(&path) {
        Ok(text) => Ok(StudySource { name: path.display().to_string(), text }),
        Err(source) => Err(MappingError::Io { path, source }),
    }
}

/// What the columns or arrays of a solver's result mean.
///
/// # Errors
/// When the mapping file cannot be read or is wrong.
pub fn mapping_of(solver: &ExternalSolver, axes: Axes) -> Result<Mapping, MappingError> {
    let own = solver.mapping.as_ref().map(|name| mapping_file(solver.folder.join(name))).transpose()?;
    let mut mapping = Mapping::resolve(solver.preset, own.as_ref(), axes)?;
    // A gate assumes nothing that is not declared.
    if let (Some(taken), Some(source)) =
        (mapping.taken_for_granted(axes == Axes::Layer).filter(|_| solver.is_given()), own)
    {
        return Err(MappingError::Undeclared { name: source.name, taken });
    }
    mapping.time.step = solver.time_step.or(mapping.time.step);
    Ok(mapping)
}

/// The result of a case.
///
/// # Errors
/// Why it is missing.
pub fn read(case: &Case, mapping: &Mapping, result: &[PathBuf]) -> Result<ReadResult, Unread> {
    let given = files_of(result).map_err(|_| Unread::NoFile)?;
    let files = given.concat();
    if files.iter().any(|file| !file.is_file()) {
        return Err(Unread::NoFile);
    }
    let digest = digest_of(&files);
    let mut mapping = mapping.clone();
    let seconds: Vec<f64> =
        case.time_factors.iter().map(|factor| factor * case.seconds_per_time_factor()).collect();
    mapping.follow_case(&seconds, case.seconds_per_time_factor());
    let mapping = &mapping;
    let runs = runs_of(&given, mapping, SolvedBody::of(case)).map_err(|error| why_unread(&error))?;
    if runs.len() > 1 {
        return Err(Unread::Unreadable(format!(
            "the files hold {} results, of different meshes or names: `result` in the study must name one",
            runs.len()
        )));
    }
    let Some(run) = runs.into_iter().next() else {
        return Err(Unread::Unreadable("the files hold no state".to_owned()));
    };
    if let Some(why) = run.contradictions.first() {
        return Err(Unread::Unreadable(why.clone()));
    }
    let sample = run.sample(mapping);
    if let Some(why) = unfit(case, sample, &run) {
        return Err(Unread::Unreadable(why));
    }
    let counted = run.states.first().filter(|_| run.cells.is_none() && sample == Sample::Nodes);
    if let Some(why) =
        counted.and_then(|state| counted_otherwise(case.cells, &state.initial_height, case.column.height))
    {
        return Err(Unread::Unreadable(format!("the case has {} cells: {why}", case.cells)));
    }
    if let Some(why) = other_cells(case, run.cells) {
        return Err(Unread::Unreadable(why));
    }
    if let Some(sample) = twice(&run.states, sample) {
        return Err(Unread::Unreadable(format!(
            "quantities lie at different {}: an attached solver writes all quantities of one kind at the same places",
            sample.name()
        )));
    }
    let notes = run.doubts.into_iter().chain(run.notes).collect();
    Ok(ReadResult { states: run.states, sample, has_changing_mesh: run.has_changing_mesh, notes, digest })
}

/// Why a result that could be read cannot be that of its case: cut, without a quantity, of another mesh, or with a pressure
/// that the load cannot cause. The first that applies.
fn unfit(case: &Case, sample: Sample, run: &Run) -> Option<String> {
    if let Some(file) = run.unended.first() {
        return Some(not_ended(file));
    }
    let when =
        |place: usize| format!("T_v = {}", rounded(run.states[place].time / case.seconds_per_time_factor()));
    if let Some(absent) = run.expected.absent(&run.states).first() {
        return Some(absent.sentence(when));
    }
    run.states.iter().enumerate().find_map(|(place, state)| {
        // Where a mesh is shown its nodes may be more, and its centres lie inside.
        let may_be_another = |(sample, set): &(Sample, &SampledState)| {
            run.cells.is_none() || *sample == Sample::Centres && are_on_a_face(case, set)
        };
        let mut sets = state.sets(sample).filter(may_be_another);
        let other = sets.find_map(|(sample, set)| other_mesh(case, sample, set));
        let why = other.or_else(|| state.sets(sample).find_map(|(_, set)| beyond_the_load(case, set)))?;
        Some(format!("at {}, {why}", when(place)))
    })
}

/// A kind of places of which a state has two sets: a record has one of each.
fn twice(states: &[SampledState], sample: Sample) -> Option<Sample> {
    let of_state = |state: &SampledState| {
        let kinds: Vec<Sample> = state.sets(sample).map(|(sample, _)| sample).collect();
        kinds.iter().enumerate().find(|(place, kind)| kinds[..*place].contains(kind)).map(|(_, kind)| *kind)
    };
    states.iter().find_map(of_state)
}

/// Whether nodes or centres, in a file that shows no mesh, stand evenly at more heights than the cells of the case have: a finer
/// mesh's are whole, too. Places without such an order, like the centres of triangles, are judged by what they cover.
fn other_mesh(case: &Case, sample: Sample, state: &SampledState) -> Option<String> {
    let nodes = match sample {
        Sample::Nodes => 1,
        Sample::Centres => 0,
        Sample::Points | Sample::Surface => return None,
    };
    let places = levels(&state.initial_height, case.column.height);
    let (heights, most) = (places.len(), case.cells + nodes);
    let gap = |pair: &[f64]| pair[1] - pair[0];
    let gaps = || places.windows(2).map(gap);
    let widest = gaps().fold(0.0, f64::max);
    let is_even = gaps().all(|gap| gap >= (1.0 - EVEN) * widest);
    (heights > most && is_even).then(|| {
        format!(
            "the {} of the result lie at {heights} heights, but {} cells have {most}: it is the result of \
             another mesh, or its places are not {} (`sample` in the mapping; `rows` selects corners)",
            sample.name(),
            case.cells,
            sample.name()
        )
    })
}

/// Whether a place lies on the base or the surface.
fn are_on_a_face(case: &Case, state: &SampledState) -> bool {
    let height = case.column.height;
    let is_on = |place: &f64| place.abs().min((place - height).abs()) <= SAME_PLACE * height;
    state.initial_height.iter().any(is_on)
}

/// Whether the files show a number of cells that is not that of the case.
fn other_cells(case: &Case, shown: Option<usize>) -> Option<String> {
    let cells = shown.filter(|cells| *cells != case.cells)?;
    Some(format!(
        "the mesh of the result has {cells} cells over the height, but the case asks for {}",
        case.cells
    ))
}

/// A pressure that the load cannot cause, in a body without self-weight.
fn beyond_the_load(case: &Case, state: &SampledState) -> Option<String> {
    let most = IMPOSSIBLE * case.column.pressure_scale().abs();
    if case.column.self_weight || most == 0.0 {
        return None;
    }
    let place = state.pressure.iter().position(|pressure| pressure.abs() > most)?;
    Some(format!(
        "a pressure is {:.3e} Pa, more than {IMPOSSIBLE} times the load of {} Pa",
        state.pressure[place],
        rounded(case.column.pressure_scale())
    ))
}

/// An error of the import, distinguished if it is about a value that is not finite.
fn why_unread(error: &ImportError) -> Unread {
    let sentence = error.to_string();
    let is_value = matches!(error, ImportError::Content { .. });
    if is_value && names_no_finite_number(&sentence) {
        Unread::NotFinite(sentence)
    } else {
        Unread::Unreadable(sentence)
    }
}

/// Whether a sentence of the import names a value that is infinite or no number: quoted, or at the end of `is`.
fn names_no_finite_number(sentence: &str) -> bool {
    let is_it = |word: &str| word.parse::<f64>().is_ok_and(|number| !number.is_finite());
    let quoted = sentence.split('`').skip(1).step_by(2).any(is_it);
    let said = sentence.split(" is ").skip(1).filter_map(|rest| rest.split([' ', ';', ',']).next());
    quoted || said.into_iter().any(is_it)
}

/// Digest over the contents of files in their order, with those that they name; where one cannot be read, what could.
fn digest_of(files: &[PathBuf]) -> String {
    let mut hasher = blake3::Hasher::new();
    for path in files.iter().flat_map(|path| with_named(path)) {
        // A file that vanishes meanwhile is told when it is read.
        let _ = input_file::open(&path).and_then(|file| hasher.update_reader(file).map(|_| ()));
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pressure_that_the_load_cannot_cause_is_told_wherever_it_stands() {
        let mut case = Case::seed(oedometer_case::Task::Solve, &oedometer_scenes::TERZAGHI);
        case.column.load = 37.0;
        let told = |case: &Case, pressure: [f64; 3]| {
            beyond_the_load(case, &SampledState { pressure: pressure.to_vec(), ..SampledState::default() })
        };
        let most = 37.0 * IMPOSSIBLE;
        for place in 0..3 {
            for wrong in [1.01 * most, -1.01 * most] {
                let mut pressure = [0.99 * most; 3];
                assert_eq!(told(&case, pressure), None);
                pressure[place] = wrong;
                let sentence = told(&case, pressure).expect("too much");
                assert!(sentence.contains(&format!("{wrong:.3e}")), "{sentence}");
            }
        }
        case.column.self_weight = true;
        assert_eq!(told(&case, [2.0 * most; 3]), None, "the weight may");
    }

    #[test]
    fn what_is_no_finite_number_is_told_from_what_is_no_number() {
        for told in [
            "a.csv:7: `NaN` in the column `p` is invalid: expected a finite number",
            "a.csv:7: `-inf` in the column `p` is invalid: expected a finite number",
            "a.vtu: point 3: `p` is NaN",
            "a.vtu: its time is inf",
        ] {
            assert!(names_no_finite_number(told), "{told}");
        }
        for told in [
            "a.csv:7: `1.0.0` in the column `p` is invalid: expected a finite number",
            "a.csv: no column `nan_p`; the header has `t`",
            "inf/a.csv: the initial height 2 m is outside the column of 1 m",
        ] {
            assert!(!names_no_finite_number(told), "{told}");
        }
    }

    #[test]
    fn the_time_step_of_the_study_goes_over_that_of_its_mapping() {
        let folder = tempfile::TempDir::new().expect("a folder");
        std::fs::write(folder.path().join("m.toml"), "columns = { p = \"p\" }\ntime = { step = 3.0 }\n")
            .expect("written");
        for (of_study, taken) in [(None, Some(3.0)), (Some(2.0), Some(2.0))] {
            let mut solver = crate::attachment::tests::solver(folder.path(), &["true"]);
            (solver.time_step, solver.mapping) = (of_study, Some("m.toml".to_owned()));
            assert_eq!(mapping_of(&solver, Axes::Column).expect("a mapping").time.step, taken);
        }
    }

    #[test]
    fn a_result_has_at_most_the_heights_of_the_case() {
        let case = Case { cells: 4, ..Case::seed(oedometer_case::Task::Solve, &oedometer_scenes::TERZAGHI) };
        let is_other = |sample: Sample, heights: usize| {
            let height = |place: usize| case.column.height * place as f64 / heights as f64;
            let initial_height = (0..heights).map(height).collect();
            other_mesh(&case, sample, &SampledState { initial_height, ..SampledState::default() }).is_some()
        };
        for (sample, most) in [(Sample::Nodes, 5), (Sample::Centres, 4)] {
            let found = [most - 1, most, most + 1].map(|heights| is_other(sample, heights));
            assert_eq!(found, [false, false, true], "{sample:?}");
        }
        assert!(!is_other(Sample::Points, 40), "a cell may have many points");
        assert!(!is_other(Sample::Surface, 40), "nor has the surface heights");
        // Both a coarser and a finer mesh are another case's.
        for (shown, told) in [(1, true), (3, true), (4, false), (5, true), (40, true)] {
            let found = other_cells(&case, Some(shown));
            assert_eq!(found.is_some(), told, "{found:?}");
            let sentence = format!("has {shown} cells over the height, but the case asks for 4");
            assert!(found.is_none_or(|found| found.ends_with(&sentence)), "{sentence}");
        }
        assert_eq!(other_cells(&case, None), None, "a table shows no cells");
    }

    /// A state of a column 1 m high in legacy VTK: lines of nodes over the height, with or without cells.
    fn vtk(cells: usize, seconds: f64) -> String {
        let lines = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
        let nodes = cells + 1;
        format!(
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {nodes} double\n{}CELLS {cells} {}\n{}\
             CELL_TYPES {cells}\n{}FIELD f 1\nTIME 1 1 double\n{seconds}\nPOINT_DATA {nodes}\nSCALARS p double\n\
             LOOKUP_TABLE default\n{}SCALARS u_y double\nLOOKUP_TABLE default\n{}",
            lines(nodes, &|at| format!("0 {} 0\n", at as f64 / cells as f64)),
            3 * cells,
            lines(cells, &|cell| format!("2 {cell} {}\n", cell + 1)),
            "3\n".repeat(cells),
            "0.5\n".repeat(nodes),
            "0\n".repeat(nodes)
        )
    }

    /// Results in a folder for a case of four cells under 1 Pa: tables, and meshes of four and of five cells.
    fn results() -> (tempfile::TempDir, Case) {
        let folder = tempfile::TempDir::new().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
        write("a.csv", "t,y,p,u_y\n8.175,0.5,0.5,0\n");
        write("b.csv", "t,y,p,u_y\n8.175,0.25,0.5,0\n");
        write("cut.csv", "t,y,p,u_y\n8.175,0.5,0.5,0.1");
        write("two.csv", "t,y,p,u_y\n8.175,0.5,0.5,0\n16.35,0.5,200.0,0\n");
        write("nan.csv", "t,y,p,u_y\n8.175,0.5,NaN,0\n");
        for (name, cells) in [("four-1.vtk", 4), ("five-1.vtk", 5), ("six-1.vtk", 4)] {
            write(name, &vtk(cells, 8.175));
        }
        write("bare-1.vtk", &vtk(4, 8.175).replace("SCALARS p double", "SCALARS q double"));
        let case = Case {
            cells: 4,
            time_factors: vec![0.1].into(),
            ..Case::seed(oedometer_case::Task::Solve, &oedometer_scenes::TERZAGHI)
        };
        (folder, case)
    }

    /// Mappings of tables, and of arrays whose places are open, points or centres.
    fn mappings() -> [Mapping; 4] {
        use clap::ValueEnum;
        let meshio = crate::solver::Preset::from_str("meshio", false).expect("a preset");
        let arrays = Mapping::resolve(Some(meshio), None, Axes::Column).expect("a preset");
        let said = |sample| Mapping { sample, is_sample_open: false, ..arrays.clone() };
        let [points, centres] = [Sample::Points, Sample::Centres].map(said);
        [Mapping::convention(Axes::Column).expect("a constant"), arrays, points, centres]
    }

    /// The kind of places, the number of states and the digest of results, or why there are none.
    fn read_as(
        (folder, case): &(tempfile::TempDir, Case),
        mapping: &Mapping,
        names: &[&str],
    ) -> Result<(&'static str, usize, String), String> {
        let files: Vec<PathBuf> = names.iter().map(|name| folder.path().join(name)).collect();
        match read(case, mapping, &files) {
            Ok(found) => Ok((found.sample.name(), found.states.len(), found.digest)),
            Err(Unread::NoFile) => Err("no file".to_owned()),
            Err(Unread::Unreadable(why)) => Err(why.replace(&format!("{}/", folder.path().display()), "")),
            Err(Unread::NotFinite(why)) => Err(format!("not finite: {why}")),
        }
    }

    #[test]
    fn a_result_that_cannot_be_that_of_its_case_is_told_why() {
        let results = results();
        let [table, arrays, points, centres] = mappings();
        let cut = "cut.csv does not end with a line break, so it may be cut off inside its last number: end \
                   the last line with one";
        let stand = |kind: &str, heights: usize, most: usize| {
            format!(
                "at T_v = 0.1, the {kind} of the result lie at {heights} heights, but 4 cells have {most}: \
                 it is the result of another mesh, or its places are not {kind} (`sample` in the mapping; \
                 `rows` selects corners)"
            )
        };
        let lacking = "there is no `p` at any time; to leave it out, call `score --without pressure`, or \
                       write `p = \"\"` into [columns] of a mapping";
        let other_mesh = "the mesh of the result has 5 cells over the height, but the case asks for 4";
        let several =
            "the files hold 2 results, of different meshes or names: `result` in the study must name one";
        for (mapping, names, told) in [
            (&table, &["none.csv"][..], "no file"),
            (&table, &["a.csv", "none.csv"], "no file"),
            (&table, &["none*.csv"], "no file"),
            (&table, &["cut.csv"], cut),
            (&table, &["a.csv", "cut.csv"], cut),
            (
                &table,
                &["two.csv"],
                "at T_v = 0.2, a pressure is 2.000e2 Pa, more than 100 times the load of 1 Pa",
            ),
            (&arrays, &["four-1.vtk", "six-1.vtk"], several),
            (&arrays, &["five-1.vtk"], other_mesh),
            (&centres, &["four-1.vtk"], &stand("centres", 5, 4)),
            (&arrays, &["bare-1.vtk"], lacking),
            // Points may stand at any number of heights, and cells are seen all the same.
            (&points, &["five-1.vtk"], other_mesh),
        ] {
            assert_eq!(read_as(&results, mapping, names).err().as_deref(), Some(told), "{names:?}");
        }
        let told = read_as(&results, &table, &["nan.csv"]).expect_err("no number");
        assert!(told.starts_with("not finite: ") && told.contains("nan.csv:2: `NaN`"), "{told}");
    }

    #[test]
    fn places_are_what_the_mapping_says_or_the_files_show_and_a_digest_is_of_all_files() {
        let results = results();
        let [table, arrays, points, _] = mappings();
        for (mapping, names, sample) in [
            (&table, &["a.csv"][..], "points"),
            (&table, &["?.csv"], "points"),
            (&arrays, &["four-1.vtk"], "nodes"),
            (&points, &["four-1.vtk"], "points"),
        ] {
            let found = read_as(&results, mapping, names).map(|(sample, states, _)| (sample, states));
            assert_eq!(found, Ok((sample, 1)), "{names:?}");
        }
        let digest = |names: &[&str]| read_as(&results, &table, names).expect("a result").2;
        let both = digest(&["a.csv", "b.csv"]);
        assert_eq!((digest(&["?.csv"]), both.len()), (both.clone(), 16));
        std::fs::write(results.0.path().join("b.csv"), "t,y,p,u_y\n8.175,0.25,0.6,0\n").expect("a file");
        let others = [&["a.csv", "b.csv"][..], &["b.csv", "a.csv"], &["a.csv"], &["b.csv"]].map(digest);
        let distinct: std::collections::BTreeSet<&String> = others.iter().chain([&both]).collect();
        assert_eq!(distinct.len(), 5, "{others:?} {both}");
    }

    #[test]
    fn a_mapping_of_a_gate_declares_what_it_takes_and_one_of_a_run_need_not() {
        let folder = tempfile::TempDir::new().expect("a folder");
        std::fs::write(
            folder.path().join("m.toml"),
            "units.stress = 'Pa'\nsign.p = 'compression-positive'\n",
        )
        .expect("written");
        let mut solver = crate::attachment::tests::solver(folder.path(), &["true"]);
        assert_eq!(
            mapping_of(&solver, Axes::Column).ok(),
            Mapping::convention(Axes::Column).ok(),
            "without a mapping"
        );
        solver.mapping = Some("m.toml".to_owned());
        assert!(mapping_of(&solver, Axes::Column).is_ok());
        solver.files = vec!["a.csv".to_owned()];
        let path = folder.path().join("m.toml").display().to_string();
        let told = mapping_of(&solver, Axes::Column).expect_err("undeclared").to_string();
        assert_eq!(
            told,
            format!(
                "{path} does not declare the sign of `u_y`, taken as up: write it into [units] and [sign]"
            )
        );
        solver.mapping = Some("none.toml".to_owned());
        let told = mapping_of(&solver, Axes::Column).expect_err("no file").to_string();
        let start = format!("cannot read the mapping {}: ", folder.path().join("none.toml").display());
        assert!(told.starts_with(&start), "{told}");
    }
}
