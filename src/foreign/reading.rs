//! Reads the result files of a solver as states, and reports how they were read.

use crate::case::{Case, Sample};
use crate::import::mapping::Mapping;
use crate::import::raw_row::SolvedBody;
use crate::import::runs::{Run, files_of, runs_of};
use crate::import::{SampledState, not_ended};
use crate::study::diagnostic::StudyError;
use crate::study::file::StudySource;
use crate::study::solver::ExternalSolver;
use oedometer_formats::{ImportError, input_file};
use oedometer_soil::wording::short;
use std::path::PathBuf;

/// Multiple of the load that no pressure reaches.
const IMPOSSIBLE: f64 = 100.0;
/// Places closer than this share of the height are one.
const SAME_PLACE: f64 = 1e-6;

/// A result as it was read.
#[derive(Debug)]
pub struct ReadResult {
    /// Its states, by time.
    pub states: Vec<SampledState>,
    /// Kind of its places.
    pub sample: Sample,
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

/// What the columns or arrays of a solver's result mean.
///
/// # Errors
/// When the mapping file cannot be read or is wrong.
pub fn mapping_of(solver: &ExternalSolver, is_plane: bool) -> Result<Mapping, MappingError> {
    let own = solver.mapping.as_ref().map(|name| {
        let path = solver.folder.join(name);
        match input_file::read_text(&path) {
            Ok(text) => Ok(StudySource { name: path.display().to_string(), text }),
            Err(source) => Err(MappingError::Io { path, source }),
        }
    });
    let own = own.transpose()?;
    let mut mapping = Mapping::resolve(solver.preset, own.as_ref(), is_plane)?;
    // A gate assumes nothing that is not declared.
    if let (Some(taken), Some(source)) =
        (mapping.taken_for_granted(is_plane).filter(|_| solver.is_given()), own)
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
    let runs = runs_of(&given, mapping, SolvedBody::of(case)).map_err(|error| why_unread(&error))?;
    if runs.len() > 1 {
        return Err(Unread::Unreadable(format!(
            "the files hold {} results, of different meshes or names: let the study's `result` name one",
            runs.len()
        )));
    }
    let Some(run) = runs.into_iter().next() else {
        return Err(Unread::Unreadable("the files hold no state".to_owned()));
    };
    let open = run.sample.filter(|_| mapping.is_sample_open);
    let sample = open.unwrap_or(mapping.sample);
    if let Some(why) = unfit(case, sample, &run) {
        return Err(Unread::Unreadable(why));
    }
    if let Some(why) = other_cells(case, run.cells) {
        return Err(Unread::Unreadable(why));
    }
    Ok(ReadResult { states: run.states, sample, notes: run.notes, digest })
}

/// Why a result that could be read cannot be that of its case: cut, without a quantity, of another mesh, or with a pressure
/// that the load cannot cause. The first that applies.
fn unfit(case: &Case, sample: Sample, run: &Run) -> Option<String> {
    if let Some(file) = run.unended.first() {
        return Some(not_ended(file));
    }
    let when =
        |place: usize| format!("T_v = {}", short(run.states[place].time / case.seconds_per_time_factor()));
    if let Some(absent) = run.expected.absent(&run.states).first() {
        return Some(absent.sentence(when));
    }
    run.states.iter().enumerate().find_map(|(place, state)| {
        let why = other_mesh(case, sample, state).or_else(|| beyond_the_load(case, state))?;
        Some(format!("at {}, {why}", when(place)))
    })
}

/// Whether nodes or centres stand at more heights than the cells of the case have: a finer mesh's are whole, too.
fn other_mesh(case: &Case, sample: Sample, state: &SampledState) -> Option<String> {
    let most = match sample {
        Sample::Nodes => case.cells + 1,
        Sample::Centres => case.cells,
        Sample::Points | Sample::Surface => return None,
    };
    let heights = distinct(&state.initial_height, case.column.height);
    (heights > most).then(|| {
        format!(
            "the {} of the result stand at {heights} heights, and {} cells have {most}: it is another mesh's, or its \
             places are no {} (`sample` in the mapping; `rows` chooses corners)",
            sample.name(),
            case.cells,
            sample.name()
        )
    })
}

/// Whether the files show a number of cells that is not that of the case.
fn other_cells(case: &Case, shown: Option<usize>) -> Option<String> {
    let cells = shown.filter(|cells| *cells != case.cells)?;
    Some(format!(
        "the mesh of the result has {cells} cells over the height, and the case asks for {}",
        case.cells
    ))
}

/// How many places differ.
fn distinct(places: &[f64], extent: f64) -> usize {
    let mut sorted = places.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup_by(|later, earlier| *later - *earlier <= SAME_PLACE * extent);
    sorted.len()
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
        short(case.column.pressure_scale())
    ))
}

/// An error of the import, distinguished if it is about a value that is not finite.
fn why_unread(error: &ImportError) -> Unread {
    let told = error.to_string();
    let is_value = matches!(error, ImportError::Content { .. });
    if is_value && names_no_finite_number(&told) { Unread::NotFinite(told) } else { Unread::Unreadable(told) }
}

/// Whether a sentence of the import names a value that is infinite or no number: quoted, or at the end of `is`.
fn names_no_finite_number(told: &str) -> bool {
    let is_it = |word: &str| word.parse::<f64>().is_ok_and(|number| !number.is_finite());
    let quoted = told.split('`').skip(1).step_by(2).any(is_it);
    let said = told.split(" is ").skip(1).filter_map(|rest| rest.split([' ', ';', ',']).next());
    quoted || said.into_iter().any(is_it)
}

/// Digest over the contents of files in their order; where one cannot be read, what could.
fn digest_of(files: &[PathBuf]) -> String {
    let mut hasher = blake3::Hasher::new();
    for path in files {
        // A file that vanishes meanwhile is told when it is read.
        let _ = input_file::open(path).and_then(|file| hasher.update_reader(file).map(|_| ()));
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pressure_that_the_load_cannot_cause_is_told_wherever_it_stands() {
        let text =
            "title = 't'\nscene = 'terzaghi'\ncolumn.load = 37.0\n[[sweep]]\nmethod = ['MPM']\ncells = [2]\n"
                .to_owned();
        let source = crate::study::file::StudySource { name: "t.toml".to_owned(), text };
        let study = crate::study::check::Study::check(&source).expect("sound");
        let mut case = study.planned[0].case.clone();
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
            let mut solver = crate::foreign::attachment::tests::solver(folder.path(), &["true"]);
            (solver.time_step, solver.mapping) = (of_study, Some("m.toml".to_owned()));
            assert_eq!(mapping_of(&solver, false).expect("a mapping").time.step, taken);
        }
    }

    #[test]
    fn a_result_has_at_most_the_heights_of_the_case() {
        let case = Case {
            cells: 4,
            ..Case::seed(crate::case::Task::Solve, oedometer_mpm::scene::SceneKind::Terzaghi)
        };
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
            let sentence = format!("has {shown} cells over the height, and the case asks for 4");
            assert!(found.is_none_or(|found| found.ends_with(&sentence)), "{sentence}");
        }
        assert_eq!(other_cells(&case, None), None, "a table shows no cells");
    }
}
