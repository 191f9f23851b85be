//! Runs cases side by side and keeps each record as soon as it is there.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::run_options::{RunOptions, Selected};
use crate::campaign::run_report::{LongestCase, Progress, RunError, RunReport, Tally};
use crate::campaign::shares::shares_of;
use crate::campaign::stop;
use crate::case::Case;
use crate::case::work_estimate::{estimated_work, work_of};
use crate::record::Record;
use crate::record::store::{Found, RecordStore, Standing};
use crate::study::check::Study;
use std::cell::Cell;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Work between two words about a case, ns: what a person sees move.
const LONGEST_SILENCE: u64 = 100_000_000;

/// One case to run; of a million of them it is no more than that.
#[derive(Clone, Copy)]
struct Job<'a> {
    case: &'a Case,
    /// Number of its study.
    number: usize,
}

/// Who runs the cases of a study, and where their records are kept.
struct Desk<'a> {
    runner: CaseRunner<'a>,
    store: Option<&'a RecordStore>,
}

impl<'a> Desk<'a> {
    fn of(selected: &Selected<'a>) -> Self {
        Self { runner: CaseRunner::of(selected.study), store: selected.store }
    }

    fn longest(&self, case: &Case) -> LongestCase {
        let study = self.runner.study();
        LongestCase { study: study.name.clone(), case: case.clone(), case_seconds: study.case_seconds }
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
    run_studies_thinned(studies, options, &|_, _| {}, tell)
}

/// The same; `thin` drops what is not to be held in the reports of the record of a study. What is on disk is whole.
pub fn run_studies_thinned(
    studies: &[Selected<'_>],
    options: &RunOptions,
    thin: &(dyn Fn(&Study, &mut Record) + Sync),
    tell: &(dyn Fn(Progress) + Sync),
) -> Vec<RunReport> {
    let selected = cases_of(studies, options);
    let found: Vec<Begun<'_>> =
        studies.iter().zip(selected).map(|(study, cases)| begun(study, cases, options)).collect();
    let desks: Vec<Desk<'_>> = studies.iter().map(Desk::of).collect();
    let missing = |begun: &Begun<'_>| begun.cases.iter().filter(|(_, found)| !found.is_finished()).count();
    let mut jobs: Vec<Job<'_>> = Vec::with_capacity(found.iter().map(missing).sum());
    for (number, begun) in found.iter().enumerate() {
        let without = begun.cases.iter().filter(|(_, found)| !found.is_finished());
        jobs.extend(without.map(|(case, _)| Job { case, number }));
    }
    let resumed = found.iter().map(|begun| begun.report.resumed).sum();
    let mut gathered = Gathered::of(studies.len());
    gathered.only_on_disk = options.only_on_disk;
    let mut gathered = run_jobs(&desks, &jobs, resumed, options.jobs, gathered, &Listener { thin, tell });
    gathered.ended.sort_by_key(|(place, _)| *place);
    let mut results = gathered.ended.into_iter().peekable();
    let mut place = 0;
    let reports = found.into_iter().zip(gathered.tallies);
    reports
        .map(|(begun, tally)| {
            let mut report = begun.report;
            report.tally.join(tally);
            for (_, found) in begun.cases {
                if let Found::Finished(record) = found {
                    report.records.push(*record);
                    continue;
                }
                report.of_another_program += usize::from(found == Found::OfAnotherProgram);
                match results.next_if(|(at, _)| *at == place).map(|(_, result)| result) {
                    Some(Ok(record)) => report.records.push(*record),
                    Some(Err(error)) => report.errors.push(error),
                    None => {}
                }
                place += 1;
            }
            report
        })
        .collect()
}

/// The cases of each study that are to be run: its tier, or a share of all of them together.
fn cases_of<'a>(studies: &[Selected<'a>], options: &RunOptions) -> Vec<Vec<&'a Case>> {
    let mut of_studies: Vec<Vec<&Case>> =
        studies.iter().map(|selected| selected.study.cases(options.tier)).collect();
    if let Some(shard) = options.shard {
        let all: Vec<&Case> = of_studies.iter().flatten().copied().collect();
        let mut shares = shares_of(&all, shard.count, shard.parting, &options.costs).into_iter();
        for cases in &mut of_studies {
            cases.retain(|_| shares.next().is_some_and(|share| share == shard.index - 1));
        }
    }
    of_studies
}

/// The cases of a study with the records there are of them already, and what these come to.
struct Begun<'a> {
    cases: Vec<(&'a Case, Found)>,
    report: RunReport,
}

fn begun<'a>(selected: &Selected<'a>, cases: Vec<&'a Case>, options: &RunOptions) -> Begun<'a> {
    let mut begun = Begun { cases: Vec::new(), report: RunReport::default() };
    let Some(store) = selected.store.filter(|_| options.resume) else {
        begun.cases = cases.into_iter().map(|case| (case, Found::Nothing)).collect();
        return begun;
    };
    let report = &mut begun.report;
    let mut by_build: HashMap<u64, (&Case, usize)> = HashMap::new();
    for case in cases {
        let found = if options.only_on_disk {
            match store.standing(case) {
                Standing::Ok { build } => {
                    by_build.entry(build).or_insert((case, 0)).1 += 1;
                    report.resumed += 1;
                    report.tally.recorded += 1;
                    continue;
                }
                Standing::Read(record) => Found::Finished(record),
                Standing::OfAnotherProgram => Found::OfAnotherProgram,
                Standing::Nothing => Found::Nothing,
            }
        } else {
            store.found(case)
        };
        if let Found::Finished(record) = &found {
            report.resumed += 1;
            report.origins.add(&record.provenance);
            report.tally.add(selected.study, record);
            if options.only_on_disk {
                continue;
            }
        }
        begun.cases.push((case, found));
    }
    for (case, records) in by_build.into_values() {
        if let Some(origin) = store.origin(case) {
            report.origins.add_many(&origin, records);
        }
    }
    begun
}

/// What jobs came to: the results that are held, each with the place of its job, and a tally a study.
#[derive(Default)]
struct Gathered {
    only_on_disk: bool,
    ended: Vec<(usize, Result<Box<Record>, RunError>)>,
    tallies: Vec<Tally>,
}

impl Gathered {
    fn of(studies: usize) -> Self {
        Self { tallies: vec![Tally::default(); studies], ..Self::default() }
    }

    fn take(
        &mut self,
        place: usize,
        job: Job<'_>,
        study: &Study,
        result: Option<Result<Box<Record>, RunError>>,
    ) {
        let tally = &mut self.tallies[job.number];
        match result {
            None => tally.left += 1,
            Some(Err(error)) => self.ended.push((place, Err(error))),
            Some(Ok(record)) => {
                tally.add(study, &record);
                if !self.only_on_disk {
                    self.ended.push((place, Ok(record)));
                }
            }
        }
    }
}

/// Who hears of the cases as they run.
struct Listener<'a> {
    thin: &'a (dyn Fn(&Study, &mut Record) + Sync),
    tell: &'a (dyn Fn(Progress) + Sync),
}

/// Runs jobs, the longest first so that the last ones to finish are short. The first result that cannot be kept ends
/// them all, and so does a signal; a job without a result is one that had not come to its end by then.
fn run_jobs(
    desks: &[Desk<'_>],
    jobs: &[Job<'_>],
    resumed: usize,
    threads: usize,
    gathered: Gathered,
    Listener { thin, tell }: &Listener<'_>,
) -> Gathered {
    let mut order: Vec<usize> = (0..jobs.len()).collect();
    order.sort_by_cached_key(|index| std::cmp::Reverse(estimated_work(jobs[*index].case)));
    let threads = threads.clamp(1, jobs.len().max(1));
    tell(Progress::Planned {
        cases: jobs.len(),
        resumed,
        work: work_of(jobs.iter().map(|job| job.case)),
        jobs: threads,
        longest: order.first().map(|index| Box::new(desks[jobs[*index].number].longest(jobs[*index].case))),
    });
    let gathered = Mutex::new(gathered);
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let job = jobs[*index];
                    let desk = &desks[job.number];
                    let is_over = stopped.load(Ordering::Relaxed) || stop::is_asked();
                    let mut result = if is_over {
                        None
                    } else {
                        run_and_keep(desk, job.case, threads == 1, &stopped, tell)
                    };
                    if let Some(Ok(record)) = &mut result {
                        thin(desk.runner.study(), record);
                    }
                    let mut gathered = gathered.lock().unwrap_or_else(PoisonError::into_inner);
                    gathered.take(*index, job, desk.runner.study(), result);
                }
            });
        }
    });
    gathered.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Runs a case and keeps its record. A record that cannot be kept stops every other case too; none where
/// this one was stopped so.
fn run_and_keep(
    Desk { runner, store }: &Desk<'_>,
    case: &Case,
    alone: bool,
    stopped: &AtomicBool,
    tell: &(dyn Fn(Progress) + Sync),
) -> Option<Result<Box<Record>, RunError>> {
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
        !stopped.load(Ordering::Relaxed) && !stop::is_over()
    };
    let solved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        runner.run_within(case, *store, alone, &observe)
    }));
    tell(Progress::Advanced(estimate - told.get()));
    let record = match solved {
        Ok(Ok(record)) if is_stopped(&record) && (stopped.load(Ordering::Relaxed) || stop::is_over()) => {
            return None;
        }
        Ok(Ok(record)) => record,
        Ok(Err(source)) => return Some(Err(RunError::Case { label: case.label(), source })),
        Err(_) => return Some(Err(RunError::Crashed { label: case.label() })),
    };
    // What is on disk of a case that was not allowed to begin stays.
    let store = store.filter(|_| !runner.study().holds_back(case));
    if let Some(Err(error)) = store.map(|store| store.write(&record)) {
        // A full disk stays full: what could not be kept is not computed.
        stopped.store(true, Ordering::Relaxed);
        return Some(Err(error.into()));
    }
    // One sentence tells of all that were not allowed to begin.
    if let Some(failure) = record.status.failure().filter(|_| !runner.study().holds_back(case)) {
        let study = runner.study().name.clone();
        tell(Progress::Failed { study, label: case.label(), failure: failure.to_string() });
    }
    Some(Ok(Box::new(record)))
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
