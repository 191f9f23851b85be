//! Runs cases side by side and keeps each record as soon as it is there.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::run_options::{RunOptions, Selected};
use crate::campaign::run_report::{LongestCase, Progress, RunError, RunReport};
use crate::case::Case;
use crate::case::work_estimate::{estimated_work, work_of};
use crate::record::Record;
use crate::record::store::{Found, RecordStore};
use crate::study::check::Study;
use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Work between two words about a case, ns: what a person sees move.
const LONGEST_SILENCE: u64 = 100_000_000;

/// One case to run.
#[derive(Clone, Copy)]
struct Job<'a> {
    case: &'a Case,
    runner: &'a CaseRunner<'a>,
    store: Option<&'a RecordStore>,
}

impl Job<'_> {
    fn as_longest(&self) -> LongestCase {
        LongestCase {
            study: self.runner.study().name.clone(),
            case: self.case.clone(),
            case_seconds: self.runner.study().case_seconds,
        }
    }
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
    let runners: Vec<CaseRunner<'_>> =
        studies.iter().map(|selected| CaseRunner::of(selected.study)).collect();
    let missing = studies.iter().zip(&runners).zip(&found).flat_map(|((selected, runner), cases)| {
        let without = cases.iter().filter(|(_, found)| !matches!(found, Found::Finished(_)));
        without.map(move |(case, _)| Job { case, runner, store: selected.store })
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
    tell(Progress::Planned {
        cases: jobs.len(),
        resumed,
        work: work_of(jobs.iter().map(|job| job.case)),
        jobs: threads.clamp(1, jobs.len().max(1)),
        longest: order.first().map(|index| Box::new(jobs[*index].as_longest())),
    });
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

/// Runs a case and keeps its record. A record that cannot be kept stops every other case too; none where
/// this one was stopped so.
fn run_and_keep(
    Job { case, runner, store }: Job<'_>,
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
        if now > told.get().saturating_add(LONGEST_SILENCE.min(estimate / 200)) {
            tell(Progress::Advanced(now - told.get()));
            told.set(now);
        }
        !stopped.load(Ordering::Relaxed)
    };
    let solved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        runner.run_within(case, store, alone, &observe)
    }));
    tell(Progress::Advanced(estimate - told.get()));
    let record = match solved {
        Ok(Ok(record)) if is_stopped(&record) && stopped.load(Ordering::Relaxed) => return None,
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
        study: runner.study().name.clone(),
        label: case.label(),
        failure: record.status.failure().map(ToString::to_string),
    });
    Some(Ok(record))
}

/// Records of the whole study of a text.
#[cfg(test)]
pub(crate) fn records_of(text: &str) -> Vec<Record> {
    use crate::case::tier::Tier;
    use crate::study::file::StudySource;

    let source = StudySource { name: "study.toml".to_owned(), text: text.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records
}
