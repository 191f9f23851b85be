//! Gives the cases of a study to their solvers, and times them alone.

use crate::campaign::case_run::ThisProgram;
use crate::campaign::runner::{Progress, RunError};
use crate::campaign::stop;
use crate::case::outcome::{Course, Outcome, Solver, Standing};
use crate::case::work_estimate::estimated_work;
use crate::case::{Case, SolverName, Task, Tier};
use crate::foreign::attachment::solver_of;
use crate::import::mapping::Axes;
use crate::measure::record::record_of;
use crate::record::{Record, RecordStore, Status, WallSample};
use crate::study::check::Study;
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::run::Kernel;
use oedometer_problem::outcome::{Failure, FailureKind};
use std::collections::BTreeSet;

/// Repeats of a case that takes long end here: their spread is small, and they would make the study
/// wait for what it knows.
const REPEATS_OF_LONG_CASES: usize = 3;
/// Seconds beyond which the repeats of a case took long.
const LONG_REPEATS: f64 = 0.1;

/// A study with the solvers of its cases, ready to run.
pub struct CaseRunner<'a> {
    study: &'a Study,
    this_program: ThisProgram,
    others: Vec<(SolverName, Box<dyn Solver + 'a>)>,
}

impl<'a> CaseRunner<'a> {
    /// The runner of a study's cases.
    pub fn of(study: &'a Study) -> Self {
        let axes = Axes::of(study.scene);
        let of_table = |solver: &'a _| solver_of(solver, axes, study.may_start_solvers);
        let others = study.solvers.iter().map(|solver| (solver.method(), of_table(solver)));
        Self { study, this_program: ThisProgram { kernel: Kernel::Fastest }, others: others.collect() }
    }

    /// The same with a solver instead of the program or result of that name in the study.
    #[must_use]
    fn with(mut self, name: &str, solver: &'a dyn Solver) -> Self {
        for (known, other) in &mut self.others {
            if known.to_string() == name {
                *other = Box::new(solver);
            }
        }
        self
    }

    /// The study.
    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// The solver of a case, where that is not this program.
    fn other_solver(&self, case: &Case) -> Option<&dyn Solver> {
        self.others.iter().find(|(name, _)| *name == case.method).map(|(_, solver)| &**solver)
    }

    /// What a finished record is to the solvers of now.
    pub fn standing(&self, record: &Record) -> Standing {
        self.other_solver(&record.case).unwrap_or(&self.this_program).standing(record.outside_run())
    }

    /// Runs a case within the time that the study gives it; files that its solver leaves are kept in the store.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn run_within(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
        alone: bool,
        observe: &dyn Fn(u64, u64) -> bool,
    ) -> Result<Record, ExactError> {
        let course = Course { seconds: self.study.case_seconds, alone, observe, ..Course::alone() };
        record_of(case, &self.study.references, self.solved(case, store, course)?)
    }

    /// Runs a case alone, to be timed or looked at.
    ///
    /// # Errors
    /// When the exact solutions refuse the case's parameters.
    pub fn run_alone(&self, case: &Case, store: Option<&RecordStore>) -> Result<Record, ExactError> {
        record_of(case, &self.study.references, self.solved(case, store, Course::alone())?)
    }

    /// Wall times of a case alone; its errors are not computed again. None where it was stopped.
    ///
    /// # Errors
    /// When the case's parameters are impossible.
    pub fn time_alone(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
    ) -> Result<Vec<WallSample>, ExactError> {
        let timed = self.solved(case, store, Course::alone())?;
        Ok(if has_stopped(&timed.status) { Vec::new() } else { timed.wall })
    }

    fn solved(
        &self,
        case: &Case,
        store: Option<&RecordStore>,
        course: Course<'_>,
    ) -> Result<Outcome, ExactError> {
        let Some(other) = self.other_solver(case) else { return self.this_program.solve(case, &course) };
        let place = store.map(|store| store.folder_of(&case.hash()));
        let _at_work = stop::begin();
        // It has a process group of its own, which no signal to this program reaches: from now on they are taken, and
        // end it with all that it has started. Where the system refuses, they do what they did.
        let _ = stop::heed_signals();
        let observe = |done: u64, expected: u64| (course.observe)(done, expected) && !stop::is_over();
        let outcome = other.solve(case, &Course { place: place.as_deref(), observe: &observe, ..course })?;
        Ok(outcome.held_to(case))
    }
}

/// Runs all cases of a study, with a solver in Rust instead of the `[[solver]]` of that name; the
/// records are judged like any others.
///
/// ```
/// use oedometer::exact::exact_error::ExactError;
/// use oedometer::{Case, Course, Outcome, Sample, Snapshot, Solver, Study, StudySource, Tier, run_study_with};
/// use oedometer::{CheckEnd, GoldenFile, Norm, Quantity, StudyCheck};
///
/// /// A solver that leaves the load on the water, whatever the time.
/// struct Undrained;
///
/// impl Solver for Undrained {
///     fn solve(&self, case: &Case, _: &Course<'_>) -> Result<Outcome, ExactError> {
///         let state = |factor: &f64| {
///             let mut state = Snapshot { time: factor * case.seconds_per_time_factor(), ..Snapshot::default() };
///             state.points.initial_height = (0..case.cells).map(|cell| (cell as f64 + 0.5) * case.cell_size()).collect();
///             state.points.pressure = vec![case.column.load; case.cells];
///             state
///         };
///         Ok(Outcome::of_states(case.time_factors.iter().map(state).collect(), Sample::Points))
///     }
/// }
///
/// let text = r#"
/// title = "Mine"
/// scene = "terzaghi"
/// output = { time_factors = [0.1], references = ["terzaghi"] }
/// solver = [{ name = "mine", command = ["in-rust"], result = "{out}/none" }]
/// sweep = [{ method = ["mine"], cells = [10] }]
/// expect_case = [{ method = "mine", quantity = "pressure", time_factor = 0.1, error = { below = 1e-2 } }]
/// "#;
/// let study = Study::check(&StudySource { name: "mine.toml".to_owned(), text: text.to_owned() }).expect("sound");
/// let records = run_study_with(&study, "mine", &Undrained)?;
/// let error = records[0].error(Quantity::Pressure, Sample::Points, Norm::L2, "terzaghi", 0.1).expect("measured");
/// assert!(error.value > 0.1);
/// let check = StudyCheck::new(&study, &records, Tier::Full, Ok(GoldenFile::of("mine", &records, "as found")));
/// assert_eq!(check.end(), CheckEnd::Failed, "water leaves at the top");
/// # Ok::<(), ExactError>(())
/// ```
///
/// # Errors
/// When the exact solutions refuse the parameters of a case.
pub fn run_study_with(study: &Study, name: &str, solver: &dyn Solver) -> Result<Vec<Record>, ExactError> {
    let runner = CaseRunner::of(study).with(name, solver);
    let cases = study.cases(Tier::Full).into_iter();
    cases.map(|case| runner.run_within(case, None, true, &|_, _| true)).collect()
}

/// Whether the record of a case says that it was stopped from outside.
pub fn is_stopped(record: &Record) -> bool {
    has_stopped(&record.status)
}

fn has_stopped(status: &Status) -> bool {
    let is_it = |failure: &Failure| matches!(failure.kind, FailureKind::Stopped | FailureKind::TimedOut);
    matches!(status, Status::Failed(failure) if is_it(failure))
}

/// Whether the wall time of a case is not known yet as well as its study asks.
fn wants_timing(record: &Record, repeats: usize) -> bool {
    let wall = record.wall_alone();
    let is_long = wall.iter().sum::<f64>() > LONG_REPEATS;
    let enough = if is_long { repeats.min(REPEATS_OF_LONG_CASES) } else { repeats };
    let is_solved = record.case.task == Task::Solve;
    is_solved && record.status == Status::Ok && wall.len() < enough
}

/// Times the cases of records alone, in rounds over all of them, until each has the study's number
/// of samples: what drifts on the machine meets every case alike.
///
/// # Errors
/// When a case cannot be run or its times not be kept.
pub fn time_study(
    study: &Study,
    records: &mut [Record],
    store: Option<&RecordStore>,
    tell: &(dyn Fn(Progress) + Sync),
) -> Result<(), RunError> {
    let _at_work = stop::begin();
    let runner = CaseRunner::of(study);
    let mut timed_ones = BTreeSet::new();
    for _ in 0..study.timing_repeats {
        for (place, record) in records.iter_mut().enumerate() {
            if stop::is_asked() || !wants_timing(record, study.timing_repeats) {
                continue;
            }
            let timed = runner
                .time_alone(&record.case, store)
                .map_err(|error| RunError::refused(&record.case, error))?;
            if timed.is_empty() {
                continue;
            }
            record.wall.extend(timed);
            timed_ones.insert(place);
            tell(Progress::Advanced(estimated_work(&record.case)));
        }
    }
    // Once for all rounds: a record is kept whole with its times.
    if let Some(store) = store {
        for place in timed_ones {
            store.write(&records[place])?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::WallSample;

    fn record(task: &str) -> Record {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\ntask = \"{task}\"\noutput = {{ time_factors = [0.001] }}\n\
             sweep = [{{ method = [\"GIMP\"], cells = [2], time_step = [{{ stable = 0.8 }}] }}]\n"
        );
        records_of(&text).remove(0)
    }

    #[test]
    fn what_is_solved_is_timed_as_often_as_asked_and_what_takes_long_three_times() {
        let mut solved = record("solve");
        solved.wall.clear();
        for (seconds, repeats) in [(0.001, 12), (0.06, 3), (0.022, 5)] {
            solved.wall.clear();
            while wants_timing(&solved, 12) {
                solved.wall.push(WallSample { seconds, alone: true, ..WallSample::default() });
            }
            assert_eq!(solved.wall.len(), repeats, "{seconds} s");
        }
        assert!(!wants_timing(&record("stability"), 12), "a search has no time of its own");
    }

    #[test]
    fn a_run_is_stopped_by_its_time_or_from_outside_and_by_nothing_else() {
        use oedometer_problem::outcome::FailureKind as Kind;

        let mut one = record("solve");
        assert!(!is_stopped(&one));
        for (kind, stopped) in
            [(Kind::Stopped, true), (Kind::TimedOut, true), (Kind::Unstable, false), (Kind::Skipped, false)]
        {
            one.status = Status::Failed(Failure::of_attached(kind, String::new()));
            assert_eq!(is_stopped(&one), stopped, "{kind:?}");
        }
    }
}
