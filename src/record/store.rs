//! The records of a study on disk: all of them in packs, whatever the size of the study.

use crate::case::Case;
use crate::record::atomic_file::{StoreError, sealed};
use crate::record::named_cases::NamedCases;
use crate::record::pack::{Entry, Packs};
use crate::record::{Origins, Provenance, Record, SCHEMA, WallSample};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Working folders of other programs, within that of a study's results.
const CASES: &str = "cases";
/// File of a record in a folder of its case, in the layout of version 0.2.
const RECORD_OF_OLD: &str = "record.json";

/// What there is of a case to take up.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Nothing that could be used.
    Nothing,
    /// A record that a program of another version or of other sources made.
    OfAnotherProgram,
    /// A finished record of this program.
    Finished(Box<Record>),
}

/// The fields of a record that say where it comes from.
#[derive(Deserialize)]
struct Head {
    schema: u32,
    hash: String,
    provenance: Provenance,
}

/// The line of wall times behind a record in a pack.
#[derive(Serialize, Deserialize)]
struct WallLine {
    hash: String,
    wall: Vec<WallSample>,
}

/// The records of one study.
#[derive(Clone, Debug)]
pub struct RecordStore {
    folder: PathBuf,
    packs: Arc<Packs>,
    /// What the study names, and whether that is noted beside its records.
    named: Option<Arc<(NamedCases, AtomicBool)>>,
}

impl RecordStore {
    /// The store of a study below a folder of results.
    pub fn new(results: &Path, study: &str) -> Self {
        let folder = results.join(study);
        let packs = Arc::new(Packs::new(&folder));
        Self { folder, packs, named: None }
    }

    /// The store of a study that names these cases: they are noted before a record is written.
    #[must_use]
    pub fn naming(self, cases: &[&Case]) -> Self {
        let named = (NamedCases::from_cases(cases), AtomicBool::new(false));
        Self { named: Some(Arc::new(named)), ..self }
    }

    /// Notes beside the records which cases the study names; nothing where that is not known.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn note_named_cases(&self) -> Result<(), StoreError> {
        match self.named.as_deref() {
            Some((named, is_noted)) if !is_noted.swap(true, Ordering::Relaxed) => named.write(&self.folder),
            _ => Ok(()),
        }
    }

    /// Folder of the study's results.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Folder in which the program of a case works, by the hash of the case.
    pub fn folder_of(&self, hash: &str) -> PathBuf {
        self.folder.join(CASES).join(hash)
    }

    /// What lies in the store and is not a record of it, a sentence each: damaged bytes of the packs, and a folder of an older
    /// layout.
    pub fn passed_over(&self) -> Vec<String> {
        let damages = self.packs.damages();
        damages.iter().map(ToString::to_string).chain(self.older_layout()).collect()
    }

    /// The sentence about records of an older layout, where there are any.
    fn older_layout(&self) -> Option<String> {
        let cases = self.folder.join(CASES);
        let mut folders = fs::read_dir(&cases).into_iter().flatten().flatten();
        let is_there = folders.any(|case| case.path().join(RECORD_OF_OLD).is_file());
        is_there.then(|| {
            let cases = cases.display();
            format!("{cases} has records in the layout of version 0.2: they are not read, and the folder can be deleted")
        })
    }

    /// Takes note of what other writers appended since the store was opened.
    pub fn refresh(&self) {
        self.packs.refresh();
    }

    /// Whether a program of these sources finished a case, as far as the packs tell without unpacking.
    pub fn is_done(&self, case: &Case) -> bool {
        let entry = self.packs.entry(case.number());
        entry.is_some_and(|entry| entry.is_taken_up_by(&Provenance::of_this_program()))
    }

    /// Whether there is a whole record of a case.
    pub fn has(&self, case: &Case) -> bool {
        self.texts(&case.hash()).is_some()
    }

    /// What made the records of some cases; of those that one build made only the first is read.
    pub fn origins(&self, cases: &[&Case]) -> Origins {
        let mut origins = Origins::default();
        let mut by_tags: HashMap<(u64, u64), (&Case, usize)> = HashMap::new();
        for case in cases {
            if let Some(entry) = self.packs.entry(case.number()) {
                by_tags.entry((entry.program, entry.build)).or_insert((case, 0)).1 += 1;
            }
        }
        for (case, records) in by_tags.into_values() {
            if let Some(origin) = self.origin(case) {
                origins.add_many(&origin, records);
            }
        }
        origins
    }

    /// The finished record of a case, if there is one that a program of these sources made.
    pub fn finished(&self, case: &Case) -> Option<Record> {
        match self.found(case) {
            Found::Finished(record) => Some(*record),
            Found::Nothing | Found::OfAnotherProgram => None,
        }
    }

    /// What there is of a case to take up.
    ///
    /// A record that cannot be read, was damaged, is of another layout or of another case counts as none, and so does
    /// one that ran out of its time, or whose program failed: the case is run again, and so it is where another
    /// program made its record.
    /// Another build of the same sources gives the same values and is taken up, without its wall times, which are
    /// that build's own.
    pub fn found(&self, case: &Case) -> Found {
        let program = Provenance::of_this_program();
        let Some(mut record) = self.kept(case).filter(|record| !record.status.is_worth_another_run()) else {
            return Found::Nothing;
        };
        if !record.provenance.is_of_one_program_with(&program) {
            return Found::OfAnotherProgram;
        }
        if !record.provenance.is_of_one_build_with(&program) {
            record.wall.clear();
        }
        Found::Finished(Box::new(record))
    }

    /// What made the record of a case, if there is one of this layout that is whole.
    pub fn origin(&self, case: &Case) -> Option<Provenance> {
        let hash = case.hash();
        let head: Head = serde_json::from_str(&self.texts(&hash)?.0).ok()?;
        (head.schema == SCHEMA && head.hash == hash).then_some(head.provenance)
    }

    /// The record of a case, whichever program of this layout made it.
    pub fn kept(&self, case: &Case) -> Option<Record> {
        let mut record = self.of_hash(&case.hash())?;
        // What a label names is the present study's business.
        record.case.swept.clone_from(&case.swept);
        (record.case == *case).then_some(record)
    }

    /// The record of the case with a hash, whichever program of this layout made it.
    pub fn read(&self, hash: &str) -> Option<Record> {
        self.of_hash(hash).filter(|record| record.case.hash() == hash)
    }

    /// The hash of every case with a record, in their order.
    pub fn hashes(&self) -> Vec<String> {
        let mut hashes: Vec<String> =
            self.packs.entries().into_iter().map(|entry| format!("{:016x}", entry.case)).collect();
        hashes.sort_unstable();
        hashes
    }

    fn of_hash(&self, hash: &str) -> Option<Record> {
        let (text, wall) = self.texts(hash)?;
        let mut record = Record::from_json(&text).ok()?;
        record.wall = wall;
        record.digest.clear();
        (record.schema == SCHEMA).then_some(record)
    }

    /// The text of the record of a case, where it is whole, and its wall times. Without readable wall times the
    /// case is done, but not timed.
    fn texts(&self, hash: &str) -> Option<(String, Vec<WallSample>)> {
        let (text, wall) = self.packs.texts(number_of(hash))?;
        let wall = serde_json::from_str::<WallLine>(&wall).map(|line| line.wall).unwrap_or_default();
        Some((text, wall))
    }

    /// Appends a record with its wall times; the older one of the case counts no more.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, record: &Record) -> Result<(), StoreError> {
        self.note_named_cases()?;
        // One that was read has the seal of its text.
        let unsealed;
        let record = if record.digest.is_empty() {
            record
        } else {
            unsealed = Record { digest: String::new(), ..record.clone() };
            &unsealed
        };
        let json = |source| StoreError::Json { path: self.folder.clone(), source };
        let line = WallLine { hash: record.hash.clone(), wall: record.wall.clone() };
        let wall = serde_json::to_string(&line).map_err(json)?;
        let text = sealed(record).map_err(json)? + "\n" + &wall + "\n";
        let entry =
            Entry::new(number_of(&record.hash), record.status.is_worth_another_run(), &record.provenance);
        self.packs.append(entry, &text)
    }
}

/// The number that the hash of a case is.
fn number_of(hash: &str) -> u64 {
    u64::from_str_radix(hash, 16).unwrap_or(0)
}

#[cfg(test)]
mod tests;
