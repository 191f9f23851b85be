//! Kernels against each other, what a run keeps, and runs at their limits.

use crate::column_problem;
use crate::run;
use oedometer_mpm::discretise::Discretised;
use oedometer_mpm::kernel::body::Discrete;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_mpm::time_limit::TimeLimit;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::Method;
use oedometer_problem::outcome::FailureKind;
use oedometer_problem::settings::Scheme;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::Column;
use oedometer_scenes::{LAYERED, SINGLE_MODE};
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;

fn problem(method: &str, cells: usize, per_cell: usize) -> Discrete<1> {
    let method = Method::named(method).expect("a known method");
    let (column, soil) = (Column::default(), Material::default());
    column_problem(&SINGLE_MODE, &column, &soil, method, cells, per_cell).expect("the seed column")
}

/// A column of two soils of two porosities, whose interface cuts a cell.
fn layered_problem(method: &str, cells: usize, per_cell: usize) -> Discrete<1> {
    let method = Method::named(method).expect("a known method");
    let lower = SoilLayer { thickness: 0.45, porosity: Some(0.6), ..SoilLayer::default() };
    let upper = SoilLayer { thickness: 0.55, hydraulic_conductivity: Some(1e-3), ..SoilLayer::default() };
    let soils = SoilLayers::from_slice(&[lower, upper]).expect("few layers");
    let (column, soil) = (Column { soils, ..Column::default() }, Material::default());
    column_problem(&LAYERED, &column, &soil, method, cells, per_cell).expect("a column of layers")
}

fn schedule(kernel: Kernel, settings: ExplicitSettings, end: f64) -> Schedule {
    let history = vec![0.25 * end, 0.5 * end];
    Schedule {
        outputs: vec![0.0, 0.4 * end, end],
        history,
        notes_energy: false,
        time_step: TimeStep::Stable(0.6),
        settings,
        kernel,
        integrator: IntegratorKind::Explicit,
        critical_step: None,
        formulation: Formulation::VW,
        threads: 1,
        time_limit: TimeLimit::default(),
    }
}

#[test]
fn the_assembled_column_is_the_point_wise_step_to_round_off() {
    for name in ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "PPP"] {
        for (scheme, drag, flip, mapping_back) in [
            (Scheme::ForwardEuler, Drag::Explicit, 1.0, true),
            (Scheme::ForwardEuler, Drag::Implicit, 1.0, false),
            (Scheme::ForwardEuler, Drag::Implicit, 0.99, true),
            (Scheme::Leapfrog, Drag::Centred, 1.0, true),
        ] {
            let settings =
                ExplicitSettings { scheme, drag, flip, mapping_back, ..ExplicitSettings::default() };
            for problem_of in [problem, layered_problem] {
                let outcome = |kernel| run(problem_of(name, 7, 3), &schedule(kernel, settings, 0.02));
                let (fast, plain) = (outcome(Kernel::Fastest), outcome(Kernel::PointWise));
                assert_eq!(fast.counters, plain.counters);
                assert_eq!(fast.status, Ok(()));
                let (fast, plain) = (fast.snapshots[2].clone(), plain.snapshots[2].clone());
                for (a, b) in [
                    (&fast.points.pressure, &plain.points.pressure),
                    (&fast.points.effective_stress, &plain.points.effective_stress),
                    (&fast.points.displacement, &plain.points.displacement),
                    (&fast.nodes.displacement, &plain.nodes.displacement),
                    (&vec![fast.settlement], &vec![plain.settlement]),
                    (&vec![fast.totals.surface_flux], &vec![plain.totals.surface_flux]),
                ] {
                    let scale = b.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
                    for (x, y) in a.iter().zip(b) {
                        assert!((x - y).abs() <= 1e-9 * scale, "{name} {settings:?}: {x} for {y}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_step_beyond_the_limit_ends_with_a_name_and_below_it_runs() {
    for (share, stable) in [(0.97, true), (1.03, false)] {
        for name in ["GIMP", "GIMP-SRI-patch", "GC-SRI-patch", "PPP"] {
            for mapping_back in [true, false] {
                let settings = ExplicitSettings { mapping_back, ..ExplicitSettings::default() };
                let mut schedule = schedule(Kernel::Fastest, settings, 0.3);
                schedule.time_step = TimeStep::Stable(share);
                let outcome = run(problem(name, 8, 2), &schedule);
                match outcome.status {
                    Ok(()) => assert!(stable, "{name} {share} {mapping_back}"),
                    Err(failure) => {
                        assert!(!stable, "{name} {share} {mapping_back}");
                        assert_eq!(failure.kind, FailureKind::Unstable);
                    }
                }
            }
        }
    }
}

#[test]
fn outputs_are_reached_and_the_history_is_recorded() {
    let outcome = run(problem("GIMP", 5, 2), &schedule(Kernel::Fastest, ExplicitSettings::default(), 0.01));
    let times: Vec<f64> = outcome.snapshots.iter().map(|snapshot| snapshot.time).collect();
    assert_eq!(times[0], 0.0);
    assert!((times[1] - 0.004).abs() < 1e-15 && (times[2] - 0.01).abs() < 1e-15);
    assert_eq!(outcome.history.len(), 2);
    assert_eq!(outcome.history.iter().map(|point| point.time).collect::<Vec<_>>(), [0.0025, 0.005]);
    assert!(outcome.step_sizes.largest <= 0.6 * outcome.step_sizes.predicted_critical * (1.0 + 1e-12));
}

#[test]
fn an_observer_can_stop_a_run() {
    let schedule = schedule(Kernel::Fastest, ExplicitSettings::default(), 0.1);
    let outcome = Discretised::from(problem("GIMP", 5, 2)).run(&schedule, &|done, _| done < 100);
    let Err(failure) = outcome.status else { panic!("not stopped") };
    assert_eq!((failure.kind, failure.step), (FailureKind::Stopped, 128));
    assert_eq!(outcome.snapshots.len(), 1, "what was finished stays");
}

#[test]
fn a_step_that_makes_energy_is_ended_before_its_pressures_are_wrong() {
    for (name, drag, share) in [
        ("GIMP", Drag::Explicit, 1.002),
        ("GIMP-SRI-patch", Drag::Implicit, 1.002),
        ("GC-SRI-patch", Drag::Centred, 1.01),
    ] {
        let settings = ExplicitSettings { drag, ..ExplicitSettings::default() };
        let mut plan = schedule(Kernel::Fastest, settings, 0.4);
        let critical = run(problem(name, 8, 2), &plan).step_sizes.predicted_critical;
        // Whole steps from output to output, which are not made smaller to end there.
        plan.outputs = (1..=400).map(|output| 20.0 * share * critical * f64::from(output)).collect();
        let sound = run(problem(name, 8, 2), &plan);
        assert_eq!(sound.status, Ok(()));
        plan.time_step = TimeStep::Stable(share);
        let grown = run(problem(name, 8, 2), &plan);
        let Err(failure) = grown.status else { panic!("{name} {share} went on to its end") };
        assert_eq!(failure.kind, FailureKind::Unstable);
        let is_named = failure.reason.contains("without work")
            || failure.reason.contains("out-of-balance force at a node");
        assert!(is_named, "{name}: {}", failure.reason);
        for (sound, grown) in sound.snapshots.iter().zip(&grown.snapshots) {
            let (sound, grown) = (&sound.points.pressure, &grown.points.pressure);
            let off =
                sound.iter().zip(grown).fold(0.0, |off: f64, (sound, grown)| off.max((sound - grown).abs()));
            assert!(off < 0.2, "{name}: {off} of the load of one pascal");
        }
    }
}
