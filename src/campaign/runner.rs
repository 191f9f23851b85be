//! Runs cases in parallel and stores each record at once; reports progress, results, and why it stopped.

use crate::campaign::case_runner::{CaseRunner, is_stopped};
use crate::campaign::endless::{EndlessCases, refuse_endless};
use crate::campaign::refinement::{Refinement, ladders};
use crate::campaign::shares::{Shard, shares_of};
use crate::campaign::stop;
use crate::campaign::taken_over::TakenOver;
use crate::case::outcome::Standing;
use crate::case::work_estimate::work_of_seconds;
use crate::case::{Case, Tier};
use crate::record::atomic_file::StoreError;
use crate::record::{Found, Origins, Provenance, Record, RecordStore, Status};
use crate::study::check::Study;
use oedometer_exact::exact_error::ExactError;
use std::cell::Cell;
use std::cmp::Reverse;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::channel;

/// Work between two words about a case, ns: what a person sees move.
const LONGEST_SILENCE: u64 = 100_000_000;

/// How to run a study.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptions {
    /// Cases at the same time.
    pub jobs: usize,
    /// How much of the study.
    pub tier: Tier,
    /// Which share of it.
    pub shard: Option<Shard>,
    /// Whether finished records are taken up.
    pub resume: bool,
    /// Whether those are taken up too that nothing proves to be of the program of now.
    pub keep_unproven: bool,
    /// Whether records are only kept on disk and not in the report: any number of cases takes the same memory.
    pub only_on_disk: bool,
}

impl RunOptions {
    /// A whole tier, every case anew.
    pub fn whole(tier: Tier, jobs: usize) -> Self {
        Self { jobs, tier, shard: None, resume: false, keep_unproven: false, only_on_disk: false }
    }
}

/// A study to run, and where its records are kept.
#[derive(Clone, Copy, Debug)]
pub struct Selected<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its store, whose finished records are taken up where the options say so.
    pub store: Option<&'a RecordStore>,
    /// Whether new records are kept there.
    pub is_kept: bool,
}

/// Runs the cases of a study and stores each record at once. Nothing runs if a case would take longer than a week.
pub fn run_study(
    study: &Study,
    options: &RunOptions,
    store: Option<&RecordStore>,
    tell: &(dyn Fn(Progress) + Sync),
) -> RunReport {
    run_studies(&[Selected { study, store, is_kept: true }], options, tell).pop().unwrap_or_default()
}

/// Runs the cases of several studies side by side, so that the cores stay busy to the end of the last one, and
/// stores each record at once. One report per study.
pub fn run_studies(
    studies: &[Selected<'_>],
    options: &RunOptions,
    tell: &(dyn Fn(Progress) + Sync),
) -> Vec<RunReport> {
    run_studies_thinned(studies, options, &|_, _| {}, tell)
}

/// Runs studies as [`run_studies`] does; `thin` drops from the records in the reports what is not needed. Those on disk stay
/// whole.
pub fn run_studies_thinned(
    studies: &[Selected<'_>],
    options: &RunOptions,
    thin: &(dyn Fn(&Study, &mut Record) + Sync),
    tell: &(dyn Fn(Progress) + Sync),
) -> Vec<RunReport> {
    if let Some(reports) = refused_as_endless(studies, options) {
        return reports;
    }
    let _at_work = stop::begin();
    let selected = cases_of(studies, options);
    let runners: Vec<CaseRunner<'_>> =
        studies.iter().map(|campaign| CaseRunner::of(campaign.study)).collect();
    let of_studies = studies.iter().zip(&runners).zip(selected);
    let mut begun: Vec<Begun<'_>> =
        of_studies.map(|((study, runner), cases)| begun(study, runner, cases, options)).collect();
    let ladders = &longest_first(studies, &begun);
    let threads = options.jobs.clamp(1, ladders.len().max(1));
    let resumed = begun.iter().map(|begun| begun.report.resumed).sum();
    tell(planned(studies, ladders, resumed, threads));
    let (next, stopped) = (&AtomicUsize::new(0), &AtomicBool::new(false));
    let climbing = &Climbing { studies, runners: &runners, alone: threads == 1, stopped, thin, tell };
    let (send, endings) = channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let send = send.clone();
            scope.spawn(move || {
                while let Some(ladder) = ladders.get(next.fetch_add(1, Ordering::Relaxed)) {
                    climbing.climb(ladder, |job, ending| {
                        let _ = send.send((job, ending));
                    });
                }
            });
        }
        drop(send);
        for (job, ending) in endings {
            let Begun { cases, report } = &mut begun[job.study];
            match &ending {
                Ending::Left => report.tally.left += 1,
                Ending::Ended(Ok(record)) => report.tally.add(studies[job.study].study, record),
                Ending::Ended(Err(_)) | Ending::Spared => {}
            }
            let outcome = if let Ending::Ended(outcome) = ending { Some(outcome) } else { None };
            cases[job.place].1 = outcome.filter(|outcome| outcome.is_err() || !options.only_on_disk);
        }
    });
    begun.into_iter().map(|begun| begun.into_report(options)).collect()
}

/// Reports without a record if a study has cases that would take longer than a week: one of them says so, and nothing is run.
fn refused_as_endless(studies: &[Selected<'_>], options: &RunOptions) -> Option<Vec<RunReport>> {
    let refused = |selected: &Selected<'_>| refuse_endless(selected.study, options.tier).err();
    let (place, endless) =
        studies.iter().enumerate().find_map(|(place, selected)| Some((place, refused(selected)?)))?;
    let mut reports: Vec<RunReport> = studies.iter().map(|_| RunReport::default()).collect();
    reports[place].errors.push(endless.into());
    Some(reports)
}

/// Work of jobs by the estimates of their studies, ns.
fn work_of<'a>(studies: &[Selected<'_>], jobs: impl Iterator<Item = &'a Job<'a>>) -> u64 {
    let work = |job: &Job<'_>| work_of_seconds(studies[job.study].study.estimated_seconds(job.case));
    jobs.map(work).fold(0, u64::saturating_add)
}

/// What is left to run, the longest first, so that the last ones to finish are short.
fn longest_first<'a>(studies: &[Selected<'_>], begun: &[Begun<'a>]) -> Vec<Ladder<'a>> {
    let of_study = |(study, begun): (usize, &Begun<'a>)| begun.ladders(study, studies[study].study);
    let mut ladders: Vec<Ladder<'a>> = begun.iter().enumerate().flat_map(of_study).collect();
    ladders.sort_by_cached_key(|ladder| Reverse(work_of(studies, ladder.jobs.iter())));
    ladders
}

/// What a run says of itself before it begins.
fn planned(studies: &[Selected<'_>], ladders: &[Ladder<'_>], resumed: usize, threads: usize) -> Progress {
    let jobs = || ladders.iter().flat_map(|ladder| &ladder.jobs);
    let longest = |job: &Job<'_>| LongestCase {
        study: studies[job.study].study.name.clone(),
        case: job.case.clone(),
        case_seconds: studies[job.study].study.case_seconds,
    };
    Progress::Planned {
        cases: jobs().count(),
        resumed,
        work: work_of(studies, jobs()),
        seconds: jobs().map(|job| studies[job.study].study.estimated_seconds(job.case)).sum(),
        jobs: threads,
        longest: jobs()
            .max_by_key(|job| work_of(studies, std::iter::once(*job)))
            .map(|job| Box::new(longest(job))),
    }
}

/// What every thread knows that runs ladders.
struct Climbing<'a> {
    studies: &'a [Selected<'a>],
    runners: &'a [CaseRunner<'a>],
    /// Whether a case has the machine for itself.
    alone: bool,
    stopped: &'a AtomicBool,
    thin: &'a (dyn Fn(&Study, &mut Record) + Sync),
    tell: &'a (dyn Fn(Progress) + Sync),
}

impl Climbing<'_> {
    /// Runs the cases of a ladder until no finer mesh is wanted.
    fn climb<'a>(&self, ladder: &Ladder<'a>, end: impl Fn(Job<'a>, Ending)) {
        let mut refinement = ladder.begun.clone();
        for job in &ladder.jobs {
            let is_wanted = refinement.as_ref().is_none_or(|known| known.wants(job.case));
            let mut ending = if is_wanted { self.run(*job) } else { self.spare(*job) };
            if let Ending::Ended(Ok(record)) = &mut ending {
                if let Some(known) = &mut refinement {
                    known.add(record);
                }
                (self.thin)(self.studies[job.study].study, record);
            }
            end(*job, ending);
        }
    }

    fn run(&self, job: Job<'_>) -> Ending {
        if self.stopped.load(Ordering::Relaxed) || stop::is_asked() {
            return Ending::Left;
        }
        let selected = &self.studies[job.study];
        let store = selected.store.filter(|_| selected.is_kept);
        run_and_keep(&self.runners[job.study], store, job.case, self.alone, self.stopped, self.tell)
            .map_or(Ending::Left, Ending::Ended)
    }

    fn spare(&self, job: Job<'_>) -> Ending {
        (self.tell)(Progress::Advanced(work_of(self.studies, std::iter::once(&job))));
        Ending::Spared
    }
}

/// The cases of each study that are to be run: its tier, or a share of all of them together.
fn cases_of<'a>(studies: &[Selected<'a>], options: &RunOptions) -> Vec<Vec<&'a Case>> {
    let mut of_studies: Vec<Vec<&Case>> =
        studies.iter().map(|selected| selected.study.cases(options.tier)).collect();
    if let Some(shard) = options.shard {
        let all: Vec<&Case> = of_studies.iter().flatten().copied().collect();
        let mut shares = shares_of(&all, shard.count, shard.parting).into_iter();
        for cases in &mut of_studies {
            cases.retain(|_| shares.next().is_some_and(|share| share == shard.index - 1));
        }
    }
    of_studies
}

/// The record of a case, or the reason why it is missing.
type Outcome = Result<Box<Record>, Box<RunError>>;

/// How a case ended in a run.
enum Ending {
    /// It was not begun, or not ended, for the run was stopped.
    Left,
    /// A coarser mesh of its ladder had reached the tolerance.
    Spared,
    /// With a record, or without one.
    Ended(Outcome),
}

/// Cases that run one after the other: one alone, or the meshes of a method of the benchmark until it reaches the tolerance.
struct Ladder<'a> {
    jobs: Vec<Job<'a>>,
    /// What is known of its meshes before the run; none of a case alone.
    begun: Option<Refinement>,
}

/// One case to run. Small, because a study may have a million.
#[derive(Clone, Copy)]
struct Job<'a> {
    case: &'a Case,
    /// Number of its study.
    study: usize,
    /// Its place among the cases of the study.
    place: usize,
}

/// The cases of a study, each with its outcome where that is held, and what they come to.
struct Begun<'a> {
    cases: Vec<(&'a Case, Option<Outcome>)>,
    report: RunReport,
}

impl<'a> Begun<'a> {
    /// What is left to run, in the order of the study.
    fn ladders(&self, number: usize, study: &Study) -> Vec<Ladder<'a>> {
        let job = |place: usize| Job { case: self.cases[place].0, study: number, place };
        let is_open = |place: &usize| self.cases[*place].1.is_none();
        if !study.is_race {
            let open = (0..self.cases.len()).filter(is_open);
            return open.map(|place| Ladder { jobs: vec![job(place)], begun: None }).collect();
        }
        let cases: Vec<&Case> = self.cases.iter().map(|(case, _)| *case).collect();
        let ladder = |places: Vec<usize>| {
            let known = places.iter().filter_map(|place| self.cases[*place].1.as_ref()?.as_ref().ok());
            let mut begun = Refinement::of(study);
            known.for_each(|record| begun.add(record));
            let jobs = places.into_iter().filter(is_open).map(job).collect();
            Ladder { jobs, begun: Some(begun) }
        };
        ladders(study, &cases).into_iter().map(ladder).filter(|ladder| !ladder.jobs.is_empty()).collect()
    }

    /// The report of a study whose cases have ended.
    fn into_report(self, options: &RunOptions) -> RunReport {
        let mut report = self.report;
        for outcome in self.cases.into_iter().filter_map(|(_, outcome)| outcome) {
            match outcome {
                Ok(_) if options.only_on_disk => {}
                Ok(record) => report.records.push(*record),
                Err(error) => report.errors.push(*error),
            }
        }
        report
    }
}

/// Takes up the records there are; those that are only to be on disk are counted and left out.
fn begun<'a>(
    selected: &Selected<'a>,
    runner: &CaseRunner<'_>,
    cases: Vec<&'a Case>,
    options: &RunOptions,
) -> Begun<'a> {
    let mut report = RunReport::default();
    let Some(store) = selected.store.filter(|_| options.resume) else {
        return Begun { cases: cases.into_iter().map(|case| (case, None)).collect(), report };
    };
    let (mut open, mut taken_up) = (Vec::new(), Vec::new());
    for case in cases {
        let record = match store.found(case) {
            // Whoever keeps nothing judges: a gate asks more of a record than a run that goes on.
            Found::Finished(record) if selected.is_kept || is_of_this_build(&record) => Some(record),
            Found::OfAnotherProgram => {
                report.of_another_program += 1;
                None
            }
            Found::Finished(_) | Found::Nothing => None,
        };
        let standing = record.as_ref().map(|record| runner.standing(record));
        let is_taken = match standing {
            Some(Standing::Proven) => true,
            Some(Standing::Unproven) => options.keep_unproven,
            Some(Standing::Outdated) | None => false,
        };
        report.unproven += usize::from(standing == Some(Standing::Unproven) && !is_taken);
        let Some(record) = record.filter(|_| is_taken) else {
            open.push((case, None));
            continue;
        };
        report.tally.add(selected.study, &record);
        report.taken_over.extend(TakenOver::of(&record, standing == Some(Standing::Proven)));
        taken_up.push(case);
        // A ladder goes on from what its coarser meshes came to.
        if !options.only_on_disk || selected.study.is_race {
            open.push((case, Some(Ok(record))));
        }
    }
    report.resumed = taken_up.len();
    report.origins = store.origins(&taken_up);
    Begun { cases: open, report }
}

/// Whether this build of the program solved or judged a case.
fn is_of_this_build(record: &Record) -> bool {
    record.provenance.is_of_one_build_with(&Provenance::of_this_program())
}

/// Runs a case and keeps its record. A record that cannot be kept stops every other case too; `None` where this one was
/// stopped so.
fn run_and_keep(
    runner: &CaseRunner<'_>,
    store: Option<&RecordStore>,
    case: &Case,
    alone: bool,
    stopped: &AtomicBool,
    tell: &(dyn Fn(Progress) + Sync),
) -> Option<Outcome> {
    let estimate = work_of_seconds(runner.study().estimated_seconds(case));
    let reported = Cell::new(0_u64);
    let observe = |done: u64, expected: u64| {
        let now = u64::try_from(u128::from(estimate) * u128::from(done) / u128::from(expected.max(1)))
            .unwrap_or(estimate)
            .min(estimate);
        if now > reported.get().saturating_add(LONGEST_SILENCE.min(estimate / 200)) {
            tell(Progress::Advanced(now - reported.get()));
            reported.set(now);
        }
        !stopped.load(Ordering::Relaxed) && !stop::is_over()
    };
    let solved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        runner.run_within(case, store, alone, &observe)
    }));
    tell(Progress::Advanced(estimate - reported.get()));
    let record = match solved {
        Ok(Ok(record)) if is_stopped(&record) && (stopped.load(Ordering::Relaxed) || stop::is_over()) => {
            return None;
        }
        Ok(Ok(record)) => record,
        Ok(Err(error)) => return Some(Err(Box::new(RunError::refused(case, error)))),
        Err(_) => return Some(Err(Box::new(RunError::crashed(case)))),
    };
    // What is on disk of a case that was not allowed to begin stays.
    let store = store.filter(|_| !runner.study().holds_back(case));
    if let Some(Err(error)) = store.map(|store| store.write(&record)) {
        // A full disk stays full: what could not be kept is not computed.
        stopped.store(true, Ordering::Relaxed);
        return Some(Err(Box::new(error.into())));
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
    solved("study", text).1
}

/// The study of a text, by a name.
#[cfg(test)]
pub(crate) fn study_of(name: &str, text: &str) -> Study {
    let name = format!("{name}.toml");
    Study::check(&crate::study::file::StudySource { name, text: text.to_owned() }).expect("a sound study")
}

/// The study of a text with its records.
#[cfg(test)]
pub(crate) fn solved(name: &str, text: &str) -> (Study, Vec<Record>) {
    let study = study_of(name, text);
    let records = run_study(&study, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records;
    (study, records)
}

/// The end of a run that failed at a step.
#[cfg(test)]
pub(crate) fn failed_at(step: u64) -> crate::record::Status {
    use oedometer_problem::outcome::{Failure, FailureKind};

    let (kind, reason) = (FailureKind::Unstable, "a test".to_owned());
    crate::record::Status::Failed(Failure { kind, step, time: 1.0, growth: None, reason })
}

/// Progress that the runner reports.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Work ahead, as estimated before the runs.
    Planned {
        /// Cases to be run.
        cases: usize,
        /// Cases taken up from disk.
        resumed: usize,
        /// Time that they will take on one core, as estimated, ns; the largest number where there is more.
        work: u64,
        /// The same, s, however long it is.
        seconds: f64,
        /// Cases at the same time.
        jobs: usize,
        /// The one that will take longest.
        longest: Option<Box<LongestCase>>,
    },
    /// Work done since the last word, in the unit of the plan.
    Advanced(u64),
    /// A case failed.
    Failed {
        /// Its study.
        study: String,
        /// Label of the case.
        label: String,
        /// Failure sentence.
        failure: String,
    },
}

/// The case of a run that will take longest.
#[derive(Clone, Debug, PartialEq)]
pub struct LongestCase {
    /// Its study.
    pub study: String,
    /// What will be run.
    pub case: Case,
    /// Time after which it is ended, s.
    pub case_seconds: f64,
}

/// Why a study could not be run to its end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A result could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Cases would take longer than a week, so nothing was run.
    #[error(transparent)]
    Endless(#[from] EndlessCases),
    /// The numbers of a case are such that nothing can solve it.
    #[error("{label}: {source}")]
    Refused {
        /// Label of the case.
        label: String,
        /// Why it has no record.
        source: ExactError,
    },
    /// A case crashed, which is a fault of this program.
    #[error("{label}: {CRASHED}")]
    Crashed {
        /// Label of the case.
        label: String,
    },
}

/// What is said of a case that crashed.
const CRASHED: &str = "crashed; please report it with the study file";

impl RunError {
    /// The error of a case that its exact solutions refuse.
    pub fn refused(case: &Case, source: ExactError) -> Self {
        Self::Refused { label: case.label(), source }
    }

    /// The error of a case that crashed.
    pub fn crashed(case: &Case) -> Self {
        Self::Crashed { label: case.label() }
    }

    /// The case that has no record, with the reason; `None` if no single case caused it.
    pub fn of_case(&self) -> Option<(&str, String)> {
        match self {
            Self::Store(_) | Self::Endless(_) => None,
            Self::Refused { label, source } => Some((label, source.to_string())),
            Self::Crashed { label } => Some((label, CRASHED.to_owned())),
        }
    }
}

/// What a run of a study gave.
#[derive(Debug, Default)]
pub struct RunReport {
    /// Records in the order of the study; none where they are only on disk.
    pub records: Vec<Record>,
    /// What there is of its cases, wherever their records are.
    pub tally: Tally,
    /// How many of the records were there before.
    pub resumed: usize,
    /// What made those.
    pub origins: Origins,
    /// Those of them that this program did not make.
    pub taken_over: Vec<TakenOver>,
    /// Records of another program that were there, and whose cases were run again.
    pub of_another_program: usize,
    /// Records that nothing proves to be of the program of now, and whose cases were run again.
    pub unproven: usize,
    /// Errors other than failed cases; finished records are kept.
    pub errors: Vec<RunError>,
}

/// Cases of a run by how they ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cases with a record.
    pub recorded: usize,
    /// Those of them that failed.
    pub failed: usize,
    /// Those of them that were skipped: their solver cannot solve them, or was not allowed to start.
    pub skipped: usize,
    /// Those that failed and were not expected to.
    pub unforeseen: usize,
    /// Those of them that were not begun, because their programs were not allowed to start.
    pub held_back: usize,
    /// Cases that were not begun or not ended, for the run was stopped.
    pub left: usize,
}

impl Tally {
    /// Counts the record of a case of a study.
    pub fn add(&mut self, study: &Study, record: &Record) {
        self.recorded += 1;
        if record.status != Status::Ok {
            let is_skipped = record.status.is_skipped();
            self.skipped += usize::from(is_skipped);
            self.failed += usize::from(!is_skipped);
            self.held_back += usize::from(is_skipped && study.holds_back(&record.case));
            self.unforeseen += usize::from(!(is_skipped || study.foresees(record)));
        }
    }

    /// Counts those of another tally too.
    pub fn join(&mut self, other: Self) {
        self.recorded += other.recorded;
        self.failed += other.failed;
        self.skipped += other.skipped;
        self.unforeseen += other.unforeseen;
        self.held_back += other.held_back;
        self.left += other.left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::work_estimate::estimated_work;
    use crate::study::file::StudySource;
    use std::sync::Mutex;

    #[test]
    fn tallies_are_joined_count_by_count() {
        let tally = |by: usize| Tally {
            recorded: 13 * by,
            failed: 7 * by,
            skipped: 11 * by,
            unforeseen: 5 * by,
            held_back: 3 * by,
            left: 2 * by,
        };
        let mut all = tally(1);
        all.join(tally(10));
        assert_eq!(all, tally(11));
    }

    fn study() -> Study {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [1e-3, 0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['explicit', 'implicit']\ncells = [2, 4]\n";
        Study::check(&StudySource { name: "s.toml".to_owned(), text: text.to_owned() }).expect("sound")
    }

    #[test]
    fn the_work_that_is_told_adds_up_to_what_was_planned() {
        let (planned, advanced) = (Mutex::new(0), Mutex::new(0));
        let tell = |progress: Progress| match progress {
            Progress::Planned { work, .. } => *planned.lock().expect("no thread panics") += work,
            Progress::Advanced(work) => *advanced.lock().expect("no thread panics") += work,
            Progress::Failed { .. } => panic!("a case failed"),
        };
        run_study(&study(), &RunOptions::whole(Tier::Full, 2), None, &tell);
        let (planned, advanced) = (planned.into_inner(), advanced.into_inner());
        assert_eq!(planned.expect("a number"), advanced.expect("a number"));
    }

    #[test]
    fn only_a_run_of_one_job_has_the_machine_alone() {
        for jobs in [1, 2, 4] {
            let report = run_study(&study(), &RunOptions::whole(Tier::Full, jobs), None, &|_| {});
            let alone: Vec<bool> = report.records.iter().map(|record| record.wall[0].alone).collect();
            assert_eq!(alone, [jobs == 1; 4], "{jobs} jobs");
        }
    }

    #[test]
    fn shares_of_a_run_are_told_apart_from_the_first_on_and_are_all_of_it_together() {
        use crate::campaign::shares::Parting;
        let study = study();
        let selected = [Selected { study: &study, store: None, is_kept: false }];
        let all = study.cases(Tier::Full);
        for parting in [Parting::Hash, Parting::Cost] {
            let numbers = shares_of(&all, 3, parting);
            for index in 1..=3 {
                let options = RunOptions {
                    shard: Some(Shard { index, count: 3, parting }),
                    ..RunOptions::whole(Tier::Full, 1)
                };
                let found: Vec<String> =
                    cases_of(&selected, &options)[0].iter().map(|case| case.hash()).collect();
                let own = all.iter().zip(&numbers).filter(|(_, share)| **share == index - 1);
                let wanted: Vec<String> = own.map(|(case, _)| case.hash()).collect();
                assert_eq!(found, wanted, "{index} of 3 by {parting:?}");
            }
        }
    }

    #[test]
    fn the_longest_case_begins_first_and_records_that_stay_on_disk_are_thinned_or_left_out() {
        let (study, longest) = (study(), Mutex::new(None));
        let folder = tempfile::TempDir::new().expect("a folder");
        let store = RecordStore::new(folder.path(), "s");
        let selected = [Selected { study: &study, store: Some(&store), is_kept: true }];
        let tell = |progress: Progress| {
            if let Progress::Planned { longest: Some(one), .. } = progress {
                *longest.lock().expect("no thread panics") = Some(one.case);
            }
        };
        let thin = |_: &Study, record: &mut Record| record.snapshots.clear();
        let options = RunOptions::whole(Tier::Full, 1);
        let report = run_studies_thinned(&selected, &options, &thin, &tell).remove(0);
        assert!(report.records.len() == 4 && report.records.iter().all(|record| record.snapshots.is_empty()));
        let most = study.cases(Tier::Full).into_iter().max_by_key(|case| estimated_work(case));
        assert_eq!(longest.lock().expect("no thread panics").as_ref(), most);
        let kept = store.kept(&study.planned[0].case).expect("a record");
        assert_eq!(kept.snapshots.len(), 2, "on disk it is whole");
        for resume in [false, true] {
            let options = RunOptions { resume, only_on_disk: true, ..options.clone() };
            let report = run_studies(&selected, &options, &|_| {}).remove(0);
            let resumed = if resume { 4 } else { 0 };
            assert_eq!((report.records.len(), report.tally.recorded, report.resumed), (0, 4, resumed));
        }
    }
}
