//! A solver of a study, ready to run its cases.

use crate::case::Case;
use crate::case::quantity::Sample;
use crate::foreign::case_file::{CaseFile, suggested_step};
use crate::foreign::command::{Filling, words_of};
use crate::foreign::process::{Ending, Finished, Order};
use crate::foreign::reading::{ReadResult, mapping_of, read};
use crate::foreign::repeats::difference;
use crate::foreign::staging::Staged;
use crate::foreign::wholeness::states_at_outputs;
use crate::foreign::{ending, process};
use crate::import::mapping::Mapping;
use crate::import::table::SampledState;
use crate::measure::record::record_of_attached;
use crate::record::attached_run::AttachedRun;
use crate::record::machines::Machine;
use crate::record::{Record, Status, WallSample};
use crate::study::solver::Solver;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::run::results::outcome::Failure;
use oedometer_mpm::run::results::snapshot::{PlaneSamples, Samples, Snapshot};
use oedometer_soil::wording::typed;
use regex_lite::Regex;
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// Longest time that a command may take to tell its version, s.
const VERSION_SECONDS: f64 = 60.0;
/// Longest version that is kept, letters.
const LONGEST_VERSION: usize = 200;
/// Share of the height within which a sample counts as at the surface, and of the length as under the crest.
const RIM: f64 = 1e-6;
/// Longest time limit, s: a century.
const MOST_SECONDS: f64 = 3e9;
/// Notes on what was taken from where that are kept.
const MOST_TAKEN: usize = 6;
/// Difference of repeats from which on it is worth a word.
const ROUND_OFF: f64 = 1e-12;

/// A solver with what its runs share.
pub struct Attachment<'a> {
    solver: &'a Solver,
    /// What its result means, or why that cannot be told.
    mapping: Result<Mapping, String>,
    version: OnceLock<Version>,
    gate: Gate,
}

/// How a case is to be run.
#[derive(Clone, Copy)]
pub struct Wish<'a> {
    /// Exact solutions that the result is held against.
    pub references: &'a [ReferenceKind],
    /// Folder of the case's record, beside which the run is kept; none where nothing is.
    pub place: Option<&'a Path>,
    /// Whether nothing else of this program competes for the cores meanwhile.
    pub alone: bool,
    /// Whether the case is still wanted.
    pub is_wanted: &'a dyn Fn() -> bool,
}

/// What a solver says of its version, or why that is not known.
#[derive(Default)]
struct Version {
    line: Option<String>,
    trouble: Option<String>,
}

/// What a run left: its states at the outputs, or how it failed.
type Left = Result<(Vec<SampledState>, ReadResult), Failure>;

impl<'a> Attachment<'a> {
    /// A solver of a study about a column, or about a plane.
    pub fn new(solver: &'a Solver, is_plane: bool) -> Self {
        let mapping = mapping_of(solver, is_plane).map_err(|error| error.to_string());
        Self { solver, mapping, version: OnceLock::new(), gate: Gate::of(solver.at_once) }
    }

    /// The solver.
    pub fn solver(&self) -> &Solver {
        self.solver
    }

    /// Runs a case: once to warm up where that is asked for, then the timed runs, each in a fresh folder. The last
    /// result is taken, and held against the others.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn run(&self, case: &Case, wish: &Wish<'_>) -> Result<Record, ExactError> {
        if self.solver.is_given() {
            return Self::record(case, wish, self.given(case), AttachedRun::default(), Vec::new());
        }
        let _passed = self.gate.pass();
        let mut about = AttachedRun {
            command: self.solver.command.clone(),
            version: self.version(wish).line.clone(),
            warmed_up: self.solver.warm_up,
            notes: self.version(wish).trouble.clone().into_iter().collect(),
            ..AttachedRun::default()
        };
        let mut wall = Vec::new();
        let mut known: Option<(Vec<SampledState>, ReadResult)> = None;
        let runs = self.solver.repeats + usize::from(self.solver.warm_up);
        for number in 0..runs {
            if !(wish.is_wanted)() {
                return Self::record(case, wish, Err(ending::of_stopped()), about, wall);
            }
            let left = self.run_once(case, wish, &mut about, &mut wall);
            let (states, result) = match left {
                Ok(left) => left,
                Err(failure) => return Self::record(case, wish, Err(failure), about, wall),
            };
            if number == 0 && self.solver.warm_up {
                wall.clear();
            }
            if let Some((others, _)) = &known {
                note_difference(&mut about, difference(others, &states));
            }
            known = Some((states, result));
        }
        let nothing = || ending::of_incomplete("the solver was not run");
        Self::record(case, wish, known.ok_or_else(nothing), about, wall)
    }

    /// The record of a case whose program may not be started: it was skipped.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn held_back(&self, case: &Case, wish: &Wish<'_>) -> Result<Record, ExactError> {
        let about = AttachedRun { command: self.solver.command.clone(), ..AttachedRun::default() };
        Self::record(case, wish, Err(ending::of_held_back()), about, Vec::new())
    }

    /// What is there already.
    fn given(&self, case: &Case) -> Left {
        // Records and messages name files as the study does.
        let folder = format!("{}/", self.solver.folder.display());
        let plain = |text: &str| text.replace(&folder, "");
        let mapping = self.mapping.as_ref().map_err(|why| ending::of_mapping(&plain(why)))?;
        let name = |typed: &String| typed.replace("{cells}", &case.cells.to_string());
        let paths: Vec<PathBuf> =
            self.solver.files.iter().map(|typed| self.solver.folder.join(name(typed))).collect();
        let result = read(case, mapping, &paths).map_err(|unread| {
            let failure = ending::of_given(unread, &self.solver.files);
            Failure { reason: plain(&failure.reason), ..failure }
        })?;
        let states = states_at_outputs(case, &result.states).map_err(|lack| ending::of_incomplete(&lack))?;
        let notes = result.notes.iter().map(|note| plain(note)).collect();
        Ok((states, ReadResult { notes, ..result }))
    }

    /// One run in a fresh folder.
    fn run_once(
        &self,
        case: &Case,
        wish: &Wish<'_>,
        about: &mut AttachedRun,
        wall: &mut Vec<WallSample>,
    ) -> Left {
        let mapping = self.mapping.as_ref().map_err(|why| ending::of_mapping(why))?;
        let text = CaseFile::of(case).text().map_err(|error| ending::of_folder(&error.into()))?;
        let staged = Staged::new(wish.place, &text).map_err(|error| ending::of_folder(&error))?;
        let filling = Filling::of(case, self.solver, &staged.case_file(), &staged.out());
        let load = load_of_machine();
        let finished = self.finished(&filling, &staged, wish);
        wall.push(WallSample {
            seconds: finished.seconds,
            alone: wish.alone,
            cpu_seconds: finished.cpu_seconds,
            peak_memory: finished.peak_memory,
            load,
            own_seconds: self.own_seconds(&finished),
            machine: Some(Machine::this()),
        });
        let left = self.left(case, mapping, &finished, &staged, &filling);
        if let Some(sentence) = ending::of_processes(&finished) {
            note(about, sentence);
        }
        let failed = left.as_ref().err().is_some();
        if failed {
            about.last_words = ending::kept_words(&finished);
        }
        let plain = |text: &str| staged.without_paths(text);
        about.last_words = about.last_words.iter().map(|line| plain(line)).collect();
        let left = left.map_err(|failure| Failure { reason: plain(&failure.reason), ..failure }).map(
            |(states, result)| {
                let notes = result.notes.iter().map(|note| plain(note)).collect();
                (states, ReadResult { notes, ..result })
            },
        );
        // Of a run that nobody wants any more nothing is kept, and what an earlier one left stays.
        let is_stopped = matches!(finished.ending, Ending::Stopped);
        let keep =
            || staged.keep_words(&finished.output, &finished.errors).and_then(|()| staged.keep(!failed));
        if !is_stopped && let Err(error) = keep() {
            note(about, format!("its files could not be kept: {error}"));
        }
        left
    }

    fn finished(&self, filling: &Filling, staged: &Staged, wish: &Wish<'_>) -> Finished {
        let fill = |text: &str| filling.fill(text);
        let words = words_of(self.solver, &self.solver.command, fill);
        let environment: Vec<(String, String)> =
            self.solver.environment.iter().map(|(name, value)| (name.clone(), fill(value))).collect();
        let folder = staged.out();
        let timeout = Duration::from_secs_f64(self.solver.timeout.min(MOST_SECONDS));
        let order = Order { words: &words, environment: &environment, folder: &folder, timeout };
        process::run(&order, wish.is_wanted)
    }

    /// What a run left, the first status that applies.
    fn left(
        &self,
        case: &Case,
        mapping: &Mapping,
        finished: &Finished,
        staged: &Staged,
        filling: &Filling,
    ) -> Left {
        if let Some(failure) = ending::of_process(finished, self.solver) {
            return Err(failure);
        }
        let path = PathBuf::from(filling.fill(&self.solver.result));
        let result = read(case, mapping, &[path])
            .map_err(|unread| ending::of_reading(unread, self.solver, &staged.contents()))?;
        let states = states_at_outputs(case, &result.states).map_err(|lack| ending::of_incomplete(&lack))?;
        Ok((states, result))
    }

    /// The time that the solver says it took, s: the last that its output names.
    fn own_seconds(&self, finished: &Finished) -> Option<f64> {
        let pattern = Regex::new(self.solver.solve_seconds.as_ref()?).ok()?;
        let last = |text: &str| {
            let found = pattern.captures_iter(text).last()?;
            found.get(1)?.as_str().parse().ok().filter(|seconds: &f64| seconds.is_finite())
        };
        last(&finished.output).or_else(|| last(&finished.errors))
    }

    /// What the solver says of its version, asked once, within the time of a run.
    fn version(&self, wish: &Wish<'_>) -> &Version {
        let ask = || {
            if self.solver.version.is_empty() {
                return Version::default();
            }
            let words = words_of(self.solver, &self.solver.version, str::to_owned);
            let seconds = self.solver.timeout.min(VERSION_SECONDS);
            let timeout = Duration::from_secs_f64(seconds);
            let folder = &self.solver.folder;
            let order = Order { words: &words, environment: &[], folder, timeout };
            let found = process::run(&order, wish.is_wanted);
            if matches!(found.ending, Ending::TimedOut) {
                let trouble =
                    format!("its version is not known: that command did not end within {} s", typed(seconds));
                return Version { line: None, trouble: Some(trouble) };
            }
            let mut lines = found.output.lines().chain(found.errors.lines());
            let line = lines.find(|line| !line.trim().is_empty());
            let line = line.map(|line| line.trim().chars().take(LONGEST_VERSION).collect());
            Version { line, trouble: None }
        };
        self.version.get_or_init(ask)
    }

    fn record(
        case: &Case,
        wish: &Wish<'_>,
        left: Left,
        mut about: AttachedRun,
        wall: Vec<WallSample>,
    ) -> Result<Record, ExactError> {
        let (status, snapshots) = match left {
            Ok((states, result)) => {
                about.sample = Some(result.sample);
                let more = result.notes.len().saturating_sub(MOST_TAKEN);
                about.taken = result.notes.into_iter().take(MOST_TAKEN).collect();
                about.taken.extend((more > 0).then(|| format!("and {more} notes more")));
                about.result_digest = Some(result.digest);
                let snapshot = |state| snapshot_of(case, result.sample, state);
                (Status::Ok, states.into_iter().map(snapshot).collect())
            }
            Err(failure) => (Status::Failed(failure), Vec::new()),
        };
        let step = suggested_step(case);
        let record = record_of_attached(case, wish.references, status, snapshots, step, about)?;
        Ok(Record { wall, ..record })
    }
}

fn note(about: &mut AttachedRun, sentence: String) {
    if !about.notes.contains(&sentence) {
        about.notes.push(sentence);
    }
}

/// Keeps how far two repeats of a run differ.
fn note_difference(about: &mut AttachedRun, difference: f64) {
    if difference.is_finite() {
        about.repeats_differ_by =
            Some(about.repeats_differ_by.map_or(difference, |known| known.max(difference)));
        if difference > ROUND_OFF {
            note(about, "its repeats do not give the same result; see `repeats_differ_by`".to_owned());
        }
    } else {
        note(about, "its repeats give results at other places, or such as no one can compare".to_owned());
    }
}

/// A state from outside as a snapshot: its one kind of samples, and the settlement where it is known.
fn snapshot_of(case: &Case, sample: Sample, state: SampledState) -> Snapshot {
    let is_at_surface = |place: &usize| {
        let column = &case.column;
        state.initial_height[*place] > (1.0 - RIM) * column.height
            && state.initial_distance.get(*place).is_none_or(|distance| {
                !case.scene.has_plane_fields() || *distance < RIM * column.horizontal_extent
            })
    };
    let at_surface = || {
        let place = (0..state.initial_height.len()).find(is_at_surface)?;
        state.displacement.get(place).copied()
    };
    // The settlement of a slab is its plate's, which presses across.
    let surface = state.surface_displacement.or_else(|| at_surface().filter(|_| !case.scene.has_plates()));
    let plane = case.scene.has_plane_fields().then(|| PlaneSamples {
        initial_distance: state.initial_distance.clone(),
        displacement_distance: None,
        horizontal_displacement: state.horizontal_displacement.clone(),
    });
    let samples = Samples {
        initial_height: state.initial_height,
        displacement_height: None,
        volume: state.volume,
        pressure: state.pressure,
        effective_stress: state.effective_stress,
        displacement: state.displacement,
        plane,
        water: None,
    };
    let mut snapshot =
        Snapshot { time: state.time, settlement: surface.map_or(f64::NAN, |up| -up), ..Snapshot::default() };
    match sample {
        Sample::Centres => snapshot.centres = samples,
        Sample::Nodes => snapshot.nodes = samples,
        Sample::Points | Sample::Surface => snapshot.points = samples,
    }
    snapshot
}

/// Programs that want the processor, as a mean over the last minute, where the system tells.
fn load_of_machine() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.parse().ok()
}

/// Lets so many pass at the same time.
struct Gate {
    free: Mutex<usize>,
    freed: Condvar,
}

/// A pass through a gate, given back when it is dropped.
struct Passed<'a>(&'a Gate);

impl Gate {
    fn of(count: usize) -> Self {
        Self { free: Mutex::new(count), freed: Condvar::new() }
    }

    fn pass(&self) -> Passed<'_> {
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let mut free = self.freed.wait_while(free, |free| *free == 0).unwrap_or_else(PoisonError::into_inner);
        *free -= 1;
        Passed(self)
    }
}

impl Drop for Passed<'_> {
    fn drop(&mut self) {
        *self.0.free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.0.freed.notify_one();
    }
}

#[cfg(test)]
pub(crate) mod tests;
