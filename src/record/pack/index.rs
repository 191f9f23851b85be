//! What is in the packs of a folder: where the newest member of each case lies, and what is damaged.

use crate::record::pack::ENDING;
use crate::record::pack::member::{HEADER, Header, Kind, next_start};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Bytes that are looked through at once for the next header behind damage.
pub const WINDOW: u64 = 1 << 20;

/// Where a member lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of its pack.
    pub pack: u32,
    /// First byte in it.
    pub offset: u64,
    /// What it says of itself.
    pub header: Header,
}

/// The same as it is kept of a million: what wrote them is a few.
#[derive(Clone, Copy, Debug)]
struct Kept {
    offset: u64,
    length: u32,
    /// Its place among the sources.
    source: u32,
}

/// What the members that one run of a program wrote to one pack have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Source {
    pack: u32,
    generation: u32,
    program: u64,
    build: u64,
    kind: Kind,
}

/// Bytes of a pack that are no whole member.
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
        let (pack, bytes) = (self.pack.display(), self.to - self.from);
        if self.is_cut {
            write!(
                out,
                "{pack} is cut at byte {}: {bytes} bytes of a record that was not finished",
                self.from
            )
        } else {
            write!(out, "{pack} is damaged from byte {} on: {bytes} bytes are no record", self.from)
        }
    }
}

/// The members of the packs of a folder.
#[derive(Debug)]
pub struct Index {
    /// Bytes that are looked through at once for the next header behind damage: more than a header has.
    window: u64,
    packs: Vec<PathBuf>,
    /// How far each pack was read.
    ends: Vec<u64>,
    records: HashMap<u64, Kept>,
    walls: HashMap<u64, Kept>,
    /// Each once.
    sources: Vec<Source>,
    numbers: HashMap<Source, u32>,
    columns: Option<Place>,
    damages: Vec<Damage>,
    newest: u32,
}

/// Reads members, each pack opened once.
pub struct Reader<'a> {
    index: &'a Index,
    files: HashMap<u32, File>,
}

impl Reader<'_> {
    /// The bytes of a member.
    ///
    /// # Errors
    /// When the pack cannot be read.
    pub fn bytes(&mut self, place: Place) -> io::Result<Vec<u8>> {
        let file = match self.files.entry(place.pack) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert(File::open(&self.index.packs[place.pack as usize])?),
        };
        read_at(file, place)
    }
}

fn read_at(file: &mut File, place: Place) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(place.offset))?;
    let mut bytes = vec![0; place.header.length as usize];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

impl Default for Index {
    fn default() -> Self {
        Self::looking(WINDOW)
    }
}

impl Index {
    /// An index without packs, which looks through so many bytes at once behind damage.
    pub fn looking(window: u64) -> Self {
        Self {
            window: window.max(HEADER as u64 + 1),
            packs: Vec::new(),
            ends: Vec::new(),
            records: HashMap::new(),
            walls: HashMap::new(),
            sources: Vec::new(),
            numbers: HashMap::new(),
            columns: None,
            damages: Vec::new(),
            newest: 0,
        }
    }

    /// Reads the headers of every pack in a folder; empty where the folder has none. Looks through `window` bytes at
    /// once behind damage.
    ///
    /// # Errors
    /// When a pack cannot be read.
    pub fn of(folder: &Path, window: u64) -> io::Result<Self> {
        let mut index = Self::looking(window);
        for path in packs_in(folder) {
            let number = index.add_pack(path);
            index.read_on(number)?;
        }
        Ok(index)
    }

    /// Reads the headers of one file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        let mut index = Self::default();
        let number = index.add_pack(path.to_owned());
        index.read_on(number)?;
        Ok(index)
    }

    /// Knows a pack from now on, whose members are still to be read or noted; its number.
    pub fn add_pack(&mut self, path: PathBuf) -> u32 {
        if let Some(known) = self.packs.iter().position(|pack| *pack == path) {
            return u32::try_from(known).unwrap_or(u32::MAX);
        }
        self.packs.push(path);
        self.ends.push(0);
        u32::try_from(self.packs.len() - 1).unwrap_or(u32::MAX)
    }

    /// Reads what was added to a pack since it was read last.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read_on(&mut self, number: u32) -> io::Result<()> {
        let path = self.packs[number as usize].clone();
        self.damages.retain(|damage| !(damage.is_cut && damage.pack == path));
        let mut file = File::open(&path)?;
        let length = file.metadata()?.len();
        let mut at = self.ends[number as usize];
        let mut bytes = [0; HEADER];
        // The length of the last member may be what is damaged, and lead past the beginning of others.
        let mut last = None;
        while at < length {
            file.seek(SeekFrom::Start(at))?;
            let header = if length - at >= HEADER as u64 {
                file.read_exact(&mut bytes)?;
                Header::read(&bytes)
            } else {
                None
            };
            if let Some(header) = header.filter(|header| u64::from(header.length) <= length - at) {
                self.note(Place { pack: number, offset: at, header });
                last = Some(at);
                at += u64::from(header.length);
                continue;
            }
            let last = last.take().unwrap_or(at);
            let next = next_header(&mut file, last + 1, length, self.window)?;
            self.damages.push(Damage {
                pack: path.clone(),
                from: if next.is_some_and(|next| next < at) { last } else { at },
                to: next.unwrap_or(length),
                is_cut: next.is_none(),
            });
            let Some(next) = next else { break };
            at = next;
        }
        self.ends[number as usize] = at;
        Ok(())
    }

    /// Reads what was added to the folder since.
    ///
    /// # Errors
    /// When a pack cannot be read.
    pub fn refresh(&mut self, folder: &Path) -> io::Result<()> {
        for path in packs_in(folder) {
            let number = self.add_pack(path);
            self.read_on(number)?;
        }
        Ok(())
    }

    /// Takes note of a member; the newer of two of a case counts, and of two of one run the last.
    pub fn note(&mut self, place: Place) {
        let kept = self.kept(&place);
        let of_kind = match place.header.kind {
            Kind::Columns => return self.columns = Some(place),
            Kind::Wall => &mut self.walls,
            _ => &mut self.records,
        };
        let known = of_kind.entry(place.header.case).or_insert(kept);
        if place.header.generation >= self.sources[known.source as usize].generation {
            *known = kept;
        }
        self.newest = self.newest.max(place.header.generation);
        if let Some(end) = self.ends.get_mut(place.pack as usize) {
            *end = (*end).max(place.offset + u64::from(place.header.length));
        }
    }

    fn kept(&mut self, place: &Place) -> Kept {
        let Header { kind, generation, program, build, length, .. } = place.header;
        let (sources, source) =
            (&mut self.sources, Source { pack: place.pack, generation, program, build, kind });
        let source = *self.numbers.entry(source).or_insert_with(|| {
            sources.push(source);
            u32::try_from(sources.len() - 1).unwrap_or(u32::MAX)
        });
        Kept { offset: place.offset, length, source }
    }

    fn place(&self, case: u64, kept: Kept) -> Place {
        let Kept { offset, length, source } = kept;
        let Source { pack, generation, program, build, kind } = self.sources[source as usize];
        Place { pack, offset, header: Header { kind, generation, case, program, build, length } }
    }

    /// The newest record of a case.
    pub fn record(&self, case: u64) -> Option<Place> {
        self.records.get(&case).map(|kept| self.place(case, *kept))
    }

    /// The wall times of a case that were written alone, where they are newer than its record.
    pub fn wall(&self, case: u64) -> Option<Place> {
        let (wall, record) =
            (self.place(case, *self.walls.get(&case)?), self.place(case, *self.records.get(&case)?));
        // Of one run and one pack the place tells which came later.
        let is_later = match wall.header.generation.cmp(&record.header.generation) {
            Ordering::Less => false,
            Ordering::Equal => wall.pack != record.pack || wall.offset > record.offset,
            Ordering::Greater => true,
        };
        is_later.then_some(wall)
    }

    /// Every case with a record.
    pub fn records(&self) -> impl Iterator<Item = Place> {
        self.records.iter().map(|(case, kept)| self.place(*case, *kept))
    }

    /// How far a pack holds whole members.
    pub fn end(&self, number: u32) -> u64 {
        self.ends[number as usize]
    }

    /// Every pack with how far it was read.
    pub fn packs(&self) -> impl Iterator<Item = (&Path, u64)> {
        self.packs.iter().map(PathBuf::as_path).zip(self.ends.iter().copied())
    }

    /// What is no member.
    pub fn damages(&self) -> &[Damage] {
        &self.damages
    }

    /// Count of the newest run.
    pub fn newest(&self) -> u32 {
        self.newest
    }

    /// The bytes of a member.
    ///
    /// # Errors
    /// When the pack cannot be read.
    pub fn bytes(&self, place: Place) -> io::Result<Vec<u8>> {
        self.reader().bytes(place)
    }

    /// A reader of many members.
    pub fn reader(&self) -> Reader<'_> {
        Reader { index: self, files: HashMap::new() }
    }

    /// The columns, where it is a table.
    pub fn columns(&self) -> Option<Place> {
        self.columns
    }
}

/// The packs of a folder by name.
fn packs_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_pack = |path: &PathBuf| path.to_string_lossy().ends_with(ENDING);
    let mut packs: Vec<PathBuf> = entries.filter(is_pack).collect();
    packs.sort();
    packs
}

/// The place of the next header from a byte on.
fn next_header(file: &mut File, from: u64, length: u64, window: u64) -> io::Result<Option<u64>> {
    let mut at = from;
    while at + HEADER as u64 <= length {
        file.seek(SeekFrom::Start(at))?;
        let mut bytes = Vec::new();
        BufReader::new(&mut *file).take(window).read_to_end(&mut bytes)?;
        let mut inner = 0;
        while let Some(next) = next_start(&bytes[inner..]) {
            let place = at + (inner + next) as u64;
            let header = bytes.get(inner + next..).and_then(Header::read);
            if header.is_some_and(|header| place + u64::from(header.length) <= length) {
                return Ok(Some(place));
            }
            inner += next + 1;
        }
        // A header may lie across the end of what was looked through.
        at += (window - HEADER as u64).min(length);
    }
    Ok(None)
}
