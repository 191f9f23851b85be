//! Appends members to a pack that nobody else writes.

use crate::record::pack::index::{Index, Place};
use crate::record::pack::member::Header;
use crate::record::pack::{ENDING, FOLDER};
use crate::record::whole_file::{place_of_this_process, random_word};
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A pack that is locked for this writer.
#[derive(Debug)]
pub struct Writer {
    file: File,
    path: PathBuf,
    number: u32,
    /// Byte behind the last whole member.
    end: u64,
    generation: u32,
}

impl Writer {
    /// Takes up a pack that this machine began and nobody writes, or begins one.
    ///
    /// A lock is trusted between the processes of one machine only: network file systems know locks that other
    /// machines do not see.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn open(study: &Path, index: &mut Index) -> io::Result<Self> {
        let folder = study.join(FOLDER);
        fs::create_dir_all(&folder)?;
        let own = format!("{}.", place_of_this_process());
        let is_own =
            |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&own));
        let known: Vec<PathBuf> = index.packs().map(|(path, _)| path.to_owned()).collect();
        let free = known.into_iter().filter(|path| is_own(path)).find_map(|path| {
            let file = File::options().write(true).open(&path).ok()?;
            file.try_lock().ok().map(|()| (path, file))
        });
        let (path, mut file) = if let Some(found) = free {
            found
        } else {
            let path = folder.join(format!("{own}{}{ENDING}", random_word()));
            let file = File::create_new(&path)?;
            // Where the file system has no locks the random name alone keeps others away.
            let _ = file.try_lock();
            (path, file)
        };
        let number = index.add_pack(path.clone());
        index.read_on(number)?;
        let end = index.end(number);
        // What an earlier writer left half written goes: nothing may stand between two members.
        file.set_len(end)?;
        file.seek(SeekFrom::Start(end))?;
        Ok(Self { file, path, number, end, generation: index.newest() + 1 })
    }

    /// The pack.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Count of this run, for the headers of its members.
    pub fn generation(&self) -> u32 {
        self.generation
    }

    /// Appends a member; where it lies then.
    ///
    /// # Errors
    /// When the file system refuses; the pack is as it was before.
    pub fn append(&mut self, member: &[u8]) -> io::Result<Place> {
        let header = Header::read(member).ok_or(io::ErrorKind::InvalidData)?;
        if let Err(error) = self.file.write_all(member) {
            let _ = self.file.set_len(self.end);
            let _ = self.file.seek(SeekFrom::Start(self.end));
            return Err(error);
        }
        let place = Place { pack: self.number, offset: self.end, header };
        self.end += member.len() as u64;
        Ok(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::pack::member::{Kind, packed, unpacked};

    fn member(case: u64, generation: u32, text: &str) -> Vec<u8> {
        let header = Header { kind: Kind::Record, generation, case, program: 1, build: 2, length: 0 };
        packed(header, text.as_bytes()).expect("packed")
    }

    /// A pack of some members, as bytes, with the places where they end.
    fn pack_of(count: u8) -> (Vec<u8>, Vec<usize>) {
        let (mut bytes, mut ends) = (Vec::new(), vec![0]);
        for case in 0..count {
            let words = "0.125 ".repeat(10 * usize::from(case));
            bytes.extend(member(case.into(), 1, &format!("record {case} {words}")));
            ends.push(bytes.len());
        }
        (bytes, ends)
    }

    fn read(study: &Path) -> Index {
        Index::of(&study.join(FOLDER), crate::record::pack::index::WINDOW).expect("an index")
    }

    #[test]
    fn a_pack_that_is_cut_at_any_byte_keeps_every_whole_record_before_it() {
        let study = tempfile::TempDir::new().expect("a folder");
        let folder = study.path().join(FOLDER);
        fs::create_dir(&folder).expect("a folder");
        let pack = folder.join(format!("somewhere{ENDING}"));
        let (bytes, ends) = pack_of(5);
        for cut in 0..=bytes.len() {
            fs::write(&pack, &bytes[..cut]).expect("a pack");
            let index = read(study.path());
            let whole = ends.iter().filter(|end| **end <= cut).count() - 1;
            for case in 0..5_u8 {
                let place = index.record(case.into());
                assert_eq!(place.is_some(), usize::from(case) < whole, "case {case} of a pack cut at {cut}");
                let text = place.map(|place| unpacked(&index.bytes(place).expect("bytes")).expect("whole"));
                assert!(text.is_none_or(|text| text.starts_with(&format!("record {case} "))));
            }
            let is_between = ends.contains(&cut);
            assert_eq!(index.damages().len(), usize::from(!is_between), "cut at {cut}");
            if let Some(damage) = index.damages().first() {
                assert!(damage.is_cut && damage.from == ends[whole] as u64, "{damage}");
                let told = damage.to_string();
                assert!(told.contains(&format!("is cut at byte {}", ends[whole])), "{told}");
            }
        }
    }

    #[test]
    fn behind_damage_the_next_whole_record_is_found() {
        let study = tempfile::TempDir::new().expect("a folder");
        fs::create_dir(study.path().join(FOLDER)).expect("a folder");
        let pack = study.path().join(FOLDER).join(format!("somewhere{ENDING}"));
        let (bytes, ends) = pack_of(4);
        // The length of the second member, its magic, and a piece cut out of its middle.
        let flipped = |at: usize| {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x40;
            damaged
        };
        let missing = [&bytes[..ends[1] + 60], &bytes[ends[1] + 70..]].concat();
        for damaged in [flipped(ends[1] + 46), flipped(ends[1] + 48), flipped(ends[1]), missing] {
            fs::write(&pack, &damaged).expect("a pack");
            let index = read(study.path());
            let whole = |case| {
                let bytes = index.record(case).and_then(|place| index.bytes(place).ok());
                bytes.and_then(|bytes| unpacked(&bytes)).is_some()
            };
            let found: Vec<bool> = (0..4).map(whole).collect();
            assert!(found[0] && !found[1] && found[3], "{found:?}");
        }
    }

    #[test]
    fn a_writer_goes_on_behind_the_last_whole_member_and_two_share_no_pack() {
        let study = tempfile::TempDir::new().expect("a folder");
        let mut index = Index::default();
        let mut one = Writer::open(study.path(), &mut index).expect("a writer");
        one.append(&member(1, one.generation(), "one")).expect("appended");
        let mut other_index = read(study.path());
        let mut other = Writer::open(study.path(), &mut other_index).expect("a writer");
        assert_ne!(one.path(), other.path());
        other.append(&member(2, other.generation(), "two")).expect("appended");
        // The first ends in the middle of a member.
        let path = one.path().to_owned();
        let half = member(3, 1, "three");
        one.file.write_all(&half[..half.len() / 2]).expect("written");
        drop(one);
        let mut index = read(study.path());
        assert_eq!(index.damages().len(), 1, "{:?}", index.damages());
        let mut third = Writer::open(study.path(), &mut index).expect("a writer");
        assert_eq!((third.path(), third.generation()), (path.as_path(), 3));
        third.append(&member(1, third.generation(), "newer")).expect("appended");
        let index = read(study.path());
        assert!(index.damages().is_empty() && index.packs().count() == 2);
        let newest = index.record(1).expect("a record");
        assert_eq!(unpacked(&index.bytes(newest).expect("bytes")).as_deref(), Some("newer"));
    }
}
