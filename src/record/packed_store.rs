//! Records of large studies, in packs: found by the hash of their case, appended as they come.

use crate::record::csv::packed_table::{RowsOf, packed_rows};
use crate::record::csv::rows_at_hand::RowsAtHand;
use crate::record::csv::tidy;
use crate::record::pack::FOLDER;
use crate::record::pack::index::{Damage, Index, Place, WINDOW};
use crate::record::pack::member::{Header, Kind, packed, unpacked};
use crate::record::pack::writer::Writer;
use crate::record::provenance::Provenance;
use crate::record::seal::{Layout, is_whole, sealed};
use crate::record::whole_file::StoreError;
use crate::record::{Record, Status, WallSample};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The packs of one study.
#[derive(Debug)]
pub struct PackedStore {
    study: PathBuf,
    /// Bytes that are looked through at once behind damage.
    window: u64,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Read when it is first asked for.
    index: Option<Index>,
    /// Opened when something is first written.
    writer: Option<Writer>,
    /// Rows of the records that are written, where they are asked for.
    rows: Option<RowsAtHand>,
}

/// What the store knows of a record without unpacking it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Hash of the case.
    pub case: u64,
    /// How the case ended.
    pub end: CaseEnd,
    /// Tag of the program that made it.
    pub program: u64,
    /// Tag of the build of that program.
    pub build: u64,
    /// Bytes it takes.
    pub bytes: u32,
    /// Count of the run that left it.
    pub generation: u32,
}

/// How a case ended, as far as the store tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaseEnd {
    /// Every output reached.
    Ok,
    /// Failed, by a name in its record.
    Failed,
    /// Ran out of its time.
    Late,
}

impl From<&Header> for Entry {
    fn from(header: &Header) -> Self {
        let Header { case, program, build, length, kind, generation } = *header;
        let end = match kind {
            Kind::FailedRecord => CaseEnd::Failed,
            Kind::LateRecord => CaseEnd::Late,
            _ => CaseEnd::Ok,
        };
        Self { case, end, program, build, bytes: length, generation }
    }
}

impl PackedStore {
    /// The packs below the folder of a study's results.
    pub fn new(study: &Path) -> Self {
        Self::with_window(study, WINDOW)
    }

    /// The same, looking through so many bytes at once behind damage.
    pub fn with_window(study: &Path, window: u64) -> Self {
        Self { study: study.to_owned(), window, state: Mutex::default() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn refused(&self, action: &'static str) -> impl Fn(std::io::Error) -> StoreError {
        let path = self.study.join(FOLDER);
        move |source| StoreError::Io { action, path: path.clone(), source }
    }

    /// Asks the index, which is read where it was not yet. One that cannot be read is empty: its cases run again.
    fn with_index<T>(&self, ask: impl FnOnce(&mut Index) -> T) -> T {
        let mut state = self.state();
        let folder = self.study.join(FOLDER);
        ask(state.index.get_or_insert_with(|| Index::of(&folder, self.window).unwrap_or_default()))
    }

    /// Whether there is any record.
    pub fn has_records(&self) -> bool {
        self.with_index(|index| index.records().next().is_some())
    }

    /// Takes note of what others appended meanwhile.
    pub fn refresh(&self) {
        let folder = self.study.join(FOLDER);
        self.with_index(|index| index.refresh(&folder).unwrap_or_default());
    }

    /// Every record there is, in no order.
    pub fn entries(&self) -> Vec<Entry> {
        self.with_index(|index| index.records().map(|place| Entry::from(&place.header)).collect())
    }

    /// What is known of the record of a case.
    pub fn entry(&self, case: u64) -> Option<Entry> {
        self.with_index(|index| {
            let entry = Entry::from(&index.record(case)?.header);
            let generation = index.wall(case).map_or(entry.generation, |wall| wall.header.generation);
            Some(Entry { generation, ..entry })
        })
    }

    /// Takes over the record of a case from another store as it is, where that has a whole one.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn take_over(&self, other: &Self, case: u64) -> Result<bool, StoreError> {
        let Some(place) = other.with_index(|index| index.record(case)) else { return Ok(false) };
        if other.with_index(|index| index.wall(case)).is_some() || other.texts(case).is_none() {
            return Ok(false);
        }
        let Ok(mut member) = other.with_index(|index| index.bytes(place)) else { return Ok(false) };
        Header { generation: self.generation()?, ..place.header }.put_on(&mut member);
        self.append_member(&member)?;
        Ok(true)
    }

    /// What of the packs is no record, by pack and place, but for the ends of those that somebody is writing.
    pub fn damages(&self) -> Vec<Damage> {
        let mut damages = self.with_index(|index| index.damages().to_vec());
        // A pack that is read on finds a cut end again, behind what other packs have.
        damages.sort_by(|one, other| (&one.pack, one.from).cmp(&(&other.pack, other.from)));
        let is_written = |path: &Path| {
            File::open(path)
                .is_ok_and(|file| matches!(file.try_lock_shared(), Err(std::fs::TryLockError::WouldBlock)))
        };
        damages.into_iter().filter(|damage| !(damage.is_cut && is_written(&damage.pack))).collect()
    }

    /// Every pack with the bytes of it that are whole.
    pub fn packs(&self) -> Vec<(PathBuf, u64)> {
        self.with_index(|index| index.packs().map(|(path, end)| (path.to_owned(), end)).collect())
    }

    /// Where the newest record of a case, or its newest wall times, lie.
    #[cfg(test)]
    pub fn place(&self, case: u64, of_wall: bool) -> Option<(PathBuf, Place)> {
        self.with_index(|index| {
            let place = if of_wall { index.wall(case) } else { index.record(case) }?;
            Some((index.packs().nth(place.pack as usize)?.0.to_owned(), place))
        })
    }

    fn unpacked(&self, place: Place) -> Option<String> {
        let bytes = self.with_index(|index| index.bytes(place)).ok()?;
        (Header::read(&bytes)? == place.header).then(|| unpacked(&bytes)).flatten()
    }

    /// Text of the record of a case, where it is whole, and that of its wall times.
    fn texts(&self, case: u64) -> Option<(String, String)> {
        let place = self.with_index(|index| index.record(case))?;
        let text = self.unpacked(place)?;
        let (record, wall) = text.split_once('\n')?;
        is_whole(record).then(|| (record.to_owned(), wall.trim_end().to_owned()))
    }

    /// Text of the record of a case, where it is whole.
    pub fn text(&self, case: u64) -> Option<String> {
        self.texts(case).map(|(record, _)| record)
    }

    /// Text of the record of a case and its wall times.
    pub fn text_and_wall(&self, case: u64) -> Option<(String, Vec<WallSample>)> {
        let (record, of_record) = self.texts(case)?;
        let later = self.with_index(|index| index.wall(case)).and_then(|place| self.unpacked(place));
        let wall = later.as_deref().and_then(wall_of).or_else(|| wall_of(&of_record));
        Some((record, wall.unwrap_or_default()))
    }

    /// Appends a record that carries no digest.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, record: &Record) -> Result<(), StoreError> {
        let kind = match record.status {
            Status::Ok => Kind::Record,
            Status::Failed(_) if record.status.is_worth_another_run() => Kind::LateRecord,
            Status::Failed(_) => Kind::FailedRecord,
        };
        let mut text = sealed(record, Layout::OneLine).map_err(|source| self.json(source))?;
        text.push('\n');
        text.push_str(&self.wall_line(record)?);
        text.push('\n');
        let place = match self.append(kind, record, &text) {
            // A full disk is the records': rows can be made again.
            Err(_) if self.take_rows_at_hand().is_some() => self.append(kind, record, &text)?,
            appended => appended?,
        };
        if let Some(place) = place {
            self.keep_rows(record, Entry::from(&place.header).rows());
        }
        Ok(())
    }

    /// Makes rows of every record that is written from now on, for the table that is written at the end.
    pub fn keep_rows_at_hand(&self) {
        // Without them they are made of the records once more.
        self.state().rows = RowsAtHand::in_folder(&self.study).ok();
    }

    /// The rows that were kept.
    pub fn take_rows_at_hand(&self) -> Option<RowsAtHand> {
        self.state().rows.take()
    }

    fn keep_rows(&self, record: &Record, of: RowsOf) {
        if self.state().rows.is_none() {
            return;
        }
        let study = self.study.file_name().unwrap_or_default().to_string_lossy();
        let rows = packed_rows(of, &tidy::rows_of(&study, record));
        let rows_at_hand = &mut self.state().rows;
        if let (Some(at_hand), Ok(rows)) = (&mut *rows_at_hand, rows)
            && at_hand.keep(of, &rows).is_err()
        {
            *rows_at_hand = None;
        }
    }

    /// Appends the wall times of a record alone.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write_wall(&self, record: &Record) -> Result<(), StoreError> {
        self.append(Kind::Wall, record, &format!("{}\n", self.wall_line(record)?)).map(|_| ())
    }

    fn json(&self, source: serde_json::Error) -> StoreError {
        StoreError::Json { path: self.study.join(FOLDER), source }
    }

    fn wall_line(&self, record: &Record) -> Result<String, StoreError> {
        #[derive(serde::Serialize)]
        struct Line<'a> {
            hash: &'a str,
            wall: &'a [WallSample],
        }
        let line = Line { hash: &record.hash, wall: &record.wall };
        serde_json::to_string(&line).map_err(|source| self.json(source))
    }

    fn append(&self, kind: Kind, record: &Record, text: &str) -> Result<Option<Place>, StoreError> {
        let generation = self.generation()?;
        let header = Header {
            kind,
            generation,
            case: number_of(&record.hash),
            program: record.provenance.program_tag(),
            build: record.provenance.build_tag(),
            length: 0,
        };
        self.append_member(&packed(header, text.as_bytes()).map_err(self.refused("pack a record for"))?)
    }

    fn append_member(&self, member: &[u8]) -> Result<Option<Place>, StoreError> {
        let mut state = self.state();
        let State { index: Some(index), writer: Some(writer), .. } = &mut *state else { return Ok(None) };
        let place = writer.append(member).map_err(|source| StoreError::Io {
            action: "write",
            path: writer.path().to_owned(),
            source,
        })?;
        index.note(place);
        Ok(Some(place))
    }

    /// Count of this run; the first who asks opens the pack.
    fn generation(&self) -> Result<u32, StoreError> {
        let folder = self.study.join(FOLDER);
        let mut state = self.state();
        let State { index, writer, .. } = &mut *state;
        if let Some(writer) = writer {
            return Ok(writer.generation());
        }
        let index = index.get_or_insert_with(|| Index::of(&folder, self.window).unwrap_or_default());
        let opened =
            Writer::open(&self.study, index).map_err(self.refused("make the folder or a pack in"))?;
        Ok(writer.insert(opened).generation())
    }
}

/// The number that the hash of a case is.
pub fn number_of(hash: &str) -> u64 {
    u64::from_str_radix(hash, 16).unwrap_or(0)
}

fn wall_of(line: &str) -> Option<Vec<WallSample>> {
    #[derive(serde::Deserialize)]
    struct Line {
        wall: Vec<WallSample>,
    }
    serde_json::from_str::<Line>(line.trim_end()).ok().map(|line| line.wall)
}

impl Entry {
    /// What rows of the table are made of it.
    pub fn rows(&self) -> RowsOf {
        let Self { case, generation, program, build, .. } = *self;
        RowsOf { case, generation, program, build }
    }

    /// Whether the record is to be taken up by a program: of its version and sources, and not out of its time.
    pub fn is_taken_up_by(&self, program: &Provenance) -> bool {
        self.program == program.program_tag() && self.end != CaseEnd::Late
    }
}
