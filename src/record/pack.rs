//! Packs: the records of a study, many to a file.
//!
//! A pack is a file of gzip members (RFC 1952), in sequence, one member per record with two lines of JSON:
//! the record, and its wall times. `zcat STUDY/records/*.jsonl.gz` shows them all. The extra field of a member's header
//! says which case it is of and how long it is, so that a reader goes from header to header and unpacks only what it is
//! asked for.
//!
//! Each writer appends to a pack of its own and takes up an older one only where it can lock it, on the machine that
//! began it. A member is written in one go behind the last one: a writer that ends at any moment leaves whole members
//! and at most one cut one at the end, which readers leave out and name.

use crate::record::atomic_file::{StoreError, is_whole, place_of_this_process, random_word};
use crate::record::provenance::Provenance;
use flate2::{Compression, GzBuilder};
use std::collections::HashMap;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Ending of a pack's name.
const ENDING: &str = ".jsonl.gz";
/// Folder of the packs within that of a study's results.
const FOLDER: &str = "records";
/// Constant bytes at the beginning of every member: magic and method of gzip, its flag of an extra field, no date, no
/// system, then the length of the extra field and the name and length of its one subfield.
const START: [u8; 16] = [0x1f, 0x8b, 8, 4, 0, 0, 0, 0, 0, 0xff, FIELD + 4, 0, b'O', b'e', FIELD, 0];
/// Letters of a header whose case is done, and of one that is worth another run.
const ENDS: [u8; 2] = [b'R', b'L'];
/// Length of what the subfield holds.
const FIELD: u8 = 33;
/// Length of a header.
pub(super) const HEADER: usize = START.len() + FIELD as usize;
/// Length of a checksum and of the length of the text, which follow the compressed text.
const TRAILER: usize = 8;
/// Effort of the compression, the least whose members begin with [`START`]: most of it makes a record a twentieth
/// smaller and takes longer than a small case.
const EFFORT: u32 = 2;
/// Longest text of a member, bytes; records are shorter.
const MOST_TEXT: u64 = 1 << 30;
/// Bytes that are searched at once for the next header behind damage.
const WINDOW: usize = 1 << 20;

/// What the header of a member says of its record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Hash of the case.
    pub case: u64,
    /// Whether the case is worth another run: it ran out of its time, or the program that solves it failed.
    pub is_late: bool,
    /// Tag of the program that made it.
    pub program: u64,
    /// Tag of the build of that program.
    pub build: u64,
    /// Count of the runs into the store: of two records of a case the one with the higher count is the newer.
    generation: u32,
    /// Length of the whole member, bytes.
    length: u32,
}

impl Entry {
    /// The entry of a record that is about to be appended.
    pub fn new(case: u64, is_late: bool, origin: &Provenance) -> Self {
        Self {
            case,
            is_late,
            program: origin.program_tag(),
            build: origin.build_tag(),
            generation: 0,
            length: 0,
        }
    }

    /// Whether the record may be taken up by a program: one of its version and sources, and not out of its time.
    pub fn is_taken_up_by(&self, program: &Provenance) -> bool {
        self.program == program.program_tag() && !self.is_late
    }

    /// Reads the header at the beginning of some bytes; `None` if no member begins there.
    fn read(bytes: &[u8]) -> Option<Self> {
        let field = bytes.get(..HEADER)?.strip_prefix(&START)?;
        let word = |at: usize| field[at..at + 8].try_into().ok().map(u64::from_le_bytes);
        let half = |at: usize| field[at..at + 4].try_into().ok().map(u32::from_le_bytes);
        let entry = Self {
            is_late: ENDS.iter().position(|letter| *letter == field[0])? == 1,
            generation: half(1)?,
            case: word(5)?,
            program: word(13)?,
            build: word(21)?,
            length: half(29)?,
        };
        (entry.length as usize >= HEADER + TRAILER).then_some(entry)
    }

    /// The header that [`Entry::read`] reads.
    fn header(&self) -> [u8; HEADER] {
        let mut header = [0; HEADER];
        let parts: [&[u8]; 7] = [
            &START,
            &[ENDS[usize::from(self.is_late)]],
            &self.generation.to_le_bytes(),
            &self.case.to_le_bytes(),
            &self.program.to_le_bytes(),
            &self.build.to_le_bytes(),
            &self.length.to_le_bytes(),
        ];
        header.copy_from_slice(&parts.concat());
        header
    }
}

/// The member of a text; its length is filled in.
fn packed(mut entry: Entry, text: &str) -> io::Result<Vec<u8>> {
    let extra = &entry.header()[START.len() - 4..];
    let mut encoder = GzBuilder::new().extra(extra).write(Vec::new(), Compression::new(EFFORT));
    encoder.write_all(text.as_bytes())?;
    let mut member = encoder.finish()?;
    entry.length = u32::try_from(member.len()).map_err(|_| io::ErrorKind::FileTooLarge)?;
    member[..HEADER].copy_from_slice(&entry.header());
    Ok(member)
}

/// The text of a member; `None` where it is damaged, or more or less than one member.
fn unpacked(member: &[u8]) -> Option<String> {
    let mut text = String::new();
    let mut decoder = flate2::bufread::GzDecoder::new(member);
    decoder.by_ref().take(MOST_TEXT).read_to_string(&mut text).ok()?;
    ((text.len() as u64) < MOST_TEXT && decoder.into_inner().is_empty()).then_some(text)
}

/// Bytes of a pack outside complete members.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// The pack.
    pub pack: PathBuf,
    /// First byte.
    pub from: u64,
    /// Byte behind the last.
    pub to: u64,
    /// Whether it is the end of the pack: a member whose writer did not come to its end.
    pub is_cut: bool,
}

impl fmt::Display for Damage {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pack, from, to, is_cut } = self;
        let (pack, bytes) = (pack.display(), to - from);
        if *is_cut {
            write!(out, "{pack} is cut at byte {from}: {bytes} bytes of a record that was not finished")
        } else {
            write!(out, "{pack} is damaged from byte {from} on: {bytes} bytes are not part of a record")
        }
    }
}

/// Where the member of a record lies, and what its header says.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Number of its pack.
    pack: usize,
    offset: u64,
    entry: Entry,
}

/// The newest record of each case in the packs of a folder, and what of them is damaged.
#[derive(Debug, Default)]
struct Index {
    /// Every pack with how far it was read.
    packs: Vec<(PathBuf, u64)>,
    records: HashMap<u64, Place>,
    damages: Vec<Damage>,
    /// Highest count of a run.
    newest: u32,
}

impl Index {
    /// Reads what was added to a folder since. A pack that cannot be read is left out: its cases run again.
    fn refresh(&mut self, folder: &Path) {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let is_pack = |path: &PathBuf| path.to_string_lossy().ends_with(ENDING);
        let mut paths: Vec<PathBuf> = entries.filter(is_pack).collect();
        paths.sort();
        for path in paths {
            let number = self.number_of(path);
            let _ = self.read_on(number);
        }
    }

    /// The number of a pack, which is known from now on.
    fn number_of(&mut self, path: PathBuf) -> usize {
        self.packs.iter().position(|(pack, _)| *pack == path).unwrap_or_else(|| {
            self.packs.push((path, 0));
            self.packs.len() - 1
        })
    }

    /// Reads the headers of what was added to a pack since it was read last.
    fn read_on(&mut self, number: usize) -> io::Result<()> {
        let (path, mut at) = self.packs[number].clone();
        self.damages.retain(|damage| !(damage.is_cut && damage.pack == path));
        let mut file = File::open(&path)?;
        let length = file.metadata()?.len();
        // The length of the last member may be what is damaged, and lead past the beginning of others.
        let mut last = None;
        while at < length {
            if let Some(entry) = header_at(&mut file, at, length)? {
                self.note(Place { pack: number, offset: at, entry });
                last = Some(at);
                at += u64::from(entry.length);
                continue;
            }
            let last = last.take().unwrap_or(at);
            let next = next_header(&mut file, last + 1, length, WINDOW)?;
            self.damages.push(Damage {
                pack: path.clone(),
                from: if next.is_some_and(|next| next < at) { last } else { at },
                to: next.unwrap_or(length),
                is_cut: next.is_none(),
            });
            let Some(next) = next else { break };
            at = next;
        }
        self.packs[number].1 = at;
        Ok(())
    }

    /// Takes note of a member; the newer of two of a case counts, and of two of one run the last.
    fn note(&mut self, place: Place) {
        let Entry { case, generation, length, .. } = place.entry;
        let known = self.records.entry(case).or_insert(place);
        if generation >= known.entry.generation {
            *known = place;
        }
        self.newest = self.newest.max(generation);
        let end = &mut self.packs[place.pack].1;
        *end = (*end).max(place.offset + u64::from(length));
    }

    /// The newest member of a case; `None` where it cannot be read.
    fn member(&self, case: u64) -> Option<Vec<u8>> {
        let place = self.records.get(&case)?;
        let mut file = File::open(&self.packs[place.pack].0).ok()?;
        file.seek(SeekFrom::Start(place.offset)).ok()?;
        let mut bytes = vec![0; place.entry.length as usize];
        file.read_exact(&mut bytes).ok()?;
        (Entry::read(&bytes)? == place.entry).then_some(bytes)
    }
}

/// The header at a byte of a file of a length; `None` if it is missing or its member would not fit.
fn header_at(file: &mut (impl Read + Seek), at: u64, length: u64) -> io::Result<Option<Entry>> {
    let mut bytes = [0; HEADER];
    if length - at < HEADER as u64 {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(&mut bytes)?;
    Ok(Entry::read(&bytes).filter(|entry| u64::from(entry.length) <= length - at))
}

/// The place of the next header from a byte on, searching `window` bytes at once.
fn next_header(
    file: &mut (impl Read + Seek),
    from: u64,
    length: u64,
    window: usize,
) -> io::Result<Option<u64>> {
    let mut at = from;
    while at + HEADER as u64 <= length {
        file.seek(SeekFrom::Start(at))?;
        let mut bytes = Vec::new();
        file.by_ref().take(window as u64).read_to_end(&mut bytes)?;
        for (offset, _) in bytes.windows(START.len()).enumerate().filter(|(_, bytes)| *bytes == START) {
            let place = at + offset as u64;
            if header_at(file, place, length)?.is_some() {
                return Ok(Some(place));
            }
        }
        // A header may begin at the end of what was searched.
        at += (window - START.len() + 1) as u64;
    }
    Ok(None)
}

/// A pack that is locked for this writer.
#[derive(Debug)]
struct Writer {
    file: File,
    /// Number of the pack.
    pack: usize,
    /// Byte behind the last whole member.
    end: u64,
    /// Count of this run.
    generation: u32,
}

impl Writer {
    /// Continues a pack that this machine began and no process is writing, or begins one.
    ///
    /// A lock is trusted between the processes of one machine only: network file systems know locks that other
    /// machines do not see.
    fn open(folder: &Path, index: &mut Index) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let prefix = format!("{}.", place_of_this_process());
        let is_own =
            |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&prefix));
        let free = index.packs.iter().filter(|(path, _)| is_own(path)).find_map(|(path, _)| {
            let file = File::options().write(true).open(path).ok()?;
            file.try_lock().ok().map(|()| (path.clone(), file))
        });
        let (path, mut file) = if let Some(pack) = free {
            pack
        } else {
            let path = folder.join(format!("{prefix}{}{ENDING}", random_word()));
            let file = File::create_new(&path)?;
            // Where the file system has no locks the random name alone keeps others away.
            let _ = file.try_lock();
            (path, file)
        };
        let pack = index.number_of(path);
        index.read_on(pack)?;
        let end = index.packs[pack].1;
        // What an earlier writer left half written goes: nothing may stand between two members.
        file.set_len(end)?;
        file.seek(SeekFrom::Start(end))?;
        Ok(Self { file, pack, end, generation: index.newest + 1 })
    }

    /// Appends a member; where it fails the pack is as it was before.
    fn append(&mut self, member: &[u8]) -> io::Result<Place> {
        let entry = Entry::read(member).ok_or(io::ErrorKind::InvalidData)?;
        if let Err(error) = self.file.write_all(member) {
            let _ = self.file.set_len(self.end);
            let _ = self.file.seek(SeekFrom::Start(self.end));
            return Err(error);
        }
        let place = Place { pack: self.pack, offset: self.end, entry };
        self.end += member.len() as u64;
        Ok(place)
    }
}

/// The packs of one study.
#[derive(Debug)]
pub struct Packs {
    folder: PathBuf,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    index: Index,
    /// Opened when something is first written.
    writer: Option<Writer>,
}

impl Packs {
    /// The packs below the folder of a study's results.
    pub fn new(study: &Path) -> Self {
        let folder = study.join(FOLDER);
        let mut index = Index::default();
        index.refresh(&folder);
        Self { folder, state: Mutex::new(State { index, writer: None }) }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes note of what others appended meanwhile.
    pub fn refresh(&self) {
        self.state().index.refresh(&self.folder);
    }

    /// What is known of every record without unpacking it, in no order.
    pub fn entries(&self) -> Vec<Entry> {
        self.state().index.records.values().map(|place| place.entry).collect()
    }

    /// What is known of the record of a case without unpacking it.
    pub fn entry(&self, case: u64) -> Option<Entry> {
        self.state().index.records.get(&case).map(|place| place.entry)
    }

    /// Damaged bytes of the packs, by pack and place, except at the ends of packs being written.
    pub fn damages(&self) -> Vec<Damage> {
        let mut damages = self.state().index.damages.clone();
        // A pack that is read on finds a cut end again, behind what other packs have.
        damages.sort_by(|damage, other| (&damage.pack, damage.from).cmp(&(&other.pack, other.from)));
        let is_written = |path: &Path| {
            File::open(path)
                .is_ok_and(|file| matches!(file.try_lock_shared(), Err(fs::TryLockError::WouldBlock)))
        };
        damages.retain(|damage| !(damage.is_cut && is_written(&damage.pack)));
        damages
    }

    /// Where the newest record of a case lies: its pack, its first byte and its length.
    #[cfg(test)]
    pub fn place(&self, case: u64) -> Option<(PathBuf, usize, usize)> {
        let state = self.state();
        let place = state.index.records.get(&case)?;
        let offset = usize::try_from(place.offset).ok()?;
        Some((state.index.packs[place.pack].0.clone(), offset, place.entry.length as usize))
    }

    /// Text of the record of a case, where it is whole, and that of its wall times.
    pub fn texts(&self, case: u64) -> Option<(String, String)> {
        let member = self.state().index.member(case)?;
        let text = unpacked(&member)?;
        let (record, wall) = text.split_once('\n')?;
        is_whole(record).then(|| (record.to_owned(), wall.trim_end().to_owned()))
    }

    /// Appends a record and its wall times, a line each.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn append(&self, entry: Entry, text: &str) -> Result<(), StoreError> {
        let entry = Entry { generation: self.generation()?, ..entry };
        let member = packed(entry, text).map_err(self.refused("pack a record for"))?;
        self.append_member(&member)
    }

    fn append_member(&self, member: &[u8]) -> Result<(), StoreError> {
        let mut state = self.state();
        let State { index, writer } = &mut *state;
        let Some(writer) = writer else { return Ok(()) };
        let place = writer.append(member).map_err(|source| StoreError::Io {
            action: "write",
            path: index.packs[writer.pack].0.clone(),
            source,
        })?;
        index.note(place);
        Ok(())
    }

    /// Count of this run; the first call opens the pack.
    fn generation(&self) -> Result<u32, StoreError> {
        let mut state = self.state();
        let State { index, writer } = &mut *state;
        if let Some(writer) = writer {
            return Ok(writer.generation);
        }
        let opened =
            Writer::open(&self.folder, index).map_err(self.refused("create the folder or a pack in"))?;
        Ok(writer.insert(opened).generation)
    }

    fn refused(&self, action: &'static str) -> impl Fn(io::Error) -> StoreError {
        let path = self.folder.clone();
        move |source| StoreError::Io { action, path: path.clone(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn entry(case: u64, generation: u32) -> Entry {
        Entry { case, is_late: false, program: 1 << 60, build: 5, generation, length: 0 }
    }

    fn member(case: u64, generation: u32, text: &str) -> Vec<u8> {
        packed(entry(case, generation), text).expect("packed")
    }

    #[test]
    fn a_member_is_read_back_and_any_damage_to_it_is_seen() {
        let text = "{\"hash\":\"0123456789abcdef\"}\n[1.5,2.25]\n".repeat(5);
        let member = member(0x0123_4567_89ab_cdef, 7, &text);
        let length = u32::try_from(member.len()).expect("short");
        assert_eq!(Entry::read(&member), Some(Entry { length, ..entry(0x0123_4567_89ab_cdef, 7) }));
        assert_eq!(unpacked(&member).as_deref(), Some(text.as_str()));
        let mut unseen = 0;
        for place in HEADER..member.len() {
            let mut damaged = member.clone();
            damaged[place] ^= 0x10;
            // The last byte of the packed text is filled up with bits that mean nothing.
            if let Some(read) = unpacked(&damaged) {
                assert_eq!(read, text, "byte {place}");
                unseen += 1;
            }
        }
        assert!(unseen <= 1, "{unseen} damages unseen");
        assert_eq!(unpacked(&[&member, b"x".as_slice()].concat()), None, "more than a member");
        assert_eq!(unpacked(&member[..member.len() - 1]), None);
        assert_eq!(Entry::read(&member[..HEADER - 1]), None);
    }

    #[test]
    fn a_member_is_what_other_programs_call_gzip() {
        let two = [member(1, 1, "one line\n"), member(2, 1, "one line\n")].concat();
        let mut text = String::new();
        flate2::read::MultiGzDecoder::new(two.as_slice()).read_to_string(&mut text).expect("gzip");
        assert_eq!(text, "one line\none line\n");
    }

    #[test]
    fn a_header_is_found_wherever_it_lies_in_the_windows_behind_damage() {
        let member = member(1, 1, "text");
        for window in [START.len(), HEADER, HEADER + 1, 80, 200] {
            for count in 0..3 * window {
                // Beginnings of headers at the edges of the windows must not mislead the scan.
                let bait = member.iter().take(1 + count % 20).chain(&[1, 2, 3]).copied().cycle();
                let bytes: Vec<u8> = bait.take(count).chain(member.iter().copied()).collect();
                let length = bytes.len() as u64;
                let found = next_header(&mut Cursor::new(bytes), 0, length, window).expect("in memory");
                assert_eq!(found, Some(count as u64), "{window} at once");
            }
        }
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

    fn read(folder: &Path) -> Index {
        let mut index = Index::default();
        index.refresh(folder);
        index
    }

    #[test]
    fn a_pack_that_is_cut_at_any_byte_keeps_every_whole_record_before_it() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let pack = folder.path().join(format!("somewhere{ENDING}"));
        let (bytes, ends) = pack_of(5);
        for cut in 0..=bytes.len() {
            fs::write(&pack, &bytes[..cut]).expect("a pack");
            let index = read(folder.path());
            let whole = ends.iter().filter(|end| **end <= cut).count() - 1;
            for case in 0..5_u8 {
                let text = index.member(case.into()).map(|member| unpacked(&member).expect("whole"));
                assert_eq!(text.is_some(), usize::from(case) < whole, "case {case} of a pack cut at {cut}");
                assert!(text.is_none_or(|text| text.starts_with(&format!("record {case} "))));
            }
            let is_between = ends.contains(&cut);
            assert_eq!(index.damages.len(), usize::from(!is_between), "cut at {cut}");
            if let Some(damage) = index.damages.first() {
                assert!(damage.is_cut && damage.from == ends[whole] as u64, "{damage}");
                let told = damage.to_string();
                assert!(told.contains(&format!("is cut at byte {}", ends[whole])), "{told}");
            }
        }
    }

    #[test]
    fn behind_damage_the_next_whole_record_is_found() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let pack = folder.path().join(format!("somewhere{ENDING}"));
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
            let index = read(folder.path());
            let whole = |case| index.member(case).is_some_and(|member| unpacked(&member).is_some());
            let found: Vec<bool> = (0..4).map(whole).collect();
            assert!(found[0] && !found[1] && found[3], "{found:?}");
        }
    }

    #[test]
    fn a_writer_goes_on_behind_the_last_whole_member_and_two_share_no_pack() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let mut index = Index::default();
        let mut one = Writer::open(folder.path(), &mut index).expect("a writer");
        one.append(&member(1, one.generation, "one")).expect("appended");
        let mut other_index = read(folder.path());
        let mut other = Writer::open(folder.path(), &mut other_index).expect("a writer");
        let path = index.packs[one.pack].0.clone();
        assert_ne!(path, other_index.packs[other.pack].0);
        other.append(&member(2, other.generation, "two")).expect("appended");
        // The first ends in the middle of a member.
        let half = member(3, 1, "three");
        one.file.write_all(&half[..half.len() / 2]).expect("written");
        drop(one);
        let mut index = read(folder.path());
        assert_eq!(index.damages.len(), 1, "{:?}", index.damages);
        let mut third = Writer::open(folder.path(), &mut index).expect("a writer");
        assert_eq!((&index.packs[third.pack].0, third.generation), (&path, 3));
        third.append(&member(1, third.generation, "newer")).expect("appended");
        let index = read(folder.path());
        assert!(index.damages.is_empty() && index.packs.len() == 2);
        let newest = index.member(1).expect("a record");
        assert_eq!(unpacked(&newest).as_deref(), Some("newer"));
    }
}
