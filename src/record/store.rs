//! Records on disk: a small study has a folder a case, a large one has packs.

use crate::case::Case;
use crate::record::csv::rows_at_hand::RowsAtHand;
use crate::record::origins::Origins;
use crate::record::pack::index::Damage;
use crate::record::packed_store::{CaseEnd, Entry, PackedStore, number_of};
use crate::record::provenance::Provenance;
use crate::record::whole_file::StoreError;
use crate::record::{Record, SCHEMA, Status, WallSample, single_files};
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Cases up to which each has files of its own: a person looks at them one by one, and a folder lists them.
pub const MOST_SINGLE_CASES: usize = 64;

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

impl Found {
    /// Whether there is nothing left to do.
    pub fn is_finished(&self) -> bool {
        matches!(self, Self::Finished(_))
    }
}

/// The same, as far as it is known without reading a whole record.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// Nothing that could be used.
    Nothing,
    /// A record that a program of another version or of other sources made.
    OfAnotherProgram,
    /// A record of this program and of the build with this tag, which came to its end.
    Ok {
        /// Tag of the build.
        build: u64,
    },
    /// A finished record of this program, read.
    Read(Box<Record>),
}

/// What of a record says where it comes from.
#[derive(Deserialize)]
struct Head {
    schema: u32,
    hash: String,
    provenance: Provenance,
}

/// The records of one study.
///
/// Where there are packs every record goes there, and one in a pack is newer than a file of its own.
#[derive(Clone, Debug)]
pub struct RecordStore {
    folder: PathBuf,
    packs: Arc<PackedStore>,
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
        let packs = Arc::new(PackedStore::new(&folder));
        let is_packed = cases > MOST_SINGLE_CASES || packs.has_records();
        Self { folder, packs, is_packed }
    }

    /// Folder of the study's results.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Folder of a case, by its hash.
    pub fn folder_of(&self, hash: &str) -> PathBuf {
        self.folder.join("cases").join(hash)
    }

    /// Whether records go into packs.
    pub fn is_packed(&self) -> bool {
        self.is_packed
    }

    /// What of the packs is no record.
    pub fn damages(&self) -> Vec<Damage> {
        self.packs.damages()
    }

    /// What is known of the packed records without unpacking them, in no order.
    pub fn entries(&self) -> Vec<Entry> {
        self.packs.entries()
    }

    /// What is known of the packed record of a case.
    pub fn entry(&self, case: &Case) -> Option<Entry> {
        self.packs.entry(case.number())
    }

    /// Whether a program of these sources finished a case, as far as the packs tell without unpacking.
    pub fn is_done(&self, case: &Case) -> bool {
        match self.entry(case) {
            Some(entry) => entry.is_taken_up_by(&Provenance::of_this_program()),
            None => matches!(self.found(case), Found::Finished(_)),
        }
    }

    /// The record of a case that failed.
    pub fn failed(&self, case: &Case) -> Option<Record> {
        if self.entry(case).is_some_and(|entry| entry.end == CaseEnd::Ok) {
            return None;
        }
        self.kept(case).filter(|record| record.status != Status::Ok)
    }

    /// Whether there is a whole record of a case.
    pub fn has(&self, case: &Case) -> bool {
        self.packs.text(case.number()).is_some() || single_files::text(&self.folder, &case.hash()).is_some()
    }

    /// Takes over the record of a case from another store as it is, where both are packed and it has a whole one
    /// there; whether it did.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn take_over(&self, other: &Self, case: &Case) -> Result<bool, StoreError> {
        if self.is_packed { self.packs.take_over(&other.packs, case.number()) } else { Ok(false) }
    }

    /// What made the records of some cases.
    pub fn origins(&self, cases: &[&Case]) -> Origins {
        let mut origins = Origins::default();
        let mut by_tags: HashMap<(u64, u64), (&Case, usize)> = HashMap::new();
        for case in cases {
            match self.entry(case) {
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

    /// Makes the rows of every record that is written from now on, for a table that is written at the end of this run.
    pub fn keep_rows_at_hand(&self) {
        self.packs.keep_rows_at_hand();
    }

    /// The rows that were made so.
    pub fn take_rows_at_hand(&self) -> Option<RowsAtHand> {
        self.packs.take_rows_at_hand()
    }

    /// The packs, each with the bytes of it that are whole.
    pub fn packs(&self) -> Vec<(PathBuf, u64)> {
        self.packs.packs()
    }

    /// Takes note of what other writers appended since the store was opened.
    pub fn refresh(&self) {
        self.packs.refresh();
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
    /// A record that cannot be read, was damaged, is of another layout or of another case is as good as none, and so
    /// is one that ran out of its time, or whose attached solver failed: the case is run again, and so it is where
    /// another program made its record.
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

    /// What there is of a case to take up, without reading more of a packed record than that it is whole; a failed
    /// one is read.
    pub fn standing(&self, case: &Case) -> Standing {
        let own = Provenance::of_this_program();
        let number = case.number();
        let standing = |found| match found {
            Found::Nothing => Standing::Nothing,
            Found::OfAnotherProgram => Standing::OfAnotherProgram,
            Found::Finished(record) => Standing::Read(record),
        };
        match self.packs.entry(number) {
            Some(entry) if entry.end == CaseEnd::Ok => match self.packs.text(number) {
                None => Standing::Nothing,
                Some(_) if !entry.is_taken_up_by(&own) => Standing::OfAnotherProgram,
                Some(_) => Standing::Ok { build: entry.build },
            },
            _ => standing(self.found(case)),
        }
    }

    /// What made the record of a case, if there is one of this layout that is whole.
    pub fn origin(&self, case: &Case) -> Option<Provenance> {
        let hash = case.hash();
        let text = self.packs.text(number_of(&hash)).or_else(|| single_files::text(&self.folder, &hash))?;
        let head: Head = serde_json::from_str(&text).ok()?;
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
        let mut hashes: Vec<String> = packed.chain(single_files::hashes(&self.folder)).collect();
        hashes.sort_unstable();
        hashes.dedup();
        hashes
    }

    /// The build of a packed record with its wall times, without reading the rest of it.
    pub fn entry_and_wall(&self, case: &Case) -> Option<(Entry, Vec<WallSample>)> {
        let number = case.number();
        Some((self.packs.entry(number)?, self.packs.text_and_wall(number)?.1))
    }

    fn of_hash(&self, hash: &str) -> Option<Record> {
        let single =
            || Some((single_files::text(&self.folder, hash)?, single_files::wall(&self.folder, hash)));
        let (text, wall) = self.packs.text_and_wall(number_of(hash)).or_else(single)?;
        let mut record = Record::from_json(&text).ok()?;
        record.wall = wall;
        record.digest.clear();
        (record.schema == SCHEMA).then_some(record)
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
        if self.is_packed { self.packs.write(record) } else { single_files::write(&self.folder, record) }
    }

    /// Writes the wall times of a record alone.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write_wall(&self, record: &Record) -> Result<(), StoreError> {
        if self.is_packed && self.packs.entry(number_of(&record.hash)).is_none() {
            // That of a study which has grown since has files of its own: times alone would belong to nothing.
            self.write(record)
        } else if self.is_packed {
            self.packs.write_wall(record)
        } else {
            single_files::write_wall(&self.folder, record)
        }
    }
}

#[cfg(test)]
mod model;
