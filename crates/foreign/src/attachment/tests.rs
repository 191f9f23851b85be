use super::*;
use crate::identity::LONGEST_VERSION;
use crate::import::RIM;
use oedometer_case::Task;
use oedometer_case::solver::Attached;
use oedometer_scenes::{COSINE_LAYER, MANDEL, TERZAGHI};
use std::path::Path;

/// A solver in a folder by a command, with the convention's mapping.
pub(crate) fn solver(folder: &Path, command: &[&str]) -> ExternalSolver {
    ExternalSolver {
        files: Vec::new(),
        time_step: None,
        identity: Attached::new("toy", "0123456789abcdef").expect("a plain name"),
        folder: folder.to_owned(),
        command: command.iter().map(|word| (*word).to_owned()).collect(),
        result: "{out}/result.csv".to_owned(),
        mapping: None,
        preset: None,
        version: Vec::new(),
        known_by: None,
        timeout: 60.0,
        repeats: 1,
        warm_up: false,
        at_once: 1,
        environment: Vec::new(),
        solve_seconds: None,
        solve_unit: 1.0,
    }
}

/// A state with samples at heights and distances from the crest, and their displacements.
fn state(places: &[[f64; 2]], displacement: &[f64], curve: Option<f64>) -> SampledState {
    SampledState {
        initial_height: places.iter().map(|place| place[0]).collect(),
        initial_distance: places.iter().map(|place| place[1]).collect(),
        displacement: displacement.to_vec(),
        surface_displacement: curve,
        ..SampledState::default()
    }
}

#[test]
fn a_settlement_is_that_of_the_curve_or_of_the_sample_at_the_surface_under_the_crest() {
    let settled = |scene, state: SampledState| {
        let settlement = snapshot_of(&Case::seed(Task::Solve, scene), Sample::Points, &state).settlement;
        (!settlement.is_nan()).then_some(settlement)
    };
    let mut samples = [([0.0, 0.0], 0.0), ([1.0, 0.0], -3.0), ([0.5, 0.0], -1.0)];
    for _ in 0..3 {
        let (places, up): (Vec<[f64; 2]>, Vec<f64>) = samples.into_iter().unzip();
        for scene in [&TERZAGHI, &COSINE_LAYER] {
            assert_eq!(settled(scene, state(&places, &up, None)), Some(3.0), "{scene:?} {places:?}");
            assert_eq!(settled(scene, state(&places, &up, Some(-7.0))), Some(7.0));
            assert_eq!(settled(scene, state(&places, &[], None)), None, "without displacements");
        }
        assert_eq!(settled(&MANDEL, state(&places, &up, None)), None, "a slab's plate presses across");
        assert_eq!(settled(&MANDEL, state(&places, &up, Some(-7.0))), Some(7.0));
        samples.rotate_left(1);
    }
    // Up to the round-off of single precision, and no further; in a column wherever it stands across.
    for (place, of_column, of_layer) in [
        ([1.0 - 0.9 * RIM, 0.0], Some(3.0), Some(3.0)),
        ([1.0 - 1.1 * RIM, 0.0], None, None),
        ([1.0, 0.9 * RIM], Some(3.0), Some(3.0)),
        ([1.0, 0.5], Some(3.0), None),
    ] {
        assert_eq!(settled(&TERZAGHI, state(&[place], &[-3.0], None)), of_column, "{place:?}");
        assert_eq!(settled(&COSINE_LAYER, state(&[place], &[-3.0], None)), of_layer, "{place:?}");
    }
}

#[test]
fn samples_go_where_their_kind_is_looked_for_with_every_field_of_their_own() {
    let given = SampledState {
        time: 8.0,
        volume: vec![2.0],
        pressure: vec![3.0],
        effective_stress: vec![5.0],
        horizontal_displacement: vec![7.0],
        ..state(&[[0.25, 0.75]], &[11.0], None)
    };
    for (sample, wanted) in
        [(Sample::Points, [1, 0, 0]), (Sample::Centres, [0, 1, 0]), (Sample::Nodes, [0, 0, 1])]
    {
        let column = snapshot_of(&Case::seed(Task::Solve, &TERZAGHI), sample, &given);
        let layer = snapshot_of(&Case::seed(Task::Solve, &COSINE_LAYER), sample, &given);
        for (found, is_plane) in [(column, false), (layer, true)] {
            let all = [&found.points, &found.centres, &found.nodes];
            assert_eq!(all.map(|samples| samples.initial_height.len()), wanted, "{sample:?}");
            let place = wanted.iter().position(|count| *count == 1).expect("one");
            let Samples { initial_height, volume, pressure, effective_stress, displacement, plane, .. } =
                all[place];
            let fields =
                [initial_height, volume, pressure, effective_stress, displacement].map(|field| field[0]);
            assert_eq!((found.time, fields), (8.0, [0.25, 2.0, 3.0, 5.0, 11.0]));
            let along =
                plane.as_ref().map(|plane| [plane.initial_distance[0], plane.horizontal_displacement[0]]);
            assert_eq!(along, is_plane.then_some([0.75, 7.0]));
        }
    }
}

#[cfg(unix)]
mod runs {
    use super::*;
    use oedometer_case::outcome::Status;
    use oedometer_problem::outcome::FailureKind;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// A case on two cells with one output.
    fn case(solver: &ExternalSolver) -> Case {
        Case {
            method: solver.method(),
            cells: 2,
            time_factors: vec![0.1].into(),
            ..Case::seed(Task::Solve, &TERZAGHI)
        }
        .as_its_solver_knows()
    }

    /// Runs a shell script instead of a solver.
    fn run(script: &str, change: impl Fn(&mut ExternalSolver)) -> Outcome {
        let folder = tempfile::TempDir::new().expect("a folder");
        let mut solver = solver(folder.path(), &["sh", "-c", script]);
        change(&mut solver);
        let course = Course { place: Some(folder.path()), ..Course::alone() };
        let outcome = solved(&solver, &course);
        let kept = if outcome.status == Status::Ok { "solver" } else { "solver.failed" };
        let is_started = outcome.status.name() != "unreadable" || solver.mapping.is_none();
        assert!(folder.path().join(kept).join("case.json").is_file() || !is_started);
        outcome
    }

    /// What the solver leaves of the case.
    fn solved(solver: &ExternalSolver, course: &Course<'_>) -> Outcome {
        solver_of(solver, Axes::Column, true).solve(&case(solver), course).expect("a sound column")
    }

    /// Rows of the three nodes at an output of 8.175 s.
    const ROWS: &str = "printf 't,y,p,u_y\\n8.175,0,0.9,0\\n8.175,0.5,0.6,-1e-7\\n8.175,1,0,-3e-7\\n'";

    #[test]
    fn a_version_that_hangs_takes_no_longer_than_a_run_may() {
        let clock = std::time::Instant::now();
        let outcome = run(&format!("{ROWS} > result.csv"), |solver| {
            solver.version = ["sh", "-c", "echo 7; exec sleep 600"].map(str::to_owned).to_vec();
            solver.timeout = 2.0;
        });
        let about = outcome.foreign.expect("what it was");
        assert_eq!((outcome.status, about.version), (Status::Ok, None));
        assert!(about.notes[0].contains("did not end within 2 s"), "{:?}", about.notes);
        assert!(clock.elapsed().as_secs() < 50, "the time that any version has");
    }

    #[test]
    fn every_status_is_the_first_that_applies() {
        let good = format!("{ROWS} > result.csv");
        let nan = good.replace("0.6", "nan");
        for (script, kind, told) in [
            (format!("{good}; sleep 600"), FailureKind::TimedOut, "exceeded its 1 s"),
            (format!("{good}; kill -ABRT $$"), FailureKind::Killed, "signal: 6"),
            (format!("{good}; echo oh no >&2; exit 3"), FailureKind::Failed, "exit code 3"),
            (format!("{good}; exit 77"), FailureKind::Skipped, "cannot run here"),
            ("touch other.csv".to_owned(), FailureKind::NoResult, "has other.csv"),
            (good.replace("u_y", "w"), FailureKind::Unreadable, "no column `u_y`"),
            (nan, FailureKind::NotFinite, "result.csv:3"),
            (good.replace("8.175,0,0.9,0\\n", ""), FailureKind::Incomplete, "between the heights"),
        ] {
            let timeout = if kind == FailureKind::TimedOut { 1.0 } else { 60.0 };
            let outcome = run(&script, |solver| solver.timeout = timeout);
            let failure = outcome.status.failure().unwrap_or_else(|| panic!("{script}"));
            assert_eq!(failure.kind, kind, "{script}: {failure}");
            assert!(failure.to_string().contains(told), "{failure}");
            assert!(outcome.snapshots.is_empty());
        }
        let missing = run("", |solver| solver.command = vec!["./no-such-program".to_owned()]);
        assert_eq!(missing.status.name(), "not-startable");
    }

    #[test]
    fn the_last_words_are_told_and_tell_no_path_of_this_machine() {
        let outcome = run("echo wrong in $PWD/result.csv >&2; exit 1", |_| {});
        let told = outcome.status.failure().expect("it failed").to_string();
        assert!(told.contains("Its output ended: wrong in {out}/result.csv"), "{told}");
        assert_eq!(outcome.foreign.expect("a program").last_words, ["wrong in {out}/result.csv"]);
    }

    #[test]
    fn repeats_are_timed_after_a_warm_up_and_compared() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let count = folder.path().join("count");
        let counted = format!("echo run >> {}; {ROWS}", count.display());
        let same = run(&format!("{counted} > result.csv; echo took 2.5 s"), |solver| {
            (solver.repeats, solver.warm_up) = (3, true);
            solver.solve_seconds = Some("took ([0-9.]+) s".to_owned());
            solver.solve_unit = 1e-6;
        });
        assert_eq!(std::fs::read_to_string(&count).expect("counted").lines().count(), 4);
        assert_eq!(same.wall.len(), 3, "the warm-up is not among them");
        assert!(same.wall.iter().all(|sample| sample.own_seconds == Some(2.5 * 1e-6) && sample.alone));
        let about = same.foreign.expect("a program");
        assert_eq!((about.repeats_differ_by, about.notes.len()), (Some(0.0), 0));
        // More than its run took is in another unit.
        let ms = run(&format!("{ROWS} > result.csv; echo took 30743 s"), |solver| {
            solver.solve_seconds = Some("took ([0-9.]+) s".to_owned());
        });
        let notes = ms.foreign.expect("a program").notes;
        assert!(notes.len() == 1 && notes[0].contains("it reports 30740 s, more than"), "{notes:?}");
        // The number of the run stands in a pressure.
        let script = format!("{counted} | sed s/0.6/0.6$(wc -l < {})/ > result.csv", count.display());
        let differing = run(&script, |solver| solver.repeats = 2).foreign.expect("a program");
        assert!(differing.repeats_differ_by.is_some_and(|most| most > 1e-3), "{differing:?}");
        assert!(differing.notes[0].contains("do not give the same result"));
    }

    #[test]
    fn a_difference_of_repeats_is_the_largest_wherever_it_stands() {
        let mut differences = [3e-3, 1e-3, 2e-3];
        for _ in 0..3 {
            let mut about = AttachedRun::default();
            for difference in differences {
                note_difference(&mut about, difference);
            }
            assert_eq!((about.repeats_differ_by, about.notes.len()), (Some(3e-3), 1), "{differences:?}");
            differences.rotate_left(1);
        }
        // Up to round-off they are the same; those that cannot be compared have no difference.
        let other = "its repeats do not give the same result; see `repeats_differ_by`";
        let elsewhere = "its repeats give results at different places, or results that cannot be compared";
        for (difference, known, notes) in [
            (0.0, Some(0.0), &[][..]),
            (1e-12, Some(1e-12), &[]),
            (1.1e-12, Some(1.1e-12), &[other]),
            (f64::INFINITY, None, &[elsewhere]),
            (f64::NAN, None, &[elsewhere]),
        ] {
            let mut about = AttachedRun::default();
            note_difference(&mut about, difference);
            assert_eq!(about.repeats_differ_by, known, "{difference}");
            assert_eq!(about.notes, notes, "{difference}");
        }
    }

    #[test]
    fn the_time_that_a_solver_tells_last_is_its_own() {
        for (script, own) in [
            ("echo took 1 s; echo took 3 s; echo took 2 s", Some(2.0)),
            ("echo took 1 s; echo took 3 s >&2", Some(1.0)),
            ("echo took 1 s >&2; echo took 3 s >&2", Some(3.0)),
            ("echo took long", None),
        ] {
            let outcome = run(&format!("{script}; exit 1"), |solver| {
                solver.solve_seconds = Some("took ([0-9.]+) s".to_owned());
            });
            assert_eq!(outcome.wall[0].own_seconds, own, "{script}");
        }
    }

    #[test]
    fn a_version_is_the_first_line_that_says_something_and_notes_on_what_was_taken_are_six() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let long = "v".repeat(LONGEST_VERSION + 1);
        let shout = format!("echo {long}");
        for (script, version) in [
            ("echo; echo '  7.1  '; echo 8; echo 6 >&2", Some("7.1")),
            ("echo 6 >&2", Some("6")),
            ("echo 5; exit 3", Some("5")),
            ("true", None),
            (shout.as_str(), Some(&long[1..])),
        ] {
            let mut solver = solver(folder.path(), &["true"]);
            solver.version = ["sh", "-c", script].map(str::to_owned).to_vec();
            let found = Attachment::new(Reading::new(&solver, Axes::Column)).version(&|| true).clone();
            assert_eq!(found.map(|version| version.line), Ok(version.map(str::to_owned)), "{script}");
        }
        let solver = solver(folder.path(), &["true"]);
        let case = case(&solver);
        for (count, last) in [(6, "note 6"), (7, "and 1 note more"), (9, "and 3 notes more")] {
            let result = ReadResult {
                states: Vec::new(),
                has_changing_mesh: false,
                sample: Sample::Nodes,
                notes: (1..=count).map(|number| format!("note {number}")).collect(),
                digest: "d".to_owned(),
            };
            let states = vec![state(&[[0.0, 0.0], [1.0, 0.0]], &[], None)];
            let found = outcome(&case, Ok((states, result)), AttachedRun::default(), Vec::new());
            let about = found.foreign.expect("what made it");
            assert_eq!(
                (about.taken.len(), about.taken.last().map(String::as_str)),
                (7.min(count), Some(last))
            );
            assert_eq!((about.sample, about.result_digest.as_deref()), (Some(Sample::Nodes), Some("d")));
        }
    }

    #[test]
    fn a_run_that_is_not_wanted_any_more_leaves_what_an_earlier_one_left() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let place = folder.path().join("case");
        let run = |script: &str, is_wanted: &dyn Fn() -> bool| {
            let solver = solver(folder.path(), &["sh", "-c", script]);
            let environment = vec![("NAME".to_owned(), "{cells} of {x}".to_owned())];
            let solver = ExternalSolver { environment, ..solver };
            let observe = |_, _| is_wanted();
            let course = Course { place: Some(&place), alone: false, observe: &observe, ..Course::alone() };
            solved(&solver, &course)
        };
        let sound = run(&format!("echo $NAME; {ROWS} > result.csv"), &|| true);
        assert!(sound.status == Status::Ok && !sound.wall[0].alone);
        let said = || std::fs::read_to_string(place.join("solver/stdout.txt")).ok();
        assert_eq!(said().as_deref(), Some("2 of {x}\n"), "its environment is filled in");
        // Before it begins, and while it goes on.
        for looks in [0, 2] {
            let looked = std::cell::Cell::new(0);
            let stopped = run("exec sleep 60", &|| looked.replace(looked.get() + 1) < looks);
            assert_eq!(stopped.status.failure().map(|failure| failure.kind), Some(FailureKind::Stopped));
            assert_eq!(stopped.wall.len(), usize::from(looks > 0));
            assert_eq!(said().as_deref(), Some("2 of {x}\n"));
            assert_eq!(std::fs::read_dir(&place).expect("a folder").count(), 1);
        }
    }

    #[test]
    fn no_more_runs_go_on_at_once_than_a_gate_lets_pass() {
        let (gate, inside, most) = (Gate::of(2), AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let _passed = gate.pass();
                    most.fetch_max(inside.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                    std::thread::sleep(Duration::from_millis(5));
                    inside.fetch_sub(1, Ordering::SeqCst);
                });
            }
        });
        assert_eq!(most.load(Ordering::SeqCst), 2);
    }

    #[test]
    fn a_record_stands_by_what_the_study_declares_and_by_nothing_else() {
        use Standing::{Outdated, Proven, Unproven};
        let folder = tempfile::TempDir::new().expect("a folder");
        std::fs::write(folder.path().join("adapter.sh"), "1").expect("a file");
        let plain = solver(folder.path(), &["sh", "adapter.sh"]);
        let declared = ExternalSolver { known_by: Some(vec!["adapter.sh".to_owned()]), ..plain.clone() };
        let asked = ExternalSolver { version: ["echo", "7"].map(str::to_owned).to_vec(), ..declared.clone() };
        let mute = ExternalSolver { version: vec!["true".to_owned()], ..declared.clone() };
        let given = ExternalSolver { files: vec!["a.csv".to_owned()], ..plain.clone() };
        let of = |solver| {
            let version = Version::asked(solver, &|| true).expect("in time");
            digest_of_program(solver, &version).ok()
        };
        let other = Some("0123456789abcdef".to_owned());
        for (number, (solver, digest, may_start, wanted)) in [
            // Without a declaration nothing is proven, whatever is the same.
            (&plain, of(&plain), true, Unproven),
            (&plain, other.clone(), true, Unproven),
            (&declared, of(&declared), true, Proven),
            (&declared, of(&declared), false, Proven),
            (&declared, other.clone(), true, Outdated),
            (&declared, None, true, Unproven),
            // What was made before the declaration is not known by it.
            (&declared, of(&plain), true, Outdated),
            (&asked, of(&asked), true, Proven),
            (&asked, of(&declared), true, Outdated),
            // What nobody allowed to start is not asked, and a version that says nothing proves nothing.
            (&asked, of(&asked), false, Unproven),
            (&mute, of(&declared), true, Unproven),
            // What is there already is read again.
            (&given, of(&plain), true, Outdated),
        ]
        .into_iter()
        .enumerate()
        {
            let about = AttachedRun { program_digest: digest, ..AttachedRun::default() };
            let standing = solver_of(solver, Axes::Column, may_start).standing(Some(&about));
            assert_eq!(standing, wanted, "row {number}");
        }
    }
}
