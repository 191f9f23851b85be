//! Compares stores with a list in memory: random sequences of everything that happens to one, with a fixed seed.

use super::*;
use crate::case::Task;
use crate::case::outcome::Outcome;
use crate::measure::record::record_of;
use crate::record::pack::{Damage, HEADER};
use crate::record::{AttachedRun, Status};
use oedometer_problem::outcome::{Failure, FailureKind};
use oedometer_scenes::TERZAGHI;
use std::collections::BTreeMap;
use std::fs;

/// Cases of a bed.
const CASES: usize = 6;

/// Numbers that are the same everywhere: a linear congruence and its upper half.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CaseEnd {
    Ok,
    Failed,
    Late,
}

/// What became of what was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// It is as it was.
    Whole,
    /// Its header is there, its text is not.
    Broken,
    /// Its header is not there either.
    Gone,
}

/// What was written, in the order of time.
#[derive(Clone, Debug)]
struct Written {
    /// The record's content.
    tag: usize,
    end: CaseEnd,
    wall: Vec<f64>,
    state: State,
}

/// What a store must give of a case.
#[derive(Clone, Debug, PartialEq)]
struct Content {
    tag: usize,
    wall: Vec<f64>,
    end: CaseEnd,
}

/// The newest record counts; a broken one is not replaced by something older.
fn expected(written: &[Written]) -> Option<Content> {
    let record = written.iter().rfind(|one| one.state != State::Gone)?;
    let Written { tag, end, ref wall, state } = *record;
    (state == State::Whole).then(|| Content { tag, wall: wall.clone(), end })
}

/// A folder with two writers, each of which has every other case, and what was written.
struct Bed {
    folder: tempfile::TempDir,
    cases: Vec<Case>,
    writers: Vec<RecordStore>,
    swapped: usize,
    model: BTreeMap<usize, Vec<Written>>,
    tags: usize,
    dice: Dice,
}

fn case(number: usize) -> Case {
    Case { cells: number + 2, time_factors: vec![0.1].into(), ..Case::seed(Task::Solve, &TERZAGHI) }
}

fn record(case: &Case, tag: usize, wall: &[f64], end: CaseEnd) -> Record {
    let failed = |kind| Status::Failed(Failure::of_attached(kind, format!("for {tag}")));
    let status = match end {
        CaseEnd::Ok => Status::Ok,
        CaseEnd::Failed => failed(FailureKind::Unstable),
        CaseEnd::Late => failed(FailureKind::TimedOut),
    };
    // Texts of unlike lengths, so that members are too.
    let about = AttachedRun {
        version: Some(tag.to_string()),
        notes: vec!["x".repeat(tag * 37 % 300)],
        ..AttachedRun::default()
    };
    let record = record_of(case, &[], Outcome::of_end(status).made_by(about)).expect("a record");
    let wall =
        wall.iter().map(|seconds| WallSample { seconds: *seconds, alone: true, ..WallSample::default() });
    Record { wall: wall.collect(), ..record }
}

fn content(record: &Record) -> Content {
    let tag = record.outside_run().and_then(|about| about.version.as_ref()?.parse().ok()).expect("a tag");
    let end = match &record.status {
        Status::Ok => CaseEnd::Ok,
        status if status.is_worth_another_run() => CaseEnd::Late,
        Status::Failed(_) => CaseEnd::Failed,
    };
    Content { tag, wall: record.wall.iter().map(|sample| sample.seconds).collect(), end }
}

impl Bed {
    fn new(seed: u64) -> Self {
        let folder = tempfile::TempDir::new().expect("a folder");
        let cases = (0..CASES).map(case).collect();
        let mut bed = Self {
            folder,
            cases,
            writers: Vec::new(),
            swapped: 0,
            model: BTreeMap::new(),
            tags: 0,
            dice: Dice(seed),
        };
        bed.reopen();
        bed
    }

    fn open(&self) -> RecordStore {
        RecordStore::new(self.folder.path(), "s")
    }

    fn reopen(&mut self) {
        self.writers.clear();
        self.writers = vec![self.open(), self.open()];
        self.swapped += 1;
    }

    fn writer_of(&self, case: usize) -> &RecordStore {
        &self.writers[(case + self.swapped) % 2]
    }

    fn wall(&mut self) -> Vec<f64> {
        // A repeated time counts twice.
        (0..self.dice.below(4)).map(|_| 0.25 * (1 + self.dice.below(2)) as f64).collect()
    }

    fn write(&mut self, case: usize) {
        self.tags += 1;
        let end = [CaseEnd::Ok, CaseEnd::Ok, CaseEnd::Failed, CaseEnd::Late][self.dice.below(4)];
        let (tag, wall) = (self.tags, self.wall());
        self.writer_of(case).write(&record(&self.cases[case], tag, &wall, end)).expect("written");
        let written = Written { tag, end, wall, state: State::Whole };
        self.model.entry(case).or_default().push(written);
    }

    /// What timing does: the times that are known, and more.
    fn time(&mut self, case: usize) {
        let Some(Content { tag, wall, end }) = self.of(case) else { return };
        let wall = [wall, self.wall()].concat();
        self.writer_of(case).write(&record(&self.cases[case], tag, &wall, end)).expect("written");
        self.model.entry(case).or_default().push(Written { tag, end, wall, state: State::Whole });
    }

    fn of(&self, case: usize) -> Option<Content> {
        expected(self.model.get(&case).map_or(&[], Vec::as_slice))
    }

    /// Takes a record over from elsewhere, as a merge does.
    fn take_over(&mut self, case: usize) {
        let elsewhere = tempfile::TempDir::new().expect("a folder");
        let other = RecordStore::new(elsewhere.path(), "s");
        self.tags += 1;
        let (tag, wall) = (self.tags, self.wall());
        other.write(&record(&self.cases[case], tag, &wall, CaseEnd::Ok)).expect("written");
        let record = other.kept(&self.cases[case]).expect("a record");
        self.writer_of(case).write(&record).expect("taken over");
        let written = Written { tag, end: CaseEnd::Ok, wall, state: State::Whole };
        self.model.entry(case).or_default().push(written);
    }

    /// The newest record of a case, where it is whole: its place in the list, its pack, its first byte and its length.
    fn newest(&self, case: usize) -> Option<(usize, PathBuf, usize, usize)> {
        let written = self.model.get(&case)?;
        let at = written.iter().rposition(|one| one.state != State::Gone)?;
        let (path, offset, length) = self.open().packs.place(self.cases[case].number())?;
        (written[at].state == State::Whole).then_some((at, path, offset, length))
    }

    /// Damages the newest record of a case, and says whose fault it must be.
    fn damage(&mut self, case: usize) {
        let Some((at, path, offset, length)) = self.newest(case) else { return };
        self.writers.clear();
        let mut bytes = fs::read(&path).expect("a pack");
        let is_told;
        let state = match self.dice.below(5) {
            0 => {
                bytes[offset + HEADER + self.dice.below((length - HEADER).min(20))] ^= 0xff;
                is_told = false;
                State::Broken
            }
            1 => {
                bytes[offset + self.dice.below(16)] ^= 0x10;
                is_told = true;
                State::Gone
            }
            2 => {
                // A length that leads into the middle of the member, or behind the end of any pack.
                bytes[offset + 45 + self.dice.below(2)] ^= 0x04;
                is_told = true;
                let wrong = bytes[offset + 45..offset + 49].try_into().map_or(u32::MAX, u32::from_le_bytes);
                if (wrong as usize) < length {
                    State::Broken
                } else {
                    bytes[offset + 48] = 0x7f;
                    State::Gone
                }
            }
            3 if offset + length == bytes.len() => {
                bytes.truncate(offset + 1 + self.dice.below(length - 1));
                is_told = true;
                State::Gone
            }
            _ => {
                // Stray bytes before it, with beginnings of headers.
                let most = 1 << self.dice.below(13);
                let count = self.dice.below(most);
                let bait = &bytes[offset..offset + 1 + self.dice.below(20)];
                let garbage: Vec<u8> =
                    bait.iter().chain(&[1, 2, 3]).copied().cycle().take(1 + count).collect();
                bytes.splice(offset..offset, garbage);
                is_told = true;
                State::Whole
            }
        };
        fs::write(&path, bytes).expect("a pack");
        self.model.get_mut(&case).expect("written")[at].state = state;
        if is_told {
            let store = self.open();
            let told = store.packs.damages();
            assert!(
                told.iter().any(|damage| damage.pack == path),
                "{told:?} has nothing of {}",
                path.display()
            );
            store.refresh();
            assert_eq!(store.packs.damages(), told, "damage is forgotten when the store is looked at again");
        }
        self.reopen();
    }

    /// Compares a store that has seen everything with the list.
    fn hold(&self, store: &RecordStore, what: &str) {
        let mut hashes = Vec::new();
        for (number, case) in self.cases.iter().enumerate() {
            let expected = self.of(number);
            let what = format!("{what}, case {number}: {:?}", self.model.get(&number));
            assert_eq!(store.kept(case).as_ref().map(content), expected, "{what}");
            assert_eq!(store.has(case), expected.is_some(), "{what}");
            assert_eq!(store.read(&case.hash()).as_ref().map(content), expected, "{what}");
            if let Some(content) = &expected {
                assert_eq!(
                    store.packs.entry(case.number()).map(|entry| entry.is_late),
                    Some(content.end == CaseEnd::Late),
                    "{what}"
                );
                assert_eq!(store.is_done(case), content.end != CaseEnd::Late, "{what}");
                assert_eq!(store.finished(case).is_some(), content.end != CaseEnd::Late, "{what}");
            }
            let is_listed =
                self.model.get(&number).is_some_and(|all| all.iter().any(|one| one.state != State::Gone));
            hashes.extend(is_listed.then(|| case.hash()));
        }
        hashes.sort_unstable();
        assert_eq!(store.hashes(), hashes, "{what}");
        assert_eq!(store.packs.entries().len(), hashes.len(), "{what}");
    }

    fn step(&mut self) {
        let case = self.dice.below(CASES);
        match self.dice.below(16) {
            0..=5 => self.write(case),
            6..=8 => self.time(case),
            9 => self.take_over(case),
            10..=12 => self.damage(case),
            13 => self.reopen(),
            14 => {
                for store in &self.writers {
                    store.refresh();
                    self.hold(store, "refreshed");
                }
            }
            _ => self.hold(&self.open(), "opened anew"),
        }
        let own = self.writer_of(case).kept(&self.cases[case]).as_ref().map(content);
        if self
            .model
            .get(&case)
            .is_some_and(|written| written.last().is_some_and(|one| one.state == State::Whole))
        {
            assert_eq!(own, self.of(case), "what was just written is not there: {:?}", self.model.get(&case));
        }
    }
}

#[test]
fn a_store_keeps_what_a_list_keeps_whatever_happens_to_it() {
    for seed in 0..24 {
        let mut bed = Bed::new(seed);
        for _ in 0..60 {
            bed.step();
        }
        bed.hold(&bed.open(), "at the end");
    }
}

/// What is made another of a record; a case that is not its own is there to take from.
type Change = fn(&mut Record, &Case);

#[test]
fn a_record_is_taken_up_only_where_layout_case_and_program_are_these() {
    let (own, other) = (case(1), case(2));
    let wall = [0.5];
    // What is changed of a sound record, then whether it is kept, read by its hash and known by its origin, and what
    // is taken up: nothing, of another program, without or with its wall times.
    let rows: [(&str, Change, [bool; 3], &str); 12] = [
        ("nothing", |_, _| (), [true; 3], "with times"),
        ("a later layout", |record, _| record.schema = SCHEMA + 1, [false; 3], "nothing"),
        ("an earlier layout", |record, _| record.schema = SCHEMA - 1, [false; 3], "nothing"),
        ("the case", |record, other| record.case = other.clone(), [false, false, true], "nothing"),
        ("the version", |record, _| record.provenance.version.push('1'), [true; 3], "another program's"),
        ("the sources", |record, _| record.provenance.sources.push('1'), [true; 3], "another program's"),
        ("the commit", |record, _| record.provenance.commit.push('1'), [true; 3], "with times"),
        ("the compiler", |record, _| record.provenance.compiler.push('1'), [true; 3], "without times"),
        ("the target", |record, _| record.provenance.target.push('1'), [true; 3], "without times"),
        ("the profile", |record, _| record.provenance.profile.push('1'), [true; 3], "without times"),
        (
            "its end",
            |record, other| record.status = self::record(other, 1, &[], CaseEnd::Late).status,
            [true; 3],
            "nothing",
        ),
        (
            "a failure",
            |record, other| record.status = self::record(other, 1, &[], CaseEnd::Failed).status,
            [true; 3],
            "with times",
        ),
    ];
    for (what, change, wanted, taken_up) in rows {
        let folder = tempfile::TempDir::new().expect("a folder");
        let store = RecordStore::new(folder.path(), "s");
        let mut record = record(&own, 1, &wall, CaseEnd::Ok);
        change(&mut record, &other);
        store.write(&record).expect("written");
        // As it was written, and as the next program opens it.
        for store in [store, RecordStore::new(folder.path(), "s")] {
            let found =
                [store.kept(&own).is_some(), store.read(&own.hash()).is_some(), store.origin(&own).is_some()];
            assert_eq!(found, wanted, "{what}");
            assert!(store.has(&own) && !store.has(&other), "{what}");
            let found = match store.found(&own) {
                Found::Nothing => "nothing",
                Found::OfAnotherProgram => "another program's",
                Found::Finished(record) if record.wall.is_empty() => "without times",
                Found::Finished(_) => "with times",
            };
            assert_eq!(found, taken_up, "{what}");
            assert_eq!(store.finished(&own).is_some(), taken_up.contains("times"), "{what}");
            assert_eq!(store.found(&other), Found::Nothing, "{what}");
        }
    }
}

#[test]
fn damage_is_told_by_its_first_byte_and_its_length() {
    for (from, to, is_cut, wanted) in [
        (
            3_000_000,
            3_000_200,
            false,
            "p.gz is damaged from byte 3000000 on: 200 bytes are not part of a record",
        ),
        (0, 7, false, "p.gz is damaged from byte 0 on: 7 bytes are not part of a record"),
        (
            3_000_000,
            3_000_200,
            true,
            "p.gz is cut at byte 3000000: 200 bytes of a record that was not finished",
        ),
        (0, 7, true, "p.gz is cut at byte 0: 7 bytes of a record that was not finished"),
    ] {
        assert_eq!(Damage { pack: "p.gz".into(), from, to, is_cut }.to_string(), wanted);
    }
}

#[test]
fn records_of_the_older_layout_are_named_and_working_folders_of_programs_are_not() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let store = RecordStore::new(folder.path(), "s");
    let solver = store.folder_of(&case(1).hash()).join("solver");
    fs::create_dir_all(&solver).expect("a folder");
    assert!(store.passed_over().is_empty());
    fs::write(store.folder_of(&case(1).hash()).join("record.json"), "{}").expect("a file");
    let cases = folder.path().join("s/cases");
    let sentence =
        "has records in the layout of version 0.2: they are not read, and the folder can be deleted";
    assert_eq!(store.passed_over(), [format!("{} {sentence}", cases.display())]);
    assert!(store.hashes().is_empty() && !store.has(&case(1)) && !store.is_done(&case(1)));
}
