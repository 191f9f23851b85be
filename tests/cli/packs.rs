//! The records of a study on disk, for the tests that look at them: read by the library, changed as another program would,
//! and damaged in the bytes of their packs.

use flate2::bufread::MultiGzDecoder;
use flate2::{Compression, GzBuilder};
use oedometer::{Record, RecordStore};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes of the header of a member: what every one begins with, then its kind, the count of its run, the hash of its case,
/// two tags, and the length of the whole.
const HEADER: usize = 49;
const CASE: Range<usize> = 21..29;
const LENGTH: Range<usize> = 45..49;

/// The packs of a study in a folder of results.
pub fn packs(results: &Path, study: &str) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(results.join(study).join("records")) else { return Vec::new() };
    let mut packs: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    packs.sort();
    packs
}

/// Every line of the packs, as `zcat` shows them.
pub fn lines(results: &Path, study: &str) -> Vec<String> {
    let mut text = String::new();
    for pack in packs(results, study) {
        text += &unpacked(&fs::read(pack).expect("a pack"));
    }
    text.lines().map(str::to_owned).collect()
}

fn unpacked(members: &[u8]) -> String {
    let mut text = String::new();
    MultiGzDecoder::new(members).read_to_string(&mut text).expect("gzip");
    text
}

/// Every record of a study by the hash of its case, as JSON without its wall times.
pub fn records(results: &Path, study: &str) -> BTreeMap<String, String> {
    let store = RecordStore::new(results, study);
    let json = |record: &Record| serde_json::to_string(record).expect("JSON");
    let read = |hash: String| store.read(&hash).map(|record| (hash, json(&record)));
    store.hashes().into_iter().filter_map(read).collect()
}

/// Changes the records of a study as another program would have made and signed them; their numbers go along, in the order
/// of their hashes.
pub fn change_records(results: &Path, study: &str, change: impl Fn(usize, &mut Record)) {
    let store = RecordStore::new(results, study);
    for (number, hash) in store.hashes().iter().enumerate() {
        let mut record = store.read(hash).expect("a record");
        change(number, &mut record);
        store.write(&record).expect("written");
    }
}

/// The one pack of a study and its bytes.
pub fn only_pack(results: &Path, study: &str) -> (PathBuf, Vec<u8>) {
    let packs = packs(results, study);
    assert_eq!(packs.len(), 1, "{packs:?}");
    (packs[0].clone(), fs::read(&packs[0]).expect("a pack"))
}

/// Where the members of a pack lie.
pub fn members(pack: &[u8]) -> Vec<Range<usize>> {
    let mut members = Vec::new();
    let mut start = 0;
    while start < pack.len() {
        let length = pack[start..][LENGTH].try_into().map(u32::from_le_bytes).expect("four bytes");
        let end = start + usize::try_from(length).expect("short");
        members.push(start..end);
        start = end;
    }
    assert_eq!(start, pack.len(), "members up to the end");
    members
}

/// The member with another text of its record, whose seal stays, and with the case of its header where one is given.
pub fn tampered(member: &[u8], change: impl FnOnce(String) -> String, case: Option<&[u8]>) -> Vec<u8> {
    let text = unpacked(member);
    let changed = change(text.clone());
    assert!(changed != text || case.is_some(), "nothing is changed");
    let mut encoder = GzBuilder::new().extra(&member[12..HEADER]).write(Vec::new(), Compression::new(2));
    encoder.write_all(changed.as_bytes()).expect("memory");
    let mut member = encoder.finish().expect("memory");
    let length = u32::try_from(member.len()).expect("short");
    member[LENGTH].copy_from_slice(&length.to_le_bytes());
    if let Some(other) = case {
        member[CASE].copy_from_slice(&other[CASE]);
    }
    member
}
