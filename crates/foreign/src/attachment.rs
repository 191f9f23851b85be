//! Solvers of a study that are other programs, or results that lie there.

use crate::case_file::{CaseFile, suggested_step};
use crate::ending::{difference, states_at_outputs};
use crate::identity::{Version, commit_of, digest_of_program};
use crate::import::SampledState;
use crate::import::mapping::{Axes, Mapping};
use crate::process::{Ending, Finished, Order};
use crate::reading::{ReadResult, Unread, mapping_of, read};
use crate::solver::ExternalSolver;
use crate::staging::{Filling, Staged, words_of};
use crate::{ending, process};
use oedometer_case::machine::Machine;
use oedometer_case::outcome::{AttachedRun, Course, Outcome, Solver, Standing, WallSample};
use oedometer_case::{Case, Sample};
use oedometer_exact::exact_error::ExactError;
use oedometer_problem::outcome::{Failure, StepSizes};
use oedometer_problem::snapshot::{PlaneSamples, Samples, Snapshot};
use oedometer_scenes::scene::Body;
use oedometer_wording::{count_of, rounded};
use regex_lite::Regex;
use std::path::PathBuf;
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// Longest time limit, s: a century.
const MOST_SECONDS: f64 = 3e9;
/// Notes on what was taken from where that are kept.
const MOST_TAKEN: usize = 6;
/// Difference of repeats from which on it is worth a word.
const ROUND_OFF: f64 = 1e-12;
/// Ratio of the time that a solver says it took to that of its run, from which on it is in another unit.
const OWN_ABOVE_WALL: f64 = 1.5;

/// The solver of a study's table, ready for its cases; one that may not be started holds its cases back.
pub fn solver_of<'a>(solver: &'a ExternalSolver, axes: Axes, may_start: bool) -> Box<dyn Solver + 'a> {
    let reading = Reading::new(solver, axes);
    if solver.is_given() {
        return Box::new(GivenResult { reading });
    }
    let program = Attachment::new(reading);
    if may_start { Box::new(program) } else { Box::new(HeldBack { program }) }
}

/// What the result of a solver means, or why it is unknown.
struct Reading<'a> {
    solver: &'a ExternalSolver,
    mapping: Result<Mapping, String>,
}

/// A program with what its runs share.
struct Attachment<'a> {
    reading: Reading<'a>,
    version: OnceLock<Result<Version, String>>,
    /// Digest of its program at the first request, or why that is unknown.
    program: OnceLock<Result<String, String>>,
    /// Commit of the repository that the study is in.
    commit: OnceLock<Option<String>>,
    gate: Gate,
}

/// A program that is not allowed to start.
struct HeldBack<'a> {
    program: Attachment<'a>,
}

/// A result that lies there.
struct GivenResult<'a> {
    reading: Reading<'a>,
}

/// What a run left: its states at the outputs, or how it failed.
type Left = Result<(Vec<SampledState>, ReadResult), Failure>;

impl Solver for Attachment<'_> {
    fn solve(&self, case: &Case, course: &Course<'_>) -> Result<Outcome, ExactError> {
        let (mut about, mut wall) = (AttachedRun::default(), Vec::new());
        let left = self.runs(case, course, &mut about, &mut wall);
        Ok(outcome(case, left, about, wall))
    }

    fn standing(&self, earlier: Option<&AttachedRun>) -> Standing {
        self.standing_where(earlier, true)
    }
}

impl Solver for HeldBack<'_> {
    fn solve(&self, case: &Case, _: &Course<'_>) -> Result<Outcome, ExactError> {
        let command = self.program.reading.solver.command.clone();
        let about = AttachedRun { command, ..AttachedRun::default() };
        Ok(outcome(case, Err(ending::of_held_back()), about, Vec::new()))
    }

    fn standing(&self, earlier: Option<&AttachedRun>) -> Standing {
        self.program.standing_where(earlier, false)
    }
}

impl Solver for GivenResult<'_> {
    fn solve(&self, case: &Case, _: &Course<'_>) -> Result<Outcome, ExactError> {
        let solver = self.reading.solver;
        let named = solver.files.iter().map(|typed| typed.replace("{cells}", &case.cells.to_string()));
        let files: Vec<String> = named.collect();
        let paths: Vec<PathBuf> = files.iter().map(|file| solver.folder.join(file)).collect();
        let left = self.reading.taken(case, &paths, |unread| ending::of_given(unread, &files));
        // Records and messages name files as the study does.
        let folder = format!("{}/", solver.folder.display());
        let left = in_plain_words(left, |text| text.replace(&folder, ""));
        Ok(outcome(case, left, AttachedRun::default(), Vec::new()))
    }

    fn standing(&self, _: Option<&AttachedRun>) -> Standing {
        Standing::Outdated
    }
}

impl<'a> Reading<'a> {
    fn new(solver: &'a ExternalSolver, axes: Axes) -> Self {
        Self { solver, mapping: mapping_of(solver, axes).map_err(|error| error.to_string()) }
    }

    /// The result in files, whole.
    fn taken(&self, case: &Case, paths: &[PathBuf], failure: impl Fn(Unread) -> Failure) -> Left {
        let mapping = self.mapping.as_ref().map_err(|why| ending::of_mapping(why))?;
        let result = read(case, mapping, paths).map_err(failure)?;
        let states = states_at_outputs(case, &result.states, result.has_changing_mesh)
            .map_err(|lack| ending::of_incomplete(&lack))?;
        Ok((states, result))
    }
}

impl<'a> Attachment<'a> {
    fn new(reading: Reading<'a>) -> Self {
        Self {
            gate: Gate::of(reading.solver.at_once),
            reading,
            version: OnceLock::new(),
            program: OnceLock::new(),
            commit: OnceLock::new(),
        }
    }

    /// How an earlier run relates to the present program. Only a solver that may start is asked for its version.
    fn standing_where(&self, earlier: Option<&AttachedRun>, may_start: bool) -> Standing {
        let solver = self.reading.solver;
        let known = earlier.and_then(|about| about.program_digest.as_ref());
        let is_told = may_start || solver.version.is_empty();
        match (known, &solver.known_by) {
            (Some(known), Some(_)) if is_told => match self.program(&|| true) {
                Ok(present) if present == known => Standing::Proven,
                Ok(_) => Standing::Outdated,
                Err(_) => Standing::Unproven,
            },
            _ => Standing::Unproven,
        }
    }

    /// Runs a case, once to warm up where that is asked for and then to be timed, and says of which program.
    fn runs(
        &self,
        case: &Case,
        course: &Course<'_>,
        about: &mut AttachedRun,
        wall: &mut Vec<WallSample>,
    ) -> Left {
        let _passed = self.gate.pass();
        about.command.clone_from(&self.reading.solver.command);
        about.warmed_up = self.reading.solver.warm_up;
        about.commit.clone_from(self.commit.get_or_init(|| commit_of(&self.reading.solver.folder)));
        match self.version(&|| course.is_wanted()) {
            Ok(version) => about.version.clone_from(&version.line),
            Err(trouble) => about.notes.push(trouble.clone()),
        }
        if self.reading.solver.known_by.is_none() {
            return self.all_runs(case, course, about, wall);
        }
        let program = self.program(&|| course.is_wanted());
        let left = self.all_runs(case, course, about, wall);
        // What changed while it ran may have been another program from one run to the next.
        let is_same =
            |program: &&String| self.identity(&|| course.is_wanted()).is_ok_and(|end| end == **program);
        about.program_digest = program.as_ref().ok().filter(is_same).cloned();
        if about.program_digest.is_none() {
            let why = program.as_ref().err().map_or("its program changed while it ran", String::as_str);
            note(about, format!("later runs do not reuse its results: {why}"));
        }
        left
    }

    /// The runs of a case, each in a fresh folder. The last result is taken, and compared with the others.
    fn all_runs(
        &self,
        case: &Case,
        course: &Course<'_>,
        about: &mut AttachedRun,
        wall: &mut Vec<WallSample>,
    ) -> Left {
        let mut known: Option<(Vec<SampledState>, ReadResult)> = None;
        for number in 0..self.reading.solver.repeats + usize::from(self.reading.solver.warm_up) {
            if !course.is_wanted() {
                return Err(ending::of_stopped());
            }
            let left = self.run_once(case, course, about, wall)?;
            if number == 0 && self.reading.solver.warm_up {
                wall.clear();
            }
            if let Some((others, _)) = &known {
                note_difference(about, difference(others, &left.0));
            }
            known = Some(left);
        }
        known.ok_or_else(|| ending::of_incomplete("the solver was not run"))
    }

    /// One run in a fresh folder.
    fn run_once(
        &self,
        case: &Case,
        course: &Course<'_>,
        about: &mut AttachedRun,
        wall: &mut Vec<WallSample>,
    ) -> Left {
        // A mapping that is wrong fails before anything is started.
        self.reading.mapping.as_ref().map_err(|why| ending::of_mapping(why))?;
        let text = CaseFile::of(case).text().map_err(|error| ending::of_folder(&error.into()))?;
        let staged = Staged::new(course.place, &text).map_err(|error| ending::of_folder(&error))?;
        let filling = Filling::of(case, self.reading.solver, &staged.case_file(), &staged.out());
        let load = load_of_machine();
        let finished = self.finished(&filling, &staged, course);
        let own_seconds = self.own_seconds(&finished);
        if let Some(own) = own_seconds.filter(|own| *own > OWN_ABOVE_WALL * finished.seconds) {
            let [own, wall] = [own, finished.seconds].map(rounded);
            note(
                about,
                format!(
                    "it reports {own} s, more than the {wall} s of its run: in which unit is the number \
                     that `solve_seconds` matches (`solve_unit = \"ms\"`)?"
                ),
            );
        }
        wall.push(WallSample {
            seconds: finished.seconds,
            alone: course.alone,
            cpu_seconds: finished.cpu_seconds,
            peak_memory: finished.peak_memory,
            load,
            own_seconds,
            machine: Some(Machine::this()),
        });
        let left = self.left(case, &finished, &staged, &filling);
        if let Some(sentence) = ending::of_processes(&finished) {
            note(about, sentence);
        }
        let failed = left.is_err();
        if failed {
            let plain = |line: &String| staged.without_paths(line);
            about.last_words = ending::kept_words(&finished).iter().map(plain).collect();
        }
        let left = in_plain_words(left, |text| staged.without_paths(text));
        // Nothing of a cancelled run is kept; results of an earlier run stay.
        let is_stopped = matches!(finished.ending, Ending::Stopped);
        let keep =
            || staged.keep_words(&finished.output, &finished.errors).and_then(|()| staged.keep(!failed));
        if !is_stopped && let Err(error) = keep() {
            note(about, format!("its files could not be stored: {error}"));
        }
        left
    }

    fn finished(&self, filling: &Filling, staged: &Staged, course: &Course<'_>) -> Finished {
        let fill = |text: &str| filling.fill(text);
        let words = words_of(self.reading.solver, &self.reading.solver.command, fill);
        let environment: Vec<(String, String)> =
            self.reading.solver.environment.iter().map(|(name, value)| (name.clone(), fill(value))).collect();
        let folder = staged.out();
        let timeout = Duration::from_secs_f64(self.reading.solver.timeout.min(MOST_SECONDS));
        let order = Order { words: &words, environment: &environment, folder: &folder, timeout };
        process::run(&order, &|| course.is_wanted())
    }

    /// What a run left, the first status that applies.
    fn left(&self, case: &Case, finished: &Finished, staged: &Staged, filling: &Filling) -> Left {
        if let Some(failure) = ending::of_process(finished, self.reading.solver) {
            return Err(failure);
        }
        let path = PathBuf::from(filling.fill(&self.reading.solver.result));
        self.reading.taken(case, &[path], |unread| {
            ending::of_reading(unread, self.reading.solver, &staged.contents())
        })
    }

    /// The time that the solver says it took, s: the last that its output names.
    fn own_seconds(&self, finished: &Finished) -> Option<f64> {
        let pattern = Regex::new(self.reading.solver.solve_seconds.as_ref()?).ok()?;
        let last = |text: &str| {
            let found = pattern.captures_iter(text).last()?;
            let number: f64 = found.get(1)?.as_str().parse().ok()?;
            Some(number * self.reading.solver.solve_unit).filter(|seconds| seconds.is_finite())
        };
        last(&finished.output).or_else(|| last(&finished.errors))
    }

    /// What the solver says of its version, asked once.
    fn version(&self, is_wanted: &dyn Fn() -> bool) -> &Result<Version, String> {
        self.version.get_or_init(|| Version::asked(self.reading.solver, is_wanted))
    }

    /// Digest of its program as it was when first asked.
    fn program(&self, is_wanted: &dyn Fn() -> bool) -> &Result<String, String> {
        self.program.get_or_init(|| self.identity(is_wanted))
    }

    /// Digest of its program as its files are now.
    fn identity(&self, is_wanted: &dyn Fn() -> bool) -> Result<String, String> {
        digest_of_program(self.reading.solver, self.version(is_wanted).as_ref().map_err(String::clone)?)
    }
}

/// The outcome of what a run left.
fn outcome(case: &Case, left: Left, mut about: AttachedRun, wall: Vec<WallSample>) -> Outcome {
    let outcome = match left {
        Ok((states, result)) => {
            about.sample = Some(result.sample);
            let more = result.notes.len().saturating_sub(MOST_TAKEN);
            about.taken = result.notes.into_iter().take(MOST_TAKEN).collect();
            about.taken.extend((more > 0).then(|| format!("and {} more", count_of(more, "note", "notes"))));
            about.result_digest = Some(result.digest);
            let snapshot = |state| snapshot_of(case, result.sample, state);
            Outcome::of_states(states.iter().map(snapshot).collect(), result.sample)
        }
        Err(failure) => Outcome::of_failure(failure),
    };
    let step = suggested_step(case);
    let steps = StepSizes { target: step, largest: step, ..StepSizes::default() };
    outcome.with_steps(steps).made_by(about).timed(wall)
}

/// What a run left, with its sentences changed.
fn in_plain_words(left: Left, plain: impl Fn(&str) -> String) -> Left {
    match left {
        Ok((states, mut result)) => {
            result.notes = result.notes.iter().map(|note| plain(note)).collect();
            Ok((states, result))
        }
        Err(failure) => Err(Failure { reason: plain(&failure.reason), ..failure }),
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
        note(
            about,
            "its repeats give results at different places, or results that cannot be compared".to_owned(),
        );
    }
}

/// A state from outside as a snapshot: its kinds of samples, and the settlement where it is known.
fn snapshot_of(case: &Case, sample: Sample, state: &SampledState) -> Snapshot {
    let mut snapshot = Snapshot { time: state.time, settlement: f64::NAN, ..Snapshot::default() };
    for (sample, set) in state.sets(sample) {
        if snapshot.settlement.is_nan() {
            snapshot.settlement = settlement_in(case, set).unwrap_or(f64::NAN);
        }
        let plane = case.scene.body.is_plane().then(|| PlaneSamples {
            initial_distance: set.initial_distance.clone(),
            displacement_distance: None,
            horizontal_displacement: set.horizontal_displacement.clone(),
        });
        let samples = Samples {
            initial_height: set.initial_height.clone(),
            displacement_height: None,
            volume: set.volume.clone(),
            pressure: set.pressure.clone(),
            effective_stress: set.effective_stress.clone(),
            displacement: set.displacement.clone(),
            plane,
            water: None,
        };
        match sample {
            Sample::Centres => snapshot.centres = samples,
            Sample::Nodes => snapshot.nodes = samples,
            Sample::Points | Sample::Surface => snapshot.points = samples,
        }
    }
    snapshot
}

/// The settlement that a state shows, m: of a curve, or of a sample at the surface.
fn settlement_in(case: &Case, state: &SampledState) -> Option<f64> {
    let (height, body) = (case.column.height, case.scene.body);
    let length = body.is_plane().then(|| case.column.extent());
    // The settlement of a slab is its plate's, which presses across.
    let of_sample = || state.displacement_at_surface(height, length).filter(|_| body != Body::Slab);
    let surface = state.surface_displacement.or_else(of_sample);
    surface.map(|up| -up)
}

/// Runnable processes, as a mean over the last minute, if the system reports it.
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
