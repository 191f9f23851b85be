//! Records on disk: one folder a case, named after its hash, written whole or not at all.

use crate::case::Case;
use crate::record::provenance::Provenance;
use crate::record::whole_file::{StoreError, remove_stale, write_renamed};
use crate::record::{Record, SCHEMA};
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};

/// File of a record within its folder.
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

/// What of a record says where it comes from.
#[derive(Deserialize)]
struct Head {
    schema: u32,
    hash: String,
    provenance: Provenance,
}

/// The records of one study.
#[derive(Clone, Debug)]
pub struct RecordStore {
    folder: PathBuf,
}

impl RecordStore {
    /// The store of a study below a folder of results.
    pub fn new(results: &Path, study: &str) -> Self {
        Self { folder: results.join(study) }
    }

    /// Folder of the study's results.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn path(&self, hash: &str, file: &str) -> PathBuf {
        self.folder_of(hash).join(file)
    }

    /// Folder of a case, by its hash.
    pub fn folder_of(&self, hash: &str) -> PathBuf {
        self.folder.join("cases").join(hash)
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

    /// What made the record of a case, if there is one of this layout that is whole.
    pub fn origin(&self, case: &Case) -> Option<Provenance> {
        let hash = case.hash();
        let text = fs::read_to_string(self.path(&hash, RECORD)).ok().filter(|text| is_whole(text))?;
        let head: Head = serde_json::from_str(&text).ok()?;
        (head.schema == SCHEMA && head.hash == hash).then_some(head.provenance)
    }

    /// The record of a case, whichever program of this layout made it.
    pub fn kept(&self, case: &Case) -> Option<Record> {
        let text = fs::read_to_string(self.path(&case.hash(), RECORD)).ok()?;
        if !is_whole(&text) {
            return None;
        }
        let mut record: Record = serde_json::from_str(&text).ok()?;
        // What a label names is the present study's business.
        record.case.swept.clone_from(&case.swept);
        // Without readable wall times the case is done all the same, only not timed.
        let wall = fs::read_to_string(self.path(&record.hash, WALL)).ok();
        record.wall = wall.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        record.digest.clear();
        (record.schema == SCHEMA && record.case == *case).then_some(record)
    }

    /// Writes a record: first under another name, then renamed, so that a reader sees the whole
    /// of it or nothing.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, record: &Record) -> Result<(), StoreError> {
        let path = self.path(&record.hash, RECORD);
        if let Some(folder) = path.parent() {
            remove_stale(folder);
        }
        self.write_wall(record)?;
        // One that was read has the seal of its file.
        let content = if record.digest.is_empty() {
            json_of(&path, record)?
        } else {
            json_of(&path, &Record { digest: String::new(), ..record.clone() })?
        };
        write_renamed(&path, sealed(&content).as_bytes(), |_| Ok(()))
    }

    /// Writes the wall times of a record alone.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write_wall(&self, record: &Record) -> Result<(), StoreError> {
        write_json(&self.path(&record.hash, WALL), &record.wall)
    }
}

fn write_json<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), StoreError> {
    // Not forced to the disk, which costs more than a small case: after a loss of power an unreadable
    // record is as good as none, and the case runs again.
    write_renamed(path, json_of(path, value)?.as_bytes(), |_| Ok(()))
}

fn json_of<T: serde::Serialize>(path: &Path, value: &T) -> Result<String, StoreError> {
    serde_json::to_string_pretty(value).map_err(|source| StoreError::Json { path: path.to_owned(), source })
}

/// What ends the text of an object.
const END: &str = "\n}";
/// What stands before the digest, the last field of a record.
const SEAL: &str = ",\n  \"digest\": \"";
/// Hexadecimal digits of a digest.
const DIGEST_DIGITS: usize = 32;

/// A record's text with the digest of it: made of the text and not of the record, so that it is
/// written and read once.
fn sealed(content: &str) -> String {
    let content = content.strip_suffix(END).unwrap_or(content);
    format!("{content}{SEAL}{}\"{END}", digest_of(content))
}

/// Whether a text is as it was sealed.
fn is_whole(text: &str) -> bool {
    text.rsplit_once(SEAL).is_some_and(|(content, seal)| seal == format!("{}\"{END}", digest_of(content)))
}

fn digest_of(content: &str) -> String {
    blake3::hash(content.as_bytes()).to_hex()[..DIGEST_DIGITS].to_owned()
}
