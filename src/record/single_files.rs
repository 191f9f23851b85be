//! Records of small studies: one folder a case, named after its hash, with the record and its wall times, each a
//! file that a person can read.

use crate::record::seal::{Layout, is_whole, sealed};
use crate::record::whole_file::{StoreError, remove_stale, write_renamed};
use crate::record::{Record, WallSample};
use std::fs;
use std::path::{Path, PathBuf};

/// File of a record within its folder.
const RECORD: &str = "record.json";
/// File of its wall times, beside it.
const WALL: &str = "wall.json";

fn path(study: &Path, hash: &str, file: &str) -> PathBuf {
    study.join("cases").join(hash).join(file)
}

/// Text of the record of a case, where it is whole.
pub fn text(study: &Path, hash: &str) -> Option<String> {
    fs::read_to_string(path(study, hash, RECORD)).ok().filter(|text| is_whole(text))
}

/// Wall times of a case. Without readable ones it is done all the same, only not timed.
pub fn wall(study: &Path, hash: &str) -> Vec<WallSample> {
    let text = fs::read_to_string(path(study, hash, WALL)).ok();
    text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

/// Hashes of the cases that have a folder.
pub fn hashes(study: &Path) -> Vec<String> {
    let folders = fs::read_dir(study.join("cases")).into_iter().flatten().flatten();
    folders.filter_map(|folder| folder.file_name().into_string().ok()).collect()
}

/// Writes a record that carries no digest: first under another name, then renamed, so that a reader sees the whole
/// of it or nothing.
///
/// # Errors
/// When the file system refuses.
pub fn write(study: &Path, record: &Record) -> Result<(), StoreError> {
    let path = path(study, &record.hash, RECORD);
    if let Some(folder) = path.parent() {
        remove_stale(folder);
    }
    write_wall(study, record)?;
    let json = |source| StoreError::Json { path: path.clone(), source };
    write_renamed(&path, sealed(record, Layout::Lines).map_err(json)?.as_bytes(), |_| Ok(()))
}

/// Writes the wall times of a record alone.
///
/// # Errors
/// When the file system refuses.
pub fn write_wall(study: &Path, record: &Record) -> Result<(), StoreError> {
    let path = path(study, &record.hash, WALL);
    let json = |source| StoreError::Json { path: path.clone(), source };
    let text = serde_json::to_string_pretty(&record.wall).map_err(json)?;
    // Not forced to the disk, which costs more than a small case: after a loss of power an unreadable
    // record is as good as none, and the case runs again.
    write_renamed(&path, text.as_bytes(), |_| Ok(()))
}
