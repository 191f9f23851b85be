//! Records on disk: one folder per case in a small study, packs in a large one.

use crate::case::Case;
use crate::record::pack::{Damage, Entry, Packs};
use crate::record::whole_file::{Layout, StoreError, is_whole, sealed, write_rebuildable};
use crate::record::{Origins, Provenance, Record, SCHEMA, WallSample};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Cases up to which each has files of its own: a person looks at them one by one, and a folder lists them.
pub const MOST_SINGLE_CASES: usize = 64;
/// Folder of the cases of a small study, within that of its results.
const CASES: &str = "cases";
/// File of a record in the folder of its case.
const RECORD: &str = "record.json";
/// File of its wall times, beside it.
const WALL: &str = "wall.json";

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
///
/// Where there are packs every record goes there, and one in a pack is newer than a file of its own.
#[derive(Clone, Debug)]
pub struct RecordStore {
    folder: PathBuf,
    packs: Arc<Packs>,
    is_packed: bool,
}

impl RecordStore {
    /// The store of a study below a folder of results; a new one has a folder a case.
    pub fn new(results: &Path, study: &str) -> Self {
        Self::for_cases(results, study, 0)
    }

    /// The store of a study of so many cases below a folder of results; that of many is packed.
    pub fn for_cases(results: &Path, study: &str, cases: usize) -> Self {
        let folder = results.join(study);
        let packs = Arc::new(Packs::new(&folder));
        let is_packed = cases > MOST_SINGLE_CASES || !packs.entries().is_empty();
        Self { folder, packs, is_packed }
    }

    /// Folder of the study's results.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Folder of a case, by its hash.
    pub fn folder_of(&self, hash: &str) -> PathBuf {
        self.folder.join(CASES).join(hash)
    }

    /// Whether records go into packs.
    pub fn is_packed(&self) -> bool {
        self.is_packed
    }

    /// Damaged bytes of the packs.
    pub fn damages(&self) -> Vec<Damage> {
        self.packs.damages()
    }

    /// Takes note of what other writers appended since the store was opened.
    pub fn refresh(&self) {
        self.packs.refresh();
    }

    /// Whether a program of these sources finished a case, as far as the packs tell without unpacking.
    pub fn is_done(&self, case: &Case) -> bool {
        match self.packs.entry(case.number()) {
            Some(entry) => entry.is_taken_up_by(&Provenance::of_this_program()),
            None => self.finished(case).is_some(),
        }
    }

    /// Whether there is a whole record of a case.
    pub fn has(&self, case: &Case) -> bool {
        self.texts(&case.hash()).is_some()
    }

    /// What made the records of some cases; of packed ones that one build made only the first is read.
    pub fn origins(&self, cases: &[&Case]) -> Origins {
        let mut origins = Origins::default();
        let mut by_tags: HashMap<(u64, u64), (&Case, usize)> = HashMap::new();
        for case in cases {
            match self.packs.entry(case.number()) {
                Some(entry) => by_tags.entry((entry.program, entry.build)).or_insert((case, 0)).1 += 1,
                None => self.origin(case).iter().for_each(|origin| origins.add(origin)),
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
    /// one that ran out of its time, or whose attached solver failed: the case is run again, and so it is where another
    /// program made its record.
    /// Another build of the same sources gives the same values and is taken up, without its wall times, which are
    /// that build's own.
    pub fn found(&self, case: &Case) -> Found {
        let own = Provenance::of_this_program();
        let Some(mut record) = self.kept(case).filter(|record| !record.status.is_worth_another_run()) else {
            return Found::Nothing;
        };
        if !record.provenance.is_of_one_program_with(&own) {
            return Found::OfAnotherProgram;
        }
        if !record.provenance.is_of_one_build_with(&own) {
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
        let packed = self.packs.entries().into_iter().map(|entry| format!("{:016x}", entry.case));
        let folders = fs::read_dir(self.folder.join(CASES)).into_iter().flatten().flatten();
        let single = folders.filter_map(|folder| folder.file_name().into_string().ok());
        let mut hashes: Vec<String> = packed.chain(single).collect();
        hashes.sort_unstable();
        hashes.dedup();
        hashes
    }

    fn of_hash(&self, hash: &str) -> Option<Record> {
        let (text, wall) = self.texts(hash)?;
        let mut record = Record::from_json(&text).ok()?;
        record.wall = wall;
        record.digest.clear();
        (record.schema == SCHEMA).then_some(record)
    }

    /// The text of the record of a case, where it is whole, and its wall times. Without readable ones the case is done
    /// all the same, only not timed.
    fn texts(&self, hash: &str) -> Option<(String, Vec<WallSample>)> {
        if let Some((text, wall)) = self.packs.texts(number_of(hash)) {
            let wall = serde_json::from_str::<WallLine>(&wall).map(|line| line.wall).unwrap_or_default();
            return Some((text, wall));
        }
        let read = |file| fs::read_to_string(self.folder_of(hash).join(file)).ok();
        let text = read(RECORD).filter(|text| is_whole(text))?;
        let wall = read(WALL).and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        Some((text, wall))
    }

    /// Writes a record so that a reader sees the whole of it or nothing.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, record: &Record) -> Result<(), StoreError> {
        // One that was read has the seal of its file.
        let unsealed;
        let record = if record.digest.is_empty() {
            record
        } else {
            unsealed = Record { digest: String::new(), ..record.clone() };
            &unsealed
        };
        if self.is_packed { self.append(record) } else { self.write_files(record) }
    }

    fn append(&self, record: &Record) -> Result<(), StoreError> {
        let json = |source| StoreError::Json { path: self.folder.clone(), source };
        let line = WallLine { hash: record.hash.clone(), wall: record.wall.clone() };
        let wall = serde_json::to_string(&line).map_err(json)?;
        let text = sealed(record, Layout::OneLine).map_err(json)? + "\n" + &wall + "\n";
        self.packs.append(
            Entry::new(number_of(&record.hash), record.status.is_worth_another_run(), &record.provenance),
            &text,
        )
    }

    fn write_files(&self, record: &Record) -> Result<(), StoreError> {
        let path = self.folder_of(&record.hash).join(RECORD);
        self.write_wall(record)?;
        let text = sealed(record, Layout::Lines)
            .map_err(|source| StoreError::Json { path: path.clone(), source })?;
        // Not forced to the disk, which costs more than a small case: after a loss of power an unreadable record
        // counts as none, and the case runs again.
        write_rebuildable(&path, text.as_bytes())
    }

    /// Writes the wall times of a record that is kept already: alone where they have a file of their own.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write_wall(&self, record: &Record) -> Result<(), StoreError> {
        if self.is_packed {
            return self.write(record);
        }
        let path = self.folder_of(&record.hash).join(WALL);
        let text = serde_json::to_string_pretty(&record.wall)
            .map_err(|source| StoreError::Json { path: path.clone(), source })?;
        write_rebuildable(&path, text.as_bytes())
    }
}

/// The number that the hash of a case is.
fn number_of(hash: &str) -> u64 {
    u64::from_str_radix(hash, 16).unwrap_or(0)
}

#[cfg(test)]
mod tests;
