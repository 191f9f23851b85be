//! Records on disk: one folder a case, named after its hash, written whole or not at all.

use super::{Provenance, Record, SCHEMA};
use crate::study::Case;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// File of a record within its folder.
const RECORD: &str = "record.json";
/// File of its wall times, beside it.
const WALL: &str = "wall.json";

/// Why a record could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file system said no.
    #[error("cannot {action} {path}: {source}")]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// Its answer.
        source: std::io::Error,
    },
    /// A record cannot be put into JSON.
    #[error("cannot write {path} as JSON: {source}")]
    Json {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
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
        self.folder.join("cases").join(hash).join(file)
    }

    /// The finished record of a case, if there is one that this very program made.
    ///
    /// A record that cannot be read, was damaged, is of another layout, of another case or of other sources is
    /// as good as none, and so is one that ran out of its time: the case is run again.
    pub fn finished(&self, case: &Case) -> Option<Record> {
        let own = Provenance::of_this_program();
        self.kept(case).filter(|record| {
            record.provenance.sources == own.sources
                && record.provenance.profile == own.profile
                && !record.status.is_late()
        })
    }

    /// The record of a case, whichever program of this layout made it.
    pub fn kept(&self, case: &Case) -> Option<Record> {
        let text = fs::read_to_string(self.path(&case.hash(), RECORD)).ok()?;
        if !is_whole(&text) {
            return None;
        }
        let mut record: Record = serde_json::from_str(&text).ok()?;
        // Without readable wall times the case is done all the same, only not timed.
        let wall = fs::read_to_string(self.path(&record.hash, WALL)).ok();
        record.wall = wall.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        record.digest.clear();
        (record.schema == SCHEMA && record.case == *case).then_some(record)
    }

    /// Whether a record of this hash is on disk.
    pub fn has(&self, hash: &str) -> bool {
        self.path(hash, RECORD).is_file()
    }

    /// Writes a record: first under another name, then renamed, so that a reader sees the whole
    /// of it or nothing.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, record: &Record) -> Result<(), StoreError> {
        self.write_wall(record)?;
        let path = self.path(&record.hash, RECORD);
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

/// Writes a file under a temporary name and renames it, making its folders; it is on the disk then.
///
/// # Errors
/// When the file system refuses; nothing is left under the name then.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    write_renamed(path, content, fs::File::sync_all)
}

fn write_renamed(
    path: &Path,
    content: &[u8],
    finish: impl Fn(&fs::File) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|source| StoreError::Io {
        action: "make the folder",
        path: folder.to_owned(),
        source,
    })?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = folder.join(format!(".{name}.{}.part", std::process::id()));
    let written = fs::File::create(&temporary).and_then(|mut file| {
        file.write_all(content)?;
        finish(&file)
    });
    written.and_then(|()| fs::rename(&temporary, path)).map_err(|source| {
        // What is half written is of no use to anyone.
        let _ = fs::remove_file(&temporary);
        StoreError::Io { action: "write", path: path.to_owned(), source }
    })
}
