//! One state of studies: their values, and the inputs that they belong to, from records, golden files, or two commands that
//! are run in turn.

use crate::campaign::runner::{RunOptions, run_study};
use crate::case::Case;
use crate::case::planned::Tier;
use crate::golden::GoldenFile;
use crate::golden::compare::compare;
use crate::golden::text_error::GoldenTextError;
use crate::history::repository::{Commit, GitError, Repository};
use crate::record::named_cases::NamedCases;
use crate::record::{Record, RecordStore, Status};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_wording::count_of;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A study in one state.
#[derive(Clone, Debug)]
pub(crate) struct StudyState {
    /// Errors and steps with their tolerances.
    pub golden: GoldenFile,
    /// The cases by their labels; none where the study of golden values is not known.
    pub cases: BTreeMap<String, Case>,
    /// Processor seconds of every run of each case by label, where they were measured.
    pub seconds: BTreeMap<String, Vec<f64>>,
    /// What made the values: this program and others, with their commits.
    pub made_by: Vec<String>,
}

/// Studies in one state.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// What the user calls it.
    pub name: String,
    /// Its studies.
    pub studies: BTreeMap<String, StudyState>,
    /// What could not be read, one sentence each.
    pub notes: Vec<String>,
}

/// Why a state cannot be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StateError {
    /// Git gives no answer.
    #[error(transparent)]
    Git(#[from] GitError),
    /// A folder without records.
    #[error("{} has no records: give the folder that `oedometer run --out` wrote, or a git revision", .0.display())]
    NoRecords(PathBuf),
    /// A revision without golden values.
    #[error("{revision} has no golden values in {folder}/")]
    NoGoldenValues {
        /// The revision.
        revision: String,
        /// Where they were looked for.
        folder: String,
    },
}

impl State {
    /// The records below a folder of results.
    ///
    /// # Errors
    /// When it has none.
    pub fn of_records(folder: &Path) -> Result<Self, StateError> {
        let mut state =
            Self { name: folder.display().to_string(), studies: BTreeMap::new(), notes: Vec::new() };
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for name in entries.filter(|entry| entry.path().is_dir()).map(|entry| entry.file_name()) {
            let name = name.to_string_lossy().into_owned();
            let store = RecordStore::new(folder, &name);
            state.notes.extend(store.passed_over());
            let hashes = store.hashes();
            let mut records: Vec<Record> = hashes.iter().filter_map(|hash| store.read(hash)).collect();
            if records.len() < hashes.len() {
                let unread = count_of(hashes.len() - records.len(), "record", "records");
                state.notes.push(format!(
                    "{unread} of `{name}` in {} skipped, because their layout is different or they are \
                     damaged; run the study again",
                    folder.display()
                ));
            }
            let earlier = NamedCases::read(store.folder()).and_then(|named| leave_out(&named, &mut records));
            state.notes.extend(earlier.map(|note| format!("`{name}` in {}: {note}", folder.display())));
            if !records.is_empty() {
                state.studies.insert(name.clone(), StudyState::of_records(&name, &records));
            }
        }
        if state.studies.is_empty() && state.notes.is_empty() {
            return Err(StateError::NoRecords(folder.to_owned()));
        }
        Ok(state)
    }

    /// The golden values of a revision in a folder of the repository.
    ///
    /// # Errors
    /// When git fails or finds no commits.
    pub fn of_revision(repository: &Repository, revision: &str, folder: &str) -> Result<Self, StateError> {
        let commit = repository.commit(revision)?;
        let files = repository.files(&commit)?;
        let golden = files.iter().filter_map(|path| Some((path, golden_name(path, folder)?)));
        let golden: Vec<(&String, &str)> = golden.collect();
        let object = |path: &str| format!("{}:{path}", commit.hash);
        let study_of = |name: &str| {
            let end = format!("/{name}.toml");
            files.iter().find(|path| path.ends_with(&end) || **path == end[1..])
        };
        let mut objects: Vec<String> = golden.iter().map(|(path, _)| object(path)).collect();
        objects.extend(golden.iter().filter_map(|(_, name)| study_of(name)).map(|path| object(path)));
        let texts = repository.texts(&objects)?;
        let mut state = Self {
            name: format!("{revision} ({})", commit.short()),
            studies: BTreeMap::new(),
            notes: Vec::new(),
        };
        for (path, name) in golden {
            let read = texts.get(&object(path)).map(|text| GoldenFile::from_text(text));
            match read {
                Some(Ok(golden)) => {
                    let source = study_of(name).and_then(|path| Some((path, texts.get(&object(path))?)));
                    let cases = source.and_then(|(path, text)| cases_of_study(path, text));
                    let made_by = vec![format!("what commit {} has", commit.short())];
                    let cases = cases.unwrap_or_default();
                    let known = StudyState { cases, made_by, ..StudyState::of_golden(golden) };
                    state.studies.insert(name.to_owned(), known);
                }
                Some(Err(reason)) => state.notes.push(unreadable(&commit, path, &reason)),
                None => {}
            }
        }
        if state.studies.is_empty() && state.notes.is_empty() {
            return Err(StateError::NoGoldenValues { revision: state.name, folder: folder.to_owned() });
        }
        Ok(state)
    }
}

/// Takes the records out whose cases the study no longer names; a sentence on them where there are any.
fn leave_out(named: &NamedCases, records: &mut Vec<Record>) -> Option<String> {
    let earlier: Vec<Record> = records.extract_if(.., |record| !named.names(record)).collect();
    let first = earlier.first()?;
    let [record, is] = if earlier.len() == 1 { ["record", "is"] } else { ["records", "are"] };
    Some(format!(
        "{} {record} of earlier states of the study {is} left out, like {} {}",
        earlier.len(),
        first.hash,
        first.case.label()
    ))
}

impl StudyState {
    /// The state of golden values alone, which have no times.
    pub fn of_golden(golden: GoldenFile) -> Self {
        Self { golden, cases: BTreeMap::new(), seconds: BTreeMap::new(), made_by: Vec::new() }
    }

    /// The state of records.
    pub fn of_records(study: &str, records: &[Record]) -> Self {
        let timed = records.iter().filter(|record| !record.wall.is_empty());
        let seconds = timed.map(|record| {
            let runs = record.wall.iter().map(|sample| sample.cpu_seconds.unwrap_or(sample.seconds));
            (record.case.label(), runs.collect())
        });
        let of_others = |record: &Record| {
            let about = record.outside_run()?;
            Some(format!("`{}` by {}", record.case.method, about.made_by()))
        };
        let programs = records.iter().map(|record| record.provenance.made_by());
        let made_by: BTreeSet<String> = programs.chain(records.iter().filter_map(of_others)).collect();
        Self {
            golden: GoldenFile::of(study, records, "records"),
            cases: records.iter().map(|record| (record.case.label(), record.case.clone())).collect(),
            seconds: seconds.collect(),
            made_by: made_by.into_iter().collect(),
        }
    }
}

/// The study whose golden file has this path, directly below the folder.
pub(crate) fn golden_name<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    let name = path.strip_prefix(folder)?.strip_prefix('/')?.strip_suffix(".csv")?;
    (!name.contains('/')).then_some(name)
}

/// The sentence about a golden file of a layout that this program does not read.
pub(crate) fn unreadable(commit: &Commit, path: &str, reason: &GoldenTextError) -> String {
    let reason = reason.to_string();
    format!("{path} at {} is skipped: {}", commit.short(), reason.lines().next().unwrap_or_default())
}

/// The cases of a study as it stood then; `None` where this program refuses it.
pub(crate) fn cases_of_study(path: &str, text: &str) -> Option<BTreeMap<String, Case>> {
    let study = Study::check(&StudySource { name: path.to_owned(), text: text.to_owned() }).ok()?;
    Some(study.planned.into_iter().map(|planned| (planned.case.label(), planned.case)).collect())
}

/// The study with a command in place of that of its one solver, and with the cases of that solver alone. The command is
/// words with blanks between them and the placeholders of `[[solver]]`.
///
/// # Errors
/// When the study attaches no solver or several, or the command is empty.
pub(crate) fn with_command(study: &Study, command: &str) -> Result<Study, String> {
    let mut study = study.clone();
    let [solver] = study.solvers.as_mut_slice() else {
        let count = study.solvers.len();
        return Err(format!(
            "{} attaches {count} solvers: `--commands` needs a study with one `[[solver]]`",
            study.name
        ));
    };
    solver.command = command.split_whitespace().map(str::to_owned).collect();
    if solver.command.is_empty() {
        return Err(
            "the command is empty: give a program with its arguments, like `python3 new.py {case} {out}`"
                .to_owned(),
        );
    }
    // Nothing of a result that is there already, one run a round, and no version of another program.
    (solver.repeats, solver.warm_up) = (1, false);
    (solver.files, solver.version, solver.known_by) = (Vec::new(), Vec::new(), None);
    let method = solver.method();
    study.planned.retain(|planned| planned.case.method == method);
    Ok(study)
}

/// The states of two commands after some rounds: the values are those of the first round, the times those of all. Every
/// other round begins with the second command, so that a machine that slows down slows both.
pub(crate) fn states_of_commands(study: &[Study; 2], names: [&str; 2], rounds: usize) -> [State; 2] {
    let mut states =
        names.map(|name| State { name: format!("`{name}`"), studies: BTreeMap::new(), notes: Vec::new() });
    for round in 0..rounds {
        for side in if round % 2 == 0 { [0, 1] } else { [1, 0] } {
            let report = run_study(&study[side], &RunOptions::whole(Tier::Full, 1), None, &|_| {});
            let failed = report.records.iter().filter(|record| record.status != Status::Ok);
            let failed = failed.map(|record| format!("{}: {}", record.case.label(), record.status.name()));
            let failures = report.errors.iter().map(ToString::to_string).chain(failed);
            if round == 0 {
                let name = states[side].name.clone();
                states[side].notes.extend(failures.map(|what| format!("{name}: {what}")));
            }
            states[side].add_round(&study[side].name, &report.records);
        }
    }
    states
}

impl State {
    /// Takes the values of the first round and the times of each.
    fn add_round(&mut self, study: &str, records: &[Record]) {
        let state = StudyState::of_records(study, records);
        let Some(first) = self.studies.get_mut(study) else {
            self.studies.insert(study.to_owned(), state);
            return;
        };
        let others = compare(&first.golden, &state.golden.values).len();
        if others > 0 {
            self.notes.push(format!("{}: {others} values of {study} differ from round to round", self.name));
        }
        for (case, seconds) in state.seconds {
            first.seconds.entry(case).or_default().extend(seconds);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    #[test]
    fn the_seconds_of_a_state_are_the_processor_s_where_they_are_known() {
        let mut records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2, 3]\n",
        );
        records[0].wall = [(5.0, Some(3.0)), (7.0, None)]
            .map(|(seconds, cpu_seconds)| WallSample { seconds, cpu_seconds, ..WallSample::default() })
            .to_vec();
        records[1].wall.clear();
        let state = StudyState::of_records("s", &records);
        assert_eq!(state.seconds.get(&records[0].case.label()), Some(&vec![3.0, 7.0]));
        assert_eq!(state.seconds.len(), 1, "what was not timed has none");
    }

    #[test]
    fn a_command_stands_for_the_one_solver_of_a_study_once_a_round_and_for_its_cases_alone() {
        let study = |solvers: &[&str]| {
            let solver = |name: &&str| {
                format!(
                    "[[solver]]\nname = \"{name}\"\ncommand = [\"old\"]\nresult = \"{{out}}/a.csv\"\nrepeats = 3\nwarm_up = true\n\
                     version = [\"old\", \"--version\"]\n"
                )
            };
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\n{}[[sweep]]\nmethod = ['MPM', '{}']\nintegrator = ['implicit']\n\
                 cells = [4]\n",
                solvers.iter().map(solver).collect::<String>(),
                solvers.first().unwrap_or(&"GIMP")
            );
            Study::check(&StudySource { name: "s.toml".to_owned(), text }).expect("sound")
        };
        let mut before = study(&["toy"]);
        before.solvers[0].files = vec!["a.csv".to_owned()];
        let found = with_command(&before, " new  {case} {out} ").expect("one solver");
        let solver = &found.solvers[0];
        assert_eq!(solver.command, ["new", "{case}", "{out}"]);
        assert_eq!(
            (solver.repeats, solver.warm_up, solver.version.len(), solver.is_given()),
            (1, false, 0, false)
        );
        assert!(found.planned.len() == 1 && !found.planned[0].case.has_integrator());
        let empty =
            "the command is empty: give a program with its arguments, like `python3 new.py {case} {out}`";
        let several = |count: usize| {
            format!("s attaches {count} solvers: `--commands` needs a study with one `[[solver]]`")
        };
        for (solvers, command, told) in [
            (&["toy"][..], " ", empty.to_owned()),
            (&["toy", "other"], "new", several(2)),
            (&[], "new", several(0)),
        ] {
            assert_eq!(with_command(&study(solvers), command).err(), Some(told));
        }
        for (path, name) in [("golden/a.csv", Some("a")), ("golden/b/a.csv", None), ("other/a.csv", None)] {
            assert_eq!(golden_name(path, "golden"), name, "{path}");
        }
    }
}
