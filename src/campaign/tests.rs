//! Runs of studies whole: what is taken up, begun, kept, told, counted and timed.

use crate::campaign::case_run::{ThisProgram, run_case};
use crate::campaign::case_runner::{CaseRunner, time_study};
use crate::campaign::runner::{
    Progress, RunError, RunOptions, RunReport, Selected, Tally, run_studies, run_study,
};
use crate::campaign::shares::{Parting, shares_of};
use crate::case::outcome::{Course, Solver};
use crate::case::work_estimate::estimated_work;
use crate::case::{Case, Task, Tier};
use crate::record::atomic_file::StoreError;
use crate::record::{Provenance, Record, RecordStore, Status, WallSample};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_exact::ExactError;
use oedometer_mpm::run::Kernel;
use oedometer_problem::outcome::{Failure, FailureKind};
use oedometer_scenes::TERZAGHI;
use std::path::Path;
use std::sync::Mutex;

fn study(name: &str, rest: &str) -> Study {
    let text = format!("title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n{rest}");
    Study::check(&StudySource { name: name.to_owned(), text }).expect("sound")
}

/// A sweep of backward Euler over cells.
fn sweep(cells: &str) -> String {
    format!("[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = {cells}\n")
}

/// A study whose one case is a shell script's, which may be started.
fn scripted(folder: &Path, script: &str, more: &str) -> Study {
    let name = folder.join("theirs.toml").display().to_string();
    let rest = format!(
        "[[solver]]\nname = 'theirs'\ncommand = ['sh', '-c', '{script}']\nresult = '{{out}}/r.csv'\n{more}\
         [[sweep]]\nmethod = ['theirs']\ncells = [2]\n"
    );
    Study { may_start_solvers: true, ..study(&name, &rest) }
}

fn store(folder: &Path, study: &Study) -> RecordStore {
    RecordStore::new(folder, &study.name)
}

fn hashes<'a>(cases: impl IntoIterator<Item = &'a Case>) -> Vec<String> {
    cases.into_iter().map(Case::hash).collect()
}

/// Runs a study, and what was told of it.
fn told(selected: &[Selected<'_>], options: &RunOptions) -> (Vec<RunReport>, Vec<Progress>) {
    let all = Mutex::new(Vec::new());
    let reports = run_studies(selected, options, &|one| all.lock().expect("no thread panics").push(one));
    (reports, all.into_inner().expect("no thread panics"))
}

#[test]
fn studies_side_by_side_keep_their_records_in_order_and_the_plan_is_of_them_all() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let one = Study { case_seconds: 70.0, ..study("one.toml", &sweep("[2, 8, 3]")) };
    let other = Study { case_seconds: 80.0, ..study("other.toml", &sweep("[5, 16]")) };
    let stores = [store(folder.path(), &one), store(folder.path(), &other)];
    let selected = |kept: [bool; 2]| {
        let of = |place: usize, study| Selected { study, store: Some(&stores[place]), is_kept: kept[place] };
        [of(0, &one), of(1, &other)]
    };
    let all: Vec<&Case> = one.cases(Tier::Full).into_iter().chain(other.cases(Tier::Full)).collect();
    let longest = all.iter().find(|case| case.cells == 16).expect("a case");
    // Jobs that are asked for, what is kept and taken up; then cases of the plan, those taken up, and jobs.
    for (jobs, kept, resume, planned) in [
        (0, [true, false], false, (5, 0, 1)),
        (9, [true, true], true, (2, 3, 2)),
        (2, [true, true], true, (0, 5, 1)),
        (9, [true, true], false, (5, 0, 5)),
    ] {
        let options = RunOptions { resume, ..RunOptions::whole(Tier::Full, jobs) };
        let (reports, progress) = told(&selected(kept), &options);
        for (report, study) in reports.iter().zip([&one, &other]) {
            let found = hashes(report.records.iter().map(|record| &record.case));
            assert_eq!(found, hashes(study.cases(Tier::Full)));
            let recorded = found.len();
            assert_eq!((report.tally, report.errors.len()), (Tally { recorded, ..Tally::default() }, 0));
        }
        let Progress::Planned { cases, resumed, work, jobs, longest: found, seconds } = &progress[0] else {
            panic!("{progress:?}")
        };
        assert_eq!((*cases, *resumed, *jobs), planned);
        assert_eq!(reports.iter().map(|report| report.resumed).sum::<usize>(), planned.1);
        let of_plan = &all[5 - cases..];
        assert_eq!(*work, of_plan.iter().map(|case| estimated_work(case)).fold(0, u64::saturating_add));
        let sum: f64 = of_plan.iter().map(|case| crate::case::work_estimate::estimated_seconds(case)).sum();
        assert!((seconds - sum).abs() <= 1e-12 * sum, "{seconds} {sum}");
        let found = found.as_ref().map(|one| (one.study.as_str(), one.case.hash(), one.case_seconds));
        assert_eq!(found, (*cases > 0).then(|| ("other", longest.hash(), 80.0)));
        let on_disk = stores.each_ref().map(|store| store.hashes().len());
        assert_eq!(on_disk, [3, if kept[1] { 2 } else { 0 }], "only what is to be kept is");
    }
}

/// What is changed in where a record comes from.
type Change = fn(&mut Provenance);

#[test]
fn whoever_judges_takes_up_fewer_records_than_whoever_goes_on() {
    let study = study("s.toml", &sweep("[2]"));
    let whole = RunOptions::whole(Tier::Full, 1);
    let record = run_study(&study, &whole, None, &|_| {}).records.remove(0);
    let changes: [(&str, Change); 4] = [
        ("nothing", |_| ()),
        ("commit", |one| one.commit.push('1')),
        ("compiler", |one| one.compiler.push('1')),
        ("sources", |one| one.sources.push('1')),
    ];
    for (what, change) in changes {
        for (is_kept, resume) in [(true, true), (false, true), (true, false), (false, false)] {
            let folder = tempfile::TempDir::new().expect("a folder");
            let store = store(folder.path(), &study);
            let mut before = record.clone();
            change(&mut before.provenance);
            store.write(&before).expect("written");
            let selected = Selected { study: &study, store: Some(&store), is_kept };
            let report = run_studies(&[selected], &RunOptions { resume, ..whole.clone() }, &|_| {}).remove(0);
            let is_taken = resume && what != "sources" && (is_kept || what != "compiler");
            let others = resume && what == "sources";
            let found =
                (report.resumed, report.of_another_program, report.tally.recorded, report.records.len());
            assert_eq!(
                found,
                (usize::from(is_taken), usize::from(others), 1, 1),
                "{what} {is_kept} {resume}"
            );
            assert_eq!(report.origins.main(), is_taken.then_some(&before.provenance), "{what}");
            assert_eq!(report.records[0].wall.is_empty(), is_taken && what == "compiler", "{what}");
            let after = &store.kept(&record.case).expect("a record").provenance;
            let wanted = if is_taken || !is_kept { &before } else { &record };
            assert_eq!(after, &wanted.provenance, "{what} {is_kept} {resume}");
        }
    }
}

#[test]
fn a_result_that_is_there_already_is_read_anew_by_whoever_judges() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("r.csv"), "t,y,p,u_y\n8.175,0,0.9,0\n8.175,0.5,0.6,-1e-7\n8.175,1,0,-3e-7\n")
        .expect("a file");
    let units = "[units]\nstress = 'Pa'\n[sign]\np = 'compression-positive'\nu_y = 'up'\n";
    std::fs::write(at("m.toml"), units).expect("a file");
    let rest = "[[result]]\nname = 'theirs'\nfiles = ['r.csv']\nmapping = 'm.toml'\ncells = [2]\n";
    let study = study(&at("s.toml").display().to_string(), rest);
    let store = store(folder.path(), &study);
    for (is_kept, resume) in [(true, false), (true, true), (false, true)] {
        let options = RunOptions { resume, ..RunOptions::whole(Tier::Full, 1) };
        let report =
            run_studies(&[Selected { study: &study, store: Some(&store), is_kept }], &options, &|_| {});
        assert_eq!(report[0].records[0].status, Status::Ok);
        assert_eq!(report[0].resumed, 0, "{is_kept} {resume}");
    }
}

#[test]
fn a_tally_tells_failures_that_somebody_foresaw_and_programs_that_nobody_allowed() {
    use FailureKind::{Failed, LeftGrid, Skipped, Unstable};
    let own =
        study("own.toml", &format!("{}[[expect_case]]\ncells = 2\nstatus = 'unstable'\n", sweep("[2, 4]")));
    let folder = tempfile::TempDir::new().expect("a folder");
    let allowed = scripted(folder.path(), "exit 77", "");
    let held = Study { may_start_solvers: false, ..allowed.clone() };
    let some = run_study(&own, &RunOptions::whole(Tier::Full, 1), None, &|_| {}).records;
    let of = |study: &Study, place: usize, kind: Option<FailureKind>| {
        let status =
            kind.map_or(Status::Ok, |kind| Status::Failed(Failure::of_attached(kind, String::new())));
        let mut tally = Tally::default();
        tally.add(study, &Record { case: study.planned[place].case.clone(), status, ..some[0].clone() });
        [tally.recorded, tally.failed, tally.skipped, tally.unforeseen, tally.held_back, tally.left]
    };
    for (study, place, kind, wanted) in [
        (&own, 0, None, [1, 0, 0, 0, 0, 0]),
        (&own, 0, Some(Unstable), [1, 1, 0, 0, 0, 0]),
        (&own, 0, Some(LeftGrid), [1, 1, 0, 1, 0, 0]),
        (&own, 1, Some(Unstable), [1, 1, 0, 1, 0, 0]),
        (&allowed, 0, Some(Skipped), [1, 0, 1, 0, 0, 0]),
        (&allowed, 0, Some(Failed), [1, 1, 0, 1, 0, 0]),
        (&held, 0, Some(Skipped), [1, 0, 1, 0, 1, 0]),
        (&held, 0, Some(Failed), [1, 1, 0, 1, 0, 0]),
        (&held, 0, None, [1, 0, 0, 0, 0, 0]),
    ] {
        assert_eq!(of(study, place, kind), wanted, "{} {place} {kind:?}", study.name);
    }
}

#[test]
#[cfg(unix)]
fn a_failure_is_told_with_its_study_and_kept_and_of_what_may_not_begin_neither() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let allowed = scripted(folder.path(), "echo oh no; exit 3", "");
    let held = Study { may_start_solvers: false, ..allowed.clone() };
    let store = store(&folder.path().join("out"), &allowed);
    for (study, kept) in [(&held, 0), (&allowed, 1), (&held, 1)] {
        let selected = Selected { study, store: Some(&store), is_kept: true };
        let (reports, progress) = told(&[selected], &RunOptions::whole(Tier::Full, 1));
        let failed: Vec<&Progress> =
            progress.iter().filter(|one| matches!(one, Progress::Failed { .. })).collect();
        let failure = reports[0].records[0].status.failure().expect("it failed").to_string();
        if study.may_start_solvers {
            let words = "failed: it ended with exit code 3; an error of the solver, or of its adapter. Its output ended: oh no";
            assert_eq!(failure, words);
            let label = study.planned[0].case.label();
            assert_eq!(failed, [&Progress::Failed { study: "theirs".to_owned(), label, failure }]);
        } else {
            assert_eq!(failure, "skipped: this study may not start programs without `--allow-solvers`");
            assert!(failed.is_empty(), "{failed:?}");
        }
        assert_eq!(store.hashes().len(), kept, "what is on disk of a case that may not begin stays");
    }
    assert_eq!(store.kept(&allowed.planned[0].case).map(|record| record.status.name()), Some("failed"));
    // Nothing is started to be timed either, and of a run that was ended there is no time.
    let seconds = |study: &Study| {
        let runner = CaseRunner::of(study);
        runner.time_alone(&study.planned[0].case, None).expect("a sound column").len()
    };
    let slow = scripted(folder.path(), "exec sleep 60", "timeout = 0.05\n");
    assert_eq!([seconds(&allowed), seconds(&held), seconds(&slow)], [1, 0, 0]);
}

#[test]
fn a_case_has_the_time_of_its_study_and_is_refused_by_its_numbers() {
    let mut late = study("s.toml", "[[sweep]]\nmethod = ['MPM']\nintegrator = ['explicit']\ncells = [8]\n");
    late.case_seconds = 1e-9;
    let record =
        CaseRunner::of(&late).run_within(&late.planned[0].case, None, true, &|_, _| true).expect("sound");
    let failure = record.status.failure().expect("late");
    assert_eq!(failure.kind, FailureKind::TimedOut);
    assert_eq!(failure.reason, "it took longer than the 0.000000001 s that its study allows a case");
    let sound = Case { cells: 2, time_factors: vec![0.1].into(), ..Case::seed(Task::Solve, &TERZAGHI) };
    let refused = |change: fn(&mut Case)| {
        let mut case = sound.clone();
        change(&mut case);
        run_case(&case, &[], Kernel::Fastest, true, &|_, _| true).err().map(|error| error.to_string())
    };
    let must = |what: &str, got: &str| Some(format!("the {what} must be positive and finite, got {got}"));
    assert_eq!(refused(|_| ()), None);
    assert_eq!(refused(|case| case.column.height = -2.0), must("height", "-2"));
    // Before it can be divided by: 81.75 s of it are no normal number.
    let output = refused(|case| case.time_factors = vec![0.0, 1e-320, 0.1].into());
    assert_eq!(output, must("time of an output", "8.1749e-319"));
    assert_eq!(
        refused(|case| case.time_factors = vec![0.0, 0.1].into()),
        None,
        "the start is no time to reach"
    );
    // A run that is timed alone says so, and where it was.
    let wall = ThisProgram::default().solve(&sound, &Course::alone()).expect("a sound column").wall.remove(0);
    assert!(wall.alone && wall.machine.is_some() && wall.seconds > 0.0);
    assert!(wall.cpu_seconds.is_none_or(|seconds| (0.0..60.0).contains(&seconds)), "{wall:?}");
}

#[test]
fn a_case_without_a_record_is_named_with_its_reason_and_no_case_where_the_disk_refused() {
    let case = Case { cells: 7, ..Case::seed(Task::Solve, &TERZAGHI) };
    let label = case.label();
    for (error, reason) in [
        (RunError::refused(&case, ExactError::Distance(1.5)), ExactError::Distance(1.5).to_string()),
        (RunError::crashed(&case), "crashed; please report it with the study file".to_owned()),
    ] {
        assert_eq!(error.to_string(), format!("{label}: {reason}"));
        assert_eq!(error.of_case(), Some((label.as_str(), reason)));
    }
    let source = std::io::Error::other("full");
    let error = RunError::from(StoreError::Io { action: "write", path: "a.json".into(), source });
    assert_eq!((error.to_string().as_str(), error.of_case()), ("cannot write a.json: full", None));
}

#[test]
fn times_come_in_rounds_until_each_case_that_ended_well_has_its_number() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let study = study("s.toml", &format!("timing.repeats = 3\n{}", sweep("[2, 3, 4]")));
    let store = store(folder.path(), &study);
    // Two at once: those times are not of a case alone.
    let mut records = run_study(&study, &RunOptions::whole(Tier::Full, 2), Some(&store), &|_| {}).records;
    records[1].status = Status::Failed(Failure::of_attached(FailureKind::Unstable, String::new()));
    records[2].wall.push(WallSample { seconds: 0.001, alone: true, ..WallSample::default() });
    let works = Mutex::new(Vec::new());
    let tell = |one: Progress| works.lock().expect("no thread panics").push(one);
    time_study(&study, &mut records, Some(&store), &tell).expect("timed");
    let [first, _, third] = [0, 1, 2].map(|place| Progress::Advanced(estimated_work(&records[place].case)));
    let wanted = [&first, &third, &first, &third, &first].map(Clone::clone);
    assert_eq!(*works.lock().expect("no thread panics"), wanted);
    assert_eq!([0, 1, 2].map(|place| records[place].wall_alone().len()), [3, 0, 3]);
    assert_eq!([0, 1, 2].map(|place| records[place].wall.len()), [4, 1, 4]);
    for record in [&records[0], &records[2]] {
        assert_eq!(store.kept(&record.case).expect("a record").wall, record.wall, "kept beside the record");
    }
    let untimed = store.kept(&records[1].case).expect("a record");
    assert_eq!(untimed.status, Status::Ok, "what was not timed is not written again");
    // What is timed well enough is neither run nor written again.
    std::fs::remove_dir_all(folder.path()).expect("removed");
    time_study(&study, &mut records, Some(&store), &tell).expect("nothing to do");
    assert_eq!(works.lock().expect("no thread panics").len(), 5);
    assert!(!folder.path().exists());
}

#[test]
fn a_share_by_hash_is_the_number_that_the_hash_is_over_the_count() {
    let study = study("s.toml", &sweep("[2, 3, 4, 5, 6, 7, 8, 9]"));
    let cases = study.cases(Tier::Full);
    let number = |case: &&Case| u64::from_str_radix(&case.hash(), 16).expect("hexadecimal");
    for count in [1, 2, 3, 7] {
        let wanted: Vec<u64> = cases.iter().map(|case| number(case) % count).collect();
        assert_eq!(shares_of(&cases, count, Parting::Hash), wanted);
    }
}
