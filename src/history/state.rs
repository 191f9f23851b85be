//! One state of studies: their values, and the inputs that they belong to, from records or golden files.

use crate::case::Case;
use crate::golden::GoldenFile;
use crate::golden::text_error::GoldenTextError;
use crate::history::repository::{Commit, GitError, Repository};
use crate::record::named_cases::NamedCases;
use crate::record::{Record, RecordStore};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_soil::wording::count_of;
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
    fn golden_values_of_a_study_lie_directly_in_their_folder() {
        for (path, name) in [("golden/a.csv", Some("a")), ("golden/b/a.csv", None), ("other/a.csv", None)] {
            assert_eq!(golden_name(path, "golden"), name, "{path}");
        }
    }
}
