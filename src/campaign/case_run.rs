//! This program as a solver of cases, and how long the processor worked on one, for which other programs do not count.

use crate::case::machine::Machine;
use crate::case::outcome::{Course, Inside, Outcome, Solver, Status, WallSample};
use crate::case::work_estimate::MOST_PROBE_STEPS;
use crate::case::{Case, SolverName, Task};
use crate::measure::record::record_of;
use crate::record::Record;
use oedometer_exact::exact_error::{ExactError, normal};
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::discretise::{Discretised, discretise};
use oedometer_mpm::kernel::body::Discrete;
use oedometer_mpm::run::observed::Stopped;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_mpm::time_limit::TimeLimit;
use oedometer_problem::critical_step::CriticalStep;
use oedometer_problem::integrator::{Formulation, StepBound};
use oedometer_problem::method::Method;
use oedometer_problem::outcome::{self, Counters, Failure, FailureKind, StepSizes};
use oedometer_problem::problem::StartError;
use oedometer_problem::time_step::TimeStep;
use oedometer_problem::wave_speeds;
use oedometer_scenes::Scene;
use oedometer_scenes::column::{Column, column_parameters};
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use std::time::Instant;

/// Points of the settlement curve of a run.
const HISTORY_POINTS: usize = 48;
/// The same where waves run.
const WAVE_POINTS: usize = 96;
/// First time factor of the settlement curve.
const HISTORY_START: f64 = 1e-3;

/// The methods of this program.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThisProgram {
    /// How explicit steps are computed where nothing moves.
    pub kernel: Kernel,
}

impl Solver for ThisProgram {
    fn solve(&self, case: &Case, course: &Course<'_>) -> Result<Outcome, ExactError> {
        plausible(case)?;
        let plain = &case.without_idle_choices();
        let limit =
            if course.seconds.is_finite() { TimeLimit::after(course.seconds) } else { TimeLimit::default() };
        let in_time = |done: u64, expected: u64| (course.observe)(done, expected) && !limit.is_over();
        let outcome = if case.task == Task::Stability {
            critical_step_of(plain, &in_time)?
        } else {
            solved(plain, course, self.schedule(plain, course, limit), &in_time)?
        };
        Ok(named_if_late(outcome, course.seconds))
    }
}

/// All cores that the system gives this program, for a case that is alone.
pub fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get)
}

/// The outcome of a case that was stopped because its time was over says so.
fn named_if_late(mut outcome: Outcome, seconds: f64) -> Outcome {
    if let Status::Failed(failure) = &mut outcome.status
        && failure.kind == FailureKind::Stopped
    {
        failure.kind = FailureKind::TimedOut;
        failure.reason = format!("it took longer than the {seconds} s that its study allows a case");
    }
    outcome
}

/// Runs one case on one thread; `alone` says whether nothing else competes for the cores meanwhile.
///
/// ```
/// use oedometer::exact::ReferenceKind;
/// use oedometer::{Kernel, Norm, Quantity, Sample, Study, StudySource, run_case};
///
/// let text = r#"
/// title = "One column"
/// scene = "terzaghi"
/// output = { time_factors = [0.1] }
/// sweep = [{ method = ["GC-SRI-patch"], integrator = ["implicit"], cells = [20] }]
/// "#;
/// let source = StudySource { name: "one.toml".to_owned(), text: text.to_owned() };
/// let planned = &Study::check(&source).expect("a sound study").planned[0];
/// let record = run_case(&planned.case, &[ReferenceKind::Terzaghi], Kernel::Fastest, true, &|_, _| true)?;
/// let error = record.error(Quantity::Pressure, Sample::Centres, Norm::L2, "terzaghi", 0.1);
/// assert!(error.expect("measured").value < 1e-2);
/// # Ok::<(), oedometer::exact::ExactError>(())
/// ```
///
/// # Errors
/// When the exact solutions refuse the case's parameters.
pub fn run_case(
    case: &Case,
    references: &[ReferenceKind],
    kernel: Kernel,
    alone: bool,
    observe: &dyn Fn(u64, u64) -> bool,
) -> Result<Record, ExactError> {
    let course = Course { alone, observe, ..Course::alone() };
    record_of(case, references, ThisProgram { kernel }.solve(case, &course)?)
}

/// What a case comes to, and how long that took.
fn solved(
    case: &Case,
    course: &Course<'_>,
    mut schedule: Schedule,
    observe: &dyn Fn(u64, u64) -> bool,
) -> Result<Outcome, ExactError> {
    let problem = problem_of(case)?;
    let is_bound = case.integrator.step_bound() == StepBound::AllWaves;
    if is_bound && !matches!(case.time_step, TimeStep::Stable(_)) {
        // The limit is a diagnosis of this program, and no work of the method: it is not timed.
        schedule.critical_step = Some(problem.predicted_critical_step(&case.settings));
    }
    let clock = clock_of(course.threads);
    let (start, worked) = (Instant::now(), clock());
    let run = problem.run(&schedule, observe);
    let seconds = start.elapsed().as_secs_f64();
    let cpu_seconds = worked.zip(clock()).map(|(before, after)| after - before);
    let machine = Some(Machine::this());
    let wall = WallSample { seconds, alone: course.alone, cpu_seconds, machine, ..WallSample::default() };
    Ok(outcome_of(run).timed(vec![wall]))
}

/// A run of the solver as the outcome of its case.
fn outcome_of(run: outcome::Outcome) -> Outcome {
    let outcome::Outcome { status, start, snapshots, history, counters, step_sizes } = run;
    let mut outcome = match status {
        Ok(()) => Outcome::of_end(Status::Ok),
        Err(failure) => Outcome::of_failure(failure),
    };
    outcome.snapshots = snapshots;
    let inside = Inside { counters, start: Some(start), history, critical_step: None };
    outcome.with_steps(step_sizes).with_inside(inside)
}

/// The scene's problem on `cells` cells over the height with `points_per_cell` points each, in the dimension that is asked for.
///
/// # Errors
/// When the parameters are impossible.
pub fn column_problem<const D: usize>(
    scene: &'static Scene,
    column: &Column,
    soil: &Material,
    method: Method,
    cells: usize,
    points_per_cell: usize,
) -> Result<Discrete<D>, ExactError> {
    discretise(&scene.problem(column, soil, method, cells, points_per_cell)?).map_err(of_start)
}

fn problem_of(case: &Case) -> Result<Discretised, ExactError> {
    let Case { scene, column, material, method, cells, points_per_cell, .. } = case;
    let SolverName::Own(method) = *method else { unreachable!("other programs solve their own cases") };
    let problem = scene.problem(column, material, method, *cells, *points_per_cell)?;
    Discretised::new(&problem).map_err(of_start)
}

/// The refusal of an exact solution, from which the start of a scene is taken.
fn of_start(error: StartError) -> ExactError {
    *error.downcast().expect("the starts of problems are those of exact solutions")
}

/// Refuses numbers that no run can go on from, before anything is computed and whoever computes it.
fn plausible(case: &Case) -> Result<(), ExactError> {
    let parameters = column_parameters(&case.column, &case.material);
    parameters.validate()?;
    normal(
        "critical time step",
        wave_speeds::combined_limit(&case.material, case.cell_size(), case.settings.drag),
    )?;
    for factor in case.time_factors.iter().filter(|factor| **factor > 0.0) {
        normal("time of an output", parameters.time(*factor))?;
    }
    Ok(())
}

/// Predicts and observes the critical step of a case.
fn critical_step_of(case: &Case, observe: &dyn Fn(u64, u64) -> bool) -> Result<Outcome, ExactError> {
    let problem = problem_of(case)?;
    let end = case.time_factors.last().map_or(0.0, |factor| factor * case.seconds_per_time_factor());
    // Of how many steps a search will be is not known: its work is told at its end.
    let go_on = |_, _| observe(0, 1);
    Ok(match problem.critical_step(&case.settings, end, MOST_PROBE_STEPS, &go_on) {
        Ok(critical) => outcome_of_search(case, critical),
        Err(Stopped) => outcome_of_stopped_search(case),
    })
}

fn outcome_of_search(case: &Case, critical: CriticalStep) -> Outcome {
    let largest = critical.observed.unwrap_or(critical.predicted);
    let predicted = critical.predicted;
    let steps =
        StepSizes { predicted_critical: predicted, target: predicted, largest, ..StepSizes::default() };
    let steps_done = critical.probes.iter().map(|probe| probe.steps).sum();
    let inside = inside_of_search(case, steps_done, Some(critical));
    Outcome::of_end(Status::Ok).with_steps(steps).with_inside(inside)
}

fn outcome_of_stopped_search(case: &Case) -> Outcome {
    let reason = "stopped from outside".to_owned();
    let failure = Failure { kind: FailureKind::Stopped, step: 0, time: 0.0, growth: None, reason };
    Outcome::of_failure(failure).with_inside(inside_of_search(case, 0, None))
}

fn inside_of_search(case: &Case, steps: u64, critical_step: Option<CriticalStep>) -> Inside {
    let points = case.cells * case.points_per_cell;
    let counters = Counters { points, steps, ..Counters::default() };
    Inside { counters, start: None, history: Vec::new(), critical_step }
}

impl ThisProgram {
    fn schedule(self, case: &Case, course: &Course<'_>, time_limit: TimeLimit) -> Schedule {
        let parameters = column_parameters(&case.column, &case.material);
        let end = case.time_factors.last().copied().unwrap_or(0.0);
        let notes_energy = case.scene.waves && case.formulation != Formulation::QuasiStatic;
        let history = if notes_energy {
            // A wave is as fast at its end.
            let place = |i: usize| end * (i + 1) as f64 / WAVE_POINTS as f64;
            (0..WAVE_POINTS).map(|i| parameters.time(place(i))).filter(|time| *time > 0.0).collect()
        } else if end > HISTORY_START {
            let growth = elementary::ln(end / HISTORY_START) / (HISTORY_POINTS - 1) as f64;
            (0..HISTORY_POINTS)
                .map(|i| parameters.time(HISTORY_START * elementary::exp(growth * i as f64)))
                .collect()
        } else {
            Vec::new()
        };
        Schedule {
            outputs: case.time_factors.iter().map(|factor| parameters.time(*factor)).collect(),
            history,
            notes_energy,
            time_step: case.time_step,
            settings: case.settings,
            kernel: self.kernel,
            integrator: case.integrator,
            critical_step: None,
            formulation: case.formulation,
            threads: course.threads,
            time_limit,
        }
    }
}

/// The processor time of a case on so many threads: one of several has the process for itself.
fn clock_of(threads: usize) -> fn() -> Option<f64> {
    if threads > 1 { process_seconds } else { thread_seconds }
}

/// Processor time of this thread, s, if the system reports it.
pub fn thread_seconds() -> Option<f64> {
    #[cfg(unix)]
    return seconds_of(rustix::time::ClockId::ThreadCPUTime);
    #[cfg(not(unix))]
    None
}

/// Processor time of all threads of this program, s, if the system reports it.
pub fn process_seconds() -> Option<f64> {
    #[cfg(unix)]
    return seconds_of(rustix::time::ClockId::ProcessCPUTime);
    #[cfg(not(unix))]
    None
}

#[cfg(unix)]
fn seconds_of(clock: rustix::time::ClockId) -> Option<f64> {
    let time = rustix::time::clock_gettime(clock);
    let seconds = time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64;
    (seconds > 0.0).then_some(seconds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::Study;
    use crate::study::file::StudySource;
    use std::time::{Duration, Instant};

    #[test]
    fn work_counts_and_sleep_does_not() {
        let Some(start) = thread_seconds() else { return };
        std::thread::sleep(Duration::from_millis(60));
        let slept = thread_seconds().expect("told before") - start;
        assert!(slept < 0.05, "{slept} s of sleep");
        let clock = Instant::now();
        let mut sum = 0_u64;
        while thread_seconds().expect("told before") - start < 0.02 && clock.elapsed().as_secs() < 60 {
            sum = (0..10_000).fold(sum, |sum, one| std::hint::black_box(sum ^ one));
        }
        assert!(thread_seconds().expect("told before") - start >= 0.02);
    }

    #[test]
    fn the_work_of_another_thread_counts_for_the_process_alone() {
        let [of_thread, of_process] = [clock_of(1), clock_of(2)];
        let Some((thread, process)) = of_thread().zip(of_process()) else { return };
        let work = || {
            let (clock, start) = (Instant::now(), thread_seconds().expect("told before"));
            while thread_seconds().expect("told before") - start < 0.06 && clock.elapsed().as_secs() < 60 {
                std::hint::black_box((0..10_000_u64).fold(0, |sum, one| std::hint::black_box(sum ^ one)));
            }
        };
        std::thread::scope(|scope| scope.spawn(work).join().expect("no panic"));
        assert!(of_thread().expect("told before") - thread < 0.05);
        assert!(of_process().expect("told before") - process >= 0.05);
    }

    #[test]
    fn a_history_goes_from_a_thousandth_to_the_last_output_by_equal_ratios() {
        let of = |times: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\ncolumn.height = 2.0\noutput.time_factors = {times}\n[[sweep]]\n\
                 method = ['GIMP']\nintegrator = ['implicit']\ncells = [4]\n"
            );
            let study = Study::check(&StudySource { name: "s.toml".to_owned(), text }).expect("sound");
            let case = study.planned[0].case.clone();
            let program = ThisProgram { kernel: Kernel::Fastest };
            (
                program.schedule(&case, &Course::alone(), TimeLimit::default()),
                column_parameters(&case.column, &case.material),
            )
        };
        let (schedule, column) = of("[0.1, 2.0]");
        let factors: Vec<f64> = schedule.history.iter().map(|time| column.time_factor(*time)).collect();
        assert_eq!(factors.len(), 48);
        assert!((factors[0] / 1e-3 - 1.0).abs() < 1e-12 && (factors[47] / 2.0 - 1.0).abs() < 1e-12);
        // 47 equal ratios from 1e-3 to 2.
        let ratio = 2000.0_f64.powf(1.0 / 47.0);
        assert!(
            factors.windows(2).all(|pair| (pair[1] / pair[0] / ratio - 1.0).abs() < 1e-12),
            "{factors:?}"
        );
        assert_eq!(schedule.outputs.len(), 2);
        assert!(of("[0.001]").0.history.is_empty());
    }

    #[test]
    fn a_search_that_is_stopped_is_a_failed_record_without_steps() {
        let scene = &oedometer_scenes::TERZAGHI;
        let case = Case { cells: 4, ..Case::seed(crate::case::Task::Stability, scene) };
        let stopped = record_of(&case, &[], outcome_of_stopped_search(&case)).expect("a record");
        let failure = stopped.status.failure().expect("it was stopped");
        assert_eq!((failure.kind, &*failure.reason), (FailureKind::Stopped, "stopped from outside"));
        assert_eq!((stopped.counters.points, stopped.counters.steps, stopped.stability), (8, 0, None));
        assert_eq!((stopped.hash, stopped.groups.step_over_limit), (case.hash(), 1.0));
    }
}
