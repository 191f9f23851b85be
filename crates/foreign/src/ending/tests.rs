//! Ends by their names and sentences, and results that lack times or places.

use super::*;
use oedometer_case::Task;
use oedometer_scenes::{COSINE_LAYER, TERZAGHI};

fn case() -> Case {
    Case { cells: 10, time_factors: vec![0.05, 0.1].into(), ..Case::seed(Task::Solve, &TERZAGHI) }
}

/// States at the outputs with samples at heights.
fn states(heights: &[f64]) -> Vec<SampledState> {
    let state = |factor: f64| SampledState {
        time: factor * case().seconds_per_time_factor(),
        initial_height: heights.to_vec(),
        ..SampledState::default()
    };
    vec![state(0.05), state(0.1)]
}

fn lattice(count: usize, first: f64, spacing: f64) -> Vec<f64> {
    (0..count).map(|place| first + spacing * place as f64).collect()
}

fn said(states: &[SampledState]) -> String {
    states_at_outputs(&case(), states, false).expect_err("something is missing")
}

#[test]
fn nodes_centres_and_points_are_whole() {
    for heights in [lattice(11, 0.0, 0.1), lattice(10, 0.05, 0.1), lattice(20, 0.025, 0.05)] {
        assert!(states_at_outputs(&case(), &states(&heights), false).is_ok(), "{heights:?}");
    }
}

#[test]
fn a_missing_half_every_other_row_and_a_hole_are_told_with_their_heights() {
    let nodes = lattice(11, 0.0, 0.1);
    let told = said(&states(&nodes[..6]));
    assert!(told.contains("between the heights 0.5 m and 1 m"), "{told}");
    assert!(said(&states(&nodes[5..])).contains("between the heights 0 m and 0.5 m"));
    let every_other: Vec<f64> = nodes.iter().copied().step_by(2).collect();
    assert!(said(&states(&every_other)).contains("between the heights 0 m and 0.2 m"));
    assert!(said(&states(&[])).contains("no sample"));
}

#[test]
fn a_stretch_of_a_layers_length_that_is_missing_is_told_with_its_distances() {
    let case =
        Case { cells: 10, time_factors: vec![0.05, 0.1].into(), ..Case::seed(Task::Solve, &COSINE_LAYER) };
    let nodes = lattice(11, 0.0, 0.1);
    let of = |distances: &[f64]| {
        let places = distances.iter().flat_map(|x| nodes.iter().map(move |y| (*x, *y)));
        let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
        let state = |factor: f64| SampledState {
            time: factor * case.seconds_per_time_factor(),
            initial_distance: x.clone(),
            initial_height: y.clone(),
            ..SampledState::default()
        };
        states_at_outputs(&case, &[state(0.05), state(0.1)], false)
    };
    assert!(of(&nodes).is_ok());
    let told = of(&nodes[..2]).expect_err("nine tenths are missing");
    assert!(told.contains("between the distances 0.1 m and 1 m"), "{told}");
    assert!(of(&[&nodes[..4], &nodes[6..]].concat()).is_err_and(|told| told.contains("0.3 m and 0.6 m")));
}

#[test]
fn the_length_of_a_layer_is_its_own_and_not_its_height() {
    let seed = Case::seed(Task::Solve, &COSINE_LAYER);
    for (length, reached, told) in [
        (0.5, 6, None),
        (0.5, 4, Some("the distances 0.3 m and 0.5 m")),
        (2.0, 21, None),
        (2.0, 20, Some("the distances 1.9 m and 2 m")),
        (2.0, 11, Some("the distances 1 m and 2 m")),
    ] {
        let column = seed.column.clone().with_extent(length);
        let case = Case { cells: 10, time_factors: vec![0.1].into(), column: column.into(), ..seed.clone() };
        let (along, up) = (lattice(reached, 0.0, 0.1), lattice(11, 0.0, 0.1));
        let (initial_distance, initial_height) =
            along.iter().flat_map(|x| up.iter().map(move |y| (*x, *y))).unzip();
        let time = 0.1 * case.seconds_per_time_factor();
        let state = SampledState { time, initial_distance, initial_height, ..SampledState::default() };
        let found = states_at_outputs(&case, &[state], false).err();
        match told {
            None => assert_eq!(found, None, "{length} m, {reached} nodes"),
            Some(told) => assert!(found.as_ref().is_some_and(|found| found.contains(told)), "{found:?}"),
        }
    }
}

#[test]
fn missing_times_and_uneven_ones_are_told() {
    let mut all = states(&lattice(11, 0.0, 0.1));
    let late = all.remove(1);
    let told = said(&all);
    assert!(told.contains("no state at T_v = 0.1") && told.contains("it has 0.05"), "{told}");
    let near = SampledState { time: late.time * 1.0009, ..late.clone() };
    assert!(states_at_outputs(&case(), &[all[0].clone(), near], false).is_ok());
    let far = SampledState { time: late.time * 1.0011, ..late.clone() };
    assert!(states_at_outputs(&case(), &[all[0].clone(), far], false).is_err());
    let more = SampledState { initial_height: lattice(21, 0.0, 0.05), ..late.clone() };
    assert_eq!(said(&[all[0].clone(), more]), "there are 21 samples at T_v = 0.1, and 11 at 0.05");
    let twice = SampledState { repeated: 3, ..late };
    assert!(said(&[all[0].clone(), twice]).contains("3 samples are repeated"));
}

#[test]
fn a_difference_is_relative_to_the_field_and_of_other_places_infinite() {
    let state = |pressure: f64| SampledState {
        initial_height: vec![0.0, 1.0],
        pressure: vec![4.0, pressure],
        displacement: vec![1e-9, 0.0],
        ..SampledState::default()
    };
    assert_eq!(difference(&[state(1.0)], &[state(1.0)]), 0.0);
    assert_eq!(difference(&[state(1.0)], &[state(1.5)]), 0.125);
    let elsewhere = SampledState { initial_height: vec![0.0, 0.5], ..state(1.0) };
    assert_eq!(difference(&[state(1.0)], &[elsewhere]), f64::INFINITY);
    assert_eq!(difference(&[state(1.0)], &[]), f64::INFINITY);
    let along = SampledState { initial_distance: vec![0.0, 0.5], ..state(1.0) };
    assert_eq!(difference(&[state(1.0)], &[along]), f64::INFINITY, "at other distances");
}

#[test]
fn a_stretch_is_bare_beyond_three_quarters_of_a_cell_at_an_end_and_one_and_a_half_inside() {
    for (off, is_bare) in [(0.074, false), (0.075, false), (0.076, true)] {
        let (low, high, extent) = (lattice(10, off, 0.1), lattice(10, 0.0, 0.1), 0.9 + off);
        assert_eq!(bare(&low, extent, 0.1, true), is_bare.then_some([0.0, off]));
        assert_eq!(bare(&high, extent, 0.1, true), is_bare.then_some([0.9, extent]));
        assert_eq!(bare(&high, extent, 0.1, false), None, "an end that is not held");
    }
    for (gap, is_bare) in [(0.149, false), (0.15, false), (0.151, true)] {
        let places = [0.05, 0.1, 0.1 + gap, 0.2 + gap];
        assert_eq!(bare(&places, 0.25 + gap, 0.1, true), is_bare.then_some([0.1, 0.1 + gap]), "{gap}");
    }
}

#[test]
fn repeats_differ_by_the_field_that_differs_most_in_whichever_state_and_by_one_that_only_one_has() {
    let state = || SampledState {
        initial_height: vec![0.0, 1.0],
        pressure: vec![8.0, 4.0],
        effective_stress: vec![-8.0, 4.0],
        displacement: vec![-8e-3, 0.0],
        horizontal_displacement: vec![8e-6, 0.0],
        surface_displacement: Some(-8.0),
        ..SampledState::default()
    };
    let fields: [fn(&mut SampledState) -> &mut [f64]; 5] = [
        |state| &mut state.pressure,
        |state| &mut state.effective_stress,
        |state| &mut state.displacement,
        |state| &mut state.horizontal_displacement,
        |state| state.surface_displacement.as_mut_slice(),
    ];
    let all = || [state(), state(), state()];
    assert_eq!(difference(&all(), &all()), 0.0);
    for (number, field) in fields.into_iter().enumerate() {
        for place in 0..3 {
            let mut others = all();
            field(&mut others[place])[0] *= 0.75;
            let found = difference(&all(), &others);
            assert!((found - 0.25).abs() < 1e-12, "field {number} of state {place}: {found}");
        }
    }
    let lacking: [fn(&mut SampledState); 5] = [
        |state| state.pressure.clear(),
        |state| state.effective_stress.clear(),
        |state| state.displacement.clear(),
        |state| state.horizontal_displacement.clear(),
        |state| state.surface_displacement = None,
    ];
    for (number, lack) in lacking.into_iter().enumerate() {
        let mut others = all();
        lack(&mut others[1]);
        for (one, other) in [(&all(), &others), (&others, &all())] {
            assert_eq!(difference(one, other), f64::INFINITY, "field {number}");
        }
    }
}

#[test]
fn an_output_has_the_state_nearest_to_it_in_whatever_order_they_come() {
    let heights = lattice(11, 0.0, 0.1);
    let unit = case().seconds_per_time_factor();
    let state = |factor: f64, mark: f64| SampledState {
        time: factor * unit,
        pressure: vec![mark; heights.len()],
        initial_height: heights.clone(),
        ..SampledState::default()
    };
    let mut all = vec![
        state(0.050_04, 1.0),
        state(0.050_01, 2.0),
        state(0.049_96, 3.0),
        state(0.07, 4.0),
        state(0.100_09, 5.0),
        state(0.099_95, 6.0),
    ];
    for _ in 0..all.len() {
        let found = states_at_outputs(&case(), &all, false).expect("both outputs");
        let marks: Vec<f64> = found.iter().map(|state| state.pressure[0]).collect();
        assert_eq!(marks, [2.0, 6.0]);
        all.rotate_left(1);
    }
    // The first of the two is missing as well as the last, and both are named.
    let early = said(&[state(0.1, 1.0)]);
    assert!(early.contains("no state at T_v = 0.05 (") && early.contains("it has 0.1"), "{early}");
    assert!(said(&[state(0.07, 1.0)]).contains("no state at T_v = 0.05, 0.1 ("));
    assert!(said(&[]).ends_with("it has none"));
}

#[test]
#[cfg(unix)]
fn processes_are_told_that_live_on_or_were_left_behind_and_not_those_that_were_ended_on_purpose() {
    use crate::started_processes::{Found, Seen};
    use std::os::unix::process::ExitStatusExt;
    let seen = |id: i32| Seen { id, name: format!("p{id}") };
    let run = |ending: Ending, seen_alive: &[i32], lives_on: &[i32]| Finished {
        ending,
        seconds: 1.0,
        cpu_seconds: None,
        peak_memory: None,
        output: "out\n".to_owned(),
        errors: String::new(),
        found: Found {
            seen: seen_alive.iter().copied().map(seen).collect(),
            lives_on: lives_on.iter().copied().map(seen).collect(),
        },
    };
    let ended = || Ending::Ended(ExitStatus::from_raw(0));
    for (ending, seen_alive, lives_on, told) in [
        (ended(), &[][..], &[][..], None),
        (ended(), &[4, 5], &[], Some("it left processes behind, which were ended: 4 (p4), 5 (p5)")),
        (ended(), &[4, 5], &[5], Some("processes of it could not be ended: 5 (p5)")),
        (Ending::TimedOut, &[4], &[], None),
        (Ending::TimedOut, &[4, 5], &[4], Some("processes of it could not be ended: 4 (p4)")),
        (Ending::Stopped, &[4], &[], None),
    ] {
        let found = of_processes(&run(ending, seen_alive, lives_on));
        assert_eq!(found.as_deref(), told);
    }
    let solver = crate::attachment::tests::solver(std::path::Path::new("/"), &["./theirs", "x"]);
    let solver = ExternalSolver { timeout: 90.0, ..solver };
    let late = "the solver exceeded its 90 s and was killed with everything that it had started";
    let short = "; it hangs, or `timeout` is too short. Its output ended: out";
    for (ending, lives_on, told) in [
        (Ending::TimedOut, &[][..], format!("timed-out: {late}{short}")),
        (Ending::TimedOut, &[4, 5], format!("timed-out: {late}, except for 4 (p4), 5 (p5), which could not be killed{short}")),
        (Ending::Stopped, &[4], "stopped: stopped from outside".to_owned()),
        (
            Ending::NotStarted(std::io::Error::other("no such file")),
            &[],
            "not-startable: `./theirs` could not be started: no such file; the command in the study is \
             wrong, or the program is not installed. Its output ended: out"
                .to_owned(),
        ),
        (
            Ending::Ended(ExitStatus::from_raw(9)),
            &[],
            "killed: signal: 9 (SIGKILL) ended it, which this program did not send; the solver crashed, or memory ran out. \
             Its output ended: out"
                .to_owned(),
        ),
        (
            Ending::Ended(ExitStatus::from_raw(78 << 8)),
            &[],
            "failed: it ended with exit code 78; an error of the solver, or of its adapter. Its output ended: out".to_owned(),
        ),
        (
            Ending::Ended(ExitStatus::from_raw(77 << 8)),
            &[],
            "skipped: it reports that it cannot run here (exit code 77). Its output ended: out".to_owned(),
        ),
    ] {
        let found = of_process(&run(ending, &[], lives_on), &solver).expect("it failed");
        assert_eq!(format!("{}: {}", found.kind.name(), found.reason), told);
    }
    assert_eq!(of_process(&run(ended(), &[4], &[]), &solver), None);
}

#[test]
fn errors_of_a_run_are_repeated_and_its_output_only_where_there_are_none() {
    let plain = Finished {
        ending: Ending::TimedOut,
        seconds: 1.0,
        cpu_seconds: None,
        peak_memory: None,
        output: "out\n".to_owned(),
        errors: String::new(),
        found: crate::started_processes::Found { seen: Vec::new(), lives_on: Vec::new() },
    };
    assert_eq!(kept_words(&plain), ["out"]);
    let wrong = Finished { errors: "1\n2\n3\n4\n5\n".to_owned(), ..plain };
    assert_eq!(kept_words(&wrong), ["1", "2", "3", "4", "5"]);
    assert_eq!(last_words(&wrong), ". Its output ended: 2 / 3 / 4 / 5");
    // What MPI says of a process that ended is not what went wrong.
    let mpi = "Error: matrix is singular\nstep 7\n-----\nMPI_ABORT was invoked on rank 0 in communicator MPI_COMM_WORLD\n\
               with errorcode 1.\nPrimary job  terminated normally, but 1 process returned\na non-zero exit code.\n\
               one\ntwo\nthree\nfour\nfive\nsix\nseven\neight\nnine\nten\n";
    let crashed = Finished { errors: mpi.to_owned(), ..wrong };
    assert_eq!(kept_words(&crashed)[0], "Error: matrix is singular");
    let told = last_words(&crashed);
    assert_eq!(told, ". Its output began: Error: matrix is singular. It ended: seven / eight / nine / ten");
    let python = "Traceback (most recent call last):\n  File \"a.py\", line 1\nValueError: no mesh\nabort(1) on node 0\n";
    let crashed = Finished { errors: python.to_owned(), ..crashed };
    assert_eq!(first_message(&crashed.errors).as_deref(), Some("ValueError: no mesh"));
}

#[test]
fn whatever_cannot_be_taken_is_told_with_whose_error_it_is() {
    let solver = crate::attachment::tests::solver(std::path::Path::new("/"), &["true"]);
    let files = ["a.csv", "b.csv"].map(str::to_owned);
    let why = || "why".to_owned();
    let refused = || std::io::Error::other("full");
    for (failure, told) in [
        (
            of_reading(Unread::NoFile, &solver, "other.csv"),
            "no-result: it ended with exit code 0 and left no {out}/result.csv; {out} has other.csv: the adapter writes it elsewhere, or `result` in the study has another name",
        ),
        (
            of_reading(Unread::Unreadable(why()), &solver, ""),
            "unreadable: why; the adapter wrote it wrongly, or the mapping describes it wrongly",
        ),
        (of_reading(Unread::NotFinite(why()), &solver, ""), "not-finite: why; an error of the solver"),
        (
            of_given(Unread::NoFile, &files),
            "no-result: there is no file a.csv, b.csv: the solver did not run, or `files` in the study names another result",
        ),
        (of_given(Unread::Unreadable(why()), &files), "unreadable: why"),
        (of_given(Unread::NotFinite(why()), &files), "not-finite: why; an error of the solver"),
        (
            of_incomplete("why"),
            "incomplete: why; the adapter left data out, or the solver ended early without an error",
        ),
        (
            of_folder(&refused()),
            "not-startable: its folder could not be created: full; an error of the machine, not of the solver",
        ),
        (of_mapping("why"), "unreadable: the mapping cannot be used: why"),
        (of_held_back(), "skipped: this study may not start programs without `--allow-solvers`"),
    ] {
        assert_eq!(failure.to_string(), told);
    }
}
