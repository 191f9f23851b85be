//! One state of the studies: their values and the inputs that produced them.

use crate::case::tier::Tier;
use crate::golden::GoldenFile;
use crate::golden::inputs::CaseInputs;
use crate::history::repository::{Commit, GitError, Repository};
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_soil::wording::count_of;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A study in one state.
#[derive(Clone, Debug)]
pub(crate) struct StudyState {
    /// Inputs, errors and work counters with their tolerances.
    pub golden: GoldenFile,
    /// Processor seconds of every run of each case by label, where they were measured.
    pub seconds: BTreeMap<String, Vec<f64>>,
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
            state.notes.extend(store.damages().iter().map(ToString::to_string));
            let hashes = store.hashes();
            let records: Vec<Record> = hashes.iter().filter_map(|hash| store.read(hash)).collect();
            if records.len() < hashes.len() {
                let unread = count_of(hashes.len() - records.len(), "record", "records");
                state.notes.push(format!(
                    "{unread} of `{name}` in {} passed over: of another layout or damaged; run the study again",
                    folder.display()
                ));
            }
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
                Some(Ok(mut golden)) => {
                    if golden.inputs.is_unknown() {
                        let source = study_of(name).and_then(|path| Some((path, texts.get(&object(path))?)));
                        let inputs = source.and_then(|(path, text)| inputs_of_study(path, text));
                        golden.inputs = inputs.unwrap_or_default();
                    }
                    state.studies.insert(name.to_owned(), StudyState::of_golden(golden));
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

impl StudyState {
    /// The state of golden values, which nobody timed.
    pub fn of_golden(golden: GoldenFile) -> Self {
        Self { golden, seconds: BTreeMap::new() }
    }

    /// The state of records.
    pub fn of_records(study: &str, records: &[Record]) -> Self {
        let timed = records.iter().filter(|record| !record.wall.is_empty());
        let seconds = timed.map(|record| {
            let runs = record.wall.iter().map(|sample| sample.cpu_seconds.unwrap_or(sample.seconds));
            (record.case.label(), runs.collect())
        });
        Self { golden: GoldenFile::of(study, records, "records"), seconds: seconds.collect() }
    }
}

/// The study whose golden file has this path, directly below the folder.
pub(crate) fn golden_name<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    let name = path.strip_prefix(folder)?.strip_prefix('/')?.strip_suffix(".csv")?;
    (!name.contains('/')).then_some(name)
}

/// The sentence about a golden file of a layout that this program does not read.
pub(crate) fn unreadable(commit: &Commit, path: &str, reason: &str) -> String {
    format!("{path} at {} is passed over: {}", commit.short(), reason.lines().next().unwrap_or_default())
}

/// The inputs of the cases of a study as it stood then; `None` where this program refuses it.
fn inputs_of_study(path: &str, text: &str) -> Option<CaseInputs> {
    let study = Study::check(&StudySource { name: path.to_owned(), text: text.to_owned() }).ok()?;
    Some(CaseInputs::of(study.cases(Tier::Full)))
}
