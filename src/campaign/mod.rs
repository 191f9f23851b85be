//! Runs the cases of a study: in parallel, resumable, every finished case on disk at once.

pub mod deadline;

use crate::campaign::deadline::Deadline;
use crate::case::tier::Tier;
use crate::case::{Case, Task};
use crate::elementary;
use crate::exact::exact_error::{ExactError, normal};
use crate::exact::reference::ReferenceKind;
use crate::measure::case_record::{record_of, record_of_critical_step, record_of_stopped_search};
use crate::mpm::critical_step::formula;
use crate::mpm::critical_step::observed::{BISECTIONS, OBSERVED_STEPS, SHARES, Stopped};
use crate::mpm::run::outcome::FailureKind;
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::run::{Kernel, Schedule, TimeStepRule};
use crate::record::origins::Origins;
use crate::record::store::{Found, RecordStore};
use crate::record::whole_file::StoreError;
use crate::record::{Record, Status, WallSample};
use crate::scene::column::column_parameters;
use crate::scene::problem::SceneProblem;
use crate::study::check::Study;
use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Points of the settlement curve of a run.
const HISTORY_POINTS: usize = 48;
/// Steps after which a run at a share of the critical step has shown that it is clean.
const MOST_PROBE_STEPS: u64 = 1_000_000;
/// First time factor of the settlement curve.
const HISTORY_START: f64 = 1e-3;

/// A share `index/count` of the cases, by their hashes: the same whatever machine asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `count`.
    pub index: u64,
    /// How many shards there are.
    pub count: u64,
}

impl Shard {
    /// Whether a case belongs to this shard.
    pub fn holds(&self, case: &Case) -> bool {
        u64::from_str_radix(&case.hash(), 16).unwrap_or(0) % self.count == self.index - 1
    }
}

/// How to run a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// Cases at the same time.
    pub jobs: usize,
    /// How much of the study.
    pub tier: Tier,
    /// Which share of it.
    pub shard: Option<Shard>,
    /// Whether finished records are taken up.
    pub resume: bool,
}

impl RunOptions {
    /// A whole tier, every case anew.
    pub fn whole(tier: Tier, jobs: usize) -> Self {
        Self { jobs, tier, shard: None, resume: false }
    }
}

/// A study to run, and where its records are kept.
#[derive(Clone, Copy, Debug)]
pub struct Selected<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its store; without one nothing is kept.
    pub store: Option<&'a RecordStore>,
}

/// What the runner tells while it works.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Work ahead, in point updates as estimated before the runs.
    Planned {
        /// Cases to be run.
        cases: usize,
        /// Cases taken up from disk.
        resumed: usize,
        /// Estimated point updates; the largest number where there are more.
        work: u64,
    },
    /// Work done since the last word.
    Advanced(u64),
    /// A case is done.
    Finished {
        /// Its study.
        study: String,
        /// Label of the case.
        label: String,
        /// Failure sentence, where it failed.
        failure: Option<String>,
    },
}

/// Why a study could not be run to its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A result could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A case could not be set up.
    #[error("{label}: {source}")]
    Case {
        /// Label of the case.
        label: String,
        /// Why.
        source: ExactError,
    },
    /// A case crashed: a fault of this program.
    #[error("{label}: crashed; please report it with the study file")]
    Crashed {
        /// Label of the case.
        label: String,
    },
}

impl RunError {
    /// The case that has no record, with the reason; none where it is no case's own fault.
    pub fn of_case(&self) -> Option<(&str, String)> {
        match self {
            Self::Store(_) => None,
            Self::Case { label, source } => Some((label, source.to_string())),
            Self::Crashed { label } => {
                Some((label, "crashed; please report it with the study file".to_owned()))
            }
        }
    }
}

/// What a run of a study gave.
#[derive(Debug, Default)]
pub struct RunReport {
    /// Records in the order of the study.
    pub records: Vec<Record>,
    /// How many of them came from disk.
    pub resumed: usize,
    /// What made those.
    pub origins: Origins,
    /// Records of another program that were there, and whose cases were run again.
    pub of_another_program: usize,
    /// What went wrong beside failed cases; finished records are kept all the same.
    pub errors: Vec<RunError>,
}

impl RunReport {
    /// Records of cases that failed.
    pub fn failed(&self) -> impl Iterator<Item = &Record> {
        self.records.iter().filter(|record| record.status != Status::Ok)
    }
}

/// One case to run.
#[derive(Clone, Copy)]
struct Job<'a> {
    case: &'a Case,
    study: &'a Study,
    store: Option<&'a RecordStore>,
}

/// Runs the cases of a study and keeps each record as soon as it is there.
pub fn run_study(
    study: &Study,
    options: &RunOptions,
    store: Option<&RecordStore>,
    tell: &(dyn Fn(Progress) + Sync),
) -> RunReport {
    run_studies(&[Selected { study, store }], options, tell).pop().unwrap_or_default()
}

/// Runs the cases of several studies side by side, so that the cores stay busy to the end of the
/// last one, and keeps each record as soon as it is there. One report a study.
pub fn run_studies(
    studies: &[Selected<'_>],
    options: &RunOptions,
    tell: &(dyn Fn(Progress) + Sync),
) -> Vec<RunReport> {
    let found: Vec<Vec<(&Case, Found)>> =
        studies.iter().map(|selected| cases_with_records(selected, options)).collect();
    let missing = studies.iter().zip(&found).flat_map(|(selected, cases)| {
        let without = cases.iter().filter(|(_, found)| !matches!(found, Found::Finished(_)));
        without.map(|(case, _)| Job { case, study: selected.study, store: selected.store })
    });
    let jobs: Vec<Job<'_>> = missing.collect();
    let cases: usize = found.iter().map(Vec::len).sum();
    let mut results = run_jobs(&jobs, cases - jobs.len(), options.jobs, tell).into_iter();
    found.into_iter().map(|cases| report_of(cases, &mut results)).collect()
}

/// The cases of a study that are to be run, with the records there are of them already.
fn cases_with_records<'a>(selected: &Selected<'a>, options: &RunOptions) -> Vec<(&'a Case, Found)> {
    let store = selected.store.filter(|_| options.resume);
    let cases = selected.study.cases(options.tier).into_iter();
    cases
        .filter(|case| options.shard.is_none_or(|shard| shard.holds(case)))
        .map(|case| (case, store.map_or(Found::Nothing, |store| store.found(case))))
        .collect()
}

/// The report of a study: records from disk, and for the other cases the next results.
fn report_of(
    cases: Vec<(&Case, Found)>,
    results: &mut impl Iterator<Item = Option<Result<Record, RunError>>>,
) -> RunReport {
    let mut report = RunReport::default();
    for (_, found) in cases {
        if let Found::Finished(record) = found {
            report.resumed += 1;
            report.origins.add(&record.provenance);
            report.records.push(*record);
            continue;
        }
        report.of_another_program += usize::from(found == Found::OfAnotherProgram);
        match results.next().flatten() {
            Some(Ok(record)) => report.records.push(record),
            Some(Err(error)) => report.errors.push(error),
            None => {}
        }
    }
    report
}

/// Runs jobs, the longest first so that the last ones to finish are short; results in the order of
/// the jobs. The first result that cannot be kept ends them all, and a job without a result is one that had
/// not come to its end by then.
fn run_jobs(
    jobs: &[Job<'_>],
    resumed: usize,
    threads: usize,
    tell: &(dyn Fn(Progress) + Sync),
) -> Vec<Option<Result<Record, RunError>>> {
    let mut order: Vec<usize> = (0..jobs.len()).collect();
    order.sort_by_key(|index| std::cmp::Reverse(estimated_work(jobs[*index].case)));
    tell(Progress::Planned { cases: jobs.len(), resumed, work: work_of(jobs.iter().map(|job| job.case)) });
    let results: Vec<Mutex<Option<Result<Record, RunError>>>> =
        jobs.iter().map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let threads = threads.clamp(1, jobs.len().max(1));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let result = run_and_keep(jobs[*index], threads == 1, &stopped, tell);
                    if let Ok(mut slot) = results[*index].lock() {
                        *slot = result;
                    }
                    if stopped.load(Ordering::Relaxed) {
                        break;
                    }
                }
            });
        }
    });
    results.into_iter().map(|slot| slot.into_inner().ok().flatten()).collect()
}

/// Work of cases together: the largest number where there is more.
fn work_of<'a>(cases: impl Iterator<Item = &'a Case>) -> u64 {
    cases.fold(0, |sum, case| sum.saturating_add(estimated_work(case)))
}

/// Point updates, weighted with what one costs: operators that follow the points are built anew in
/// every step.
fn estimated_work(case: &Case) -> u64 {
    let follows = case.method.configuration_or(case.scene.configuration()).deforms();
    estimated_updates(case).saturating_mul(if follows { 30 } else { 1 })
}

/// Runs a case and keeps its record. A record that cannot be kept stops every other case too; none where
/// this one was stopped so.
fn run_and_keep(
    Job { case, study, store }: Job<'_>,
    alone: bool,
    stopped: &AtomicBool,
    tell: &(dyn Fn(Progress) + Sync),
) -> Option<Result<Record, RunError>> {
    let estimate = estimated_work(case);
    let told = Cell::new(0_u64);
    let observe = |done: u64, expected: u64| {
        let now = u64::try_from(u128::from(estimate) * u128::from(done) / u128::from(expected.max(1)))
            .unwrap_or(estimate)
            .min(estimate);
        if now > told.get().saturating_add(estimate / 200) {
            tell(Progress::Advanced(now - told.get()));
            told.set(now);
        }
        !stopped.load(Ordering::Relaxed)
    };
    let solved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        run_case_within(study.case_seconds, case, &study.references, Kernel::Fastest, alone, &observe)
    }));
    tell(Progress::Advanced(estimate - told.get()));
    let record = match solved {
        Ok(Ok(record)) if record.status.is_late() && stopped.load(Ordering::Relaxed) => return None,
        Ok(Ok(record)) => record,
        Ok(Err(source)) => return Some(Err(RunError::Case { label: case.label(), source })),
        Err(_) => return Some(Err(RunError::Crashed { label: case.label() })),
    };
    if let Some(Err(error)) = store.map(|store| store.write(&record)) {
        // A full disk stays full: what could not be kept is not computed.
        stopped.store(true, Ordering::Relaxed);
        return Some(Err(error.into()));
    }
    tell(Progress::Finished {
        study: study.name.clone(),
        label: case.label(),
        failure: match &record.status {
            Status::Ok => None,
            Status::Failed(failure) => Some(failure.to_string()),
        },
    });
    Some(Ok(record))
}

/// Runs one case for so many seconds at most: what takes longer has failed, by that name.
///
/// # Errors
/// When the exact solutions refuse the case's parameters.
pub fn run_case_within(
    seconds: f64,
    case: &Case,
    references: &[ReferenceKind],
    kernel: Kernel,
    alone: bool,
    observe: &dyn Fn(u64, u64) -> bool,
) -> Result<Record, ExactError> {
    let deadline = Deadline::after(seconds);
    let in_time = |done: u64, expected: u64| observe(done, expected) && !deadline.is_over();
    Ok(named_if_late(run_case(case, references, kernel, alone, &in_time)?, seconds))
}

/// The record of a case that was stopped because its time was over says so.
fn named_if_late(mut record: Record, seconds: f64) -> Record {
    if let Status::Failed(failure) = &mut record.status
        && failure.kind == FailureKind::Stopped
    {
        failure.kind = FailureKind::TimedOut;
        failure.reason = format!("it took longer than the {seconds} s that its study allows a case");
    }
    record
}

/// Runs one case; `alone` says whether nothing else competes for the cores meanwhile.
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
    plausible(case)?;
    if case.task == Task::Stability {
        return stability_of(case, observe);
    }
    let problem = problem_of(case)?;
    let schedule = schedule_of(case, kernel);
    let start = Instant::now();
    let outcome = problem.run(&schedule, observe);
    let seconds = start.elapsed().as_secs_f64();
    enter(Phase::Assessment);
    let mut record = record_of(case, references, outcome)?;
    record.wall.push(WallSample { seconds, alone });
    Ok(record)
}

fn problem_of(case: &Case) -> Result<SceneProblem, ExactError> {
    let Case { scene, column, material, method, cells, points_per_cell, .. } = case;
    SceneProblem::new(*scene, column, material, *method, *cells, *points_per_cell)
}

/// Refuses numbers that no run can go on from, before anything is computed and whoever computes it.
fn plausible(case: &Case) -> Result<(), ExactError> {
    let parameters = column_parameters(&case.column, &case.material);
    parameters.validate()?;
    normal(
        "critical time step",
        formula::combined_limit(&case.material, case.cell_size(), case.settings.drag),
    )?;
    for factor in case.time_factors.iter().filter(|factor| **factor > 0.0) {
        normal("time of an output", parameters.time(*factor))?;
    }
    Ok(())
}

/// Predicts and observes the critical step of a case.
fn stability_of(case: &Case, observe: &dyn Fn(u64, u64) -> bool) -> Result<Record, ExactError> {
    let problem = problem_of(case)?;
    let end = case.time_factors.last().map_or(0.0, |factor| factor * case.seconds_per_time_factor());
    // Of how many steps a search will be is not known: its work is told at its end.
    let go_on = |_, _| observe(0, 1);
    Ok(match problem.critical_step(&case.settings, end, MOST_PROBE_STEPS, &go_on) {
        Ok(found) => record_of_critical_step(case, found),
        Err(Stopped) => record_of_stopped_search(case),
    })
}

fn schedule_of(case: &Case, kernel: Kernel) -> Schedule {
    let parameters = column_parameters(&case.column, &case.material);
    let end = case.time_factors.last().copied().unwrap_or(0.0);
    let history = if end > HISTORY_START {
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
        rule: case.time_step,
        settings: case.settings,
        kernel,
        integrator: case.integrator,
        critical_step: None,
        formulation: case.formulation,
    }
}

/// Point updates that a case will take, by formula and before any operator is built.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, it is an estimate")]
pub fn estimated_updates(case: &Case) -> u64 {
    let parameters = column_parameters(&case.column, &case.material);
    let end = parameters.time(case.time_factors.last().copied().unwrap_or(0.0));
    let limit = formula::combined_limit(&case.material, case.cell_size(), case.settings.drag);
    let step = match case.time_step {
        TimeStepRule::Stable(share) => 1.5 * share * limit,
        TimeStepRule::Courant(share) => {
            share * case.cell_size() / formula::fastest_wave_speed(&case.material, case.material.porosity)
        }
        TimeStepRule::Seconds(seconds) => seconds,
        TimeStepRule::Tolerance(tolerance) => end * tolerance.sqrt() / 20.0,
        TimeStepRule::Growth(growth) => {
            let first = parameters.time(elementary::powi(case.cells as f64, -2));
            growth * end / (2.0 + elementary::ln((end / first).max(1.0)))
        }
    };
    let steps = match case.task {
        Task::Solve => end / step,
        Task::Stability => {
            // Runs of a fixed length bracket the limit; those beside it end with the scene, or before.
            let observed = OBSERVED_STEPS as f64;
            f64::from(BISECTIONS) * observed
                + SHARES.len() as f64 * (end / step).clamp(observed, MOST_PROBE_STEPS as f64)
        }
    };
    (steps * case.expected_points() as f64).max(1.0) as u64
}

/// What timing a study took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TimingReport {
    /// Runs made for their wall time.
    pub runs: usize,
}

/// Repeats of a case that takes long end here: their spread is small, and they would make the study
/// wait for what it knows.
const REPEATS_OF_LONG_CASES: usize = 3;
/// Seconds beyond which the repeats of a case took long.
const LONG_REPEATS: f64 = 0.25;

/// Whether the wall time of a case is not known yet as well as its study asks.
fn wants_timing(record: &Record, repeats: usize) -> bool {
    let wall = record.wall_alone();
    let is_long = wall.iter().sum::<f64>() > LONG_REPEATS;
    let enough = if is_long { repeats.min(REPEATS_OF_LONG_CASES) } else { repeats };
    record.status == Status::Ok && wall.len() < enough
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
) -> Result<TimingReport, RunError> {
    let mut report = TimingReport::default();
    for _ in 0..study.timing_repeats {
        for record in &mut *records {
            if !wants_timing(record, study.timing_repeats) {
                continue;
            }
            let timed = run_case(&record.case, &study.references, Kernel::Fastest, true, &|_, _| true)
                .map_err(|source| RunError::Case { label: record.case.label(), source })?;
            record.wall.extend(timed.wall);
            report.runs += 1;
            tell(Progress::Advanced(estimated_work(&record.case)));
        }
    }
    if let Some(store) = store.filter(|_| report.runs > 0) {
        for record in &*records {
            store.write_wall(record)?;
        }
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::file::StudySource;

    fn cases(head: &str, sweep: &str) -> Vec<Case> {
        let text =
            format!("title = \"t\"\nscene = \"terzaghi\"\n{head}\n[[sweep]]\nmethod = [\"MPM\"]\n{sweep}\n");
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
        study.cases(Tier::Full).into_iter().cloned().collect()
    }

    #[test]
    fn work_beyond_counting_stays_the_largest_number() {
        let endless = cases("", "cells = [3, 4]\ntime_step = [{ seconds = 1e-300 }]");
        assert_eq!(endless.len(), 2);
        assert!(endless.iter().all(|case| estimated_work(case) == u64::MAX));
        assert_eq!(work_of(endless.iter()), u64::MAX);
        let short = cases("", "cells = [3, 4]");
        assert_eq!(work_of(short.iter()), estimated_work(&short[0]) + estimated_work(&short[1]));
    }

    #[test]
    fn the_work_of_a_critical_step_has_an_end() {
        let endless = cases("task = \"stability\"", "cells = [8]\nhydraulic_conductivity = [1e-300]");
        let most = (u64::from(BISECTIONS) * OBSERVED_STEPS + 2 * MOST_PROBE_STEPS) * 16;
        assert_eq!(estimated_updates(&endless[0]), most);
        let short = cases("task = \"stability\"\n[output]\ntime_factors = [1e-9]", "cells = [8]");
        assert_eq!(estimated_updates(&short[0]), (u64::from(BISECTIONS) + 2) * OBSERVED_STEPS * 16);
    }
}
