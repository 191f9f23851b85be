//! The plate as an operator: what it keeps, and that its kernels agree.

use super::*;
use crate::kernel::body::Discrete;
use crate::run::{Kernel, Schedule, run};
use crate::tests::column_problem;
use crate::time_limit::TimeLimit;
use oedometer_exact::mandel::Mandel;
use oedometer_exact::solution::Solution;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::Method;
use oedometer_problem::outcome::Outcome;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::MANDEL;
use oedometer_scenes::column::{Column, column_parameters};
use oedometer_soil::material::Material;

/// Soft water: waves are slow, and the water gives way.
fn soft() -> Material {
    Material { water_bulk_modulus: 6e5, ..Material::default() }
}

/// A slab of half width 1 m and of so many rows of cells between plates.
fn slab(method: &str, soil: &Material, cells: usize, rows: usize) -> Discrete<2> {
    let width = rows as f64 / cells as f64;
    let column = Column::slab().with_extent(width);
    let method = Method::named(method).expect("a known method");
    column_problem::<2>(&MANDEL, &column, soil, method, cells, 2).expect("a possible slab")
}

fn solved(problem: Discrete<2>, integrator: IntegratorKind, kernel: Kernel, rule: TimeStep) -> Outcome {
    let formulation = match integrator {
        IntegratorKind::Explicit => Formulation::VW,
        _ => Formulation::QuasiStatic,
    };
    solved_with(problem, (integrator, formulation), kernel, rule)
}

fn solved_with(
    problem: Discrete<2>,
    (integrator, formulation): (IntegratorKind, Formulation),
    kernel: Kernel,
    rule: TimeStep,
) -> Outcome {
    let soil = problem.material;
    let seconds = 1.0 / soil.coefficient_of_consolidation();
    let schedule = Schedule {
        outputs: vec![0.0, 0.05 * seconds, 0.1 * seconds],
        history: Vec::new(),
        notes_energy: false,
        time_step: rule,
        settings: ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
        kernel,
        integrator,
        critical_step: None,
        formulation,
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let outcome = run(problem, &schedule, &|_, _| true);
    assert_eq!(outcome.status, Ok(()));
    outcome
}

fn implicit(problem: Discrete<2>) -> Outcome {
    solved(problem, IntegratorKind::Implicit, Kernel::Fastest, TimeStep::Growth(0.01))
}

/// Largest difference of two lists over the largest number of the second.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
    a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / scale
}

#[test]
fn the_undrained_start_is_skemptons_and_the_plate_is_in_balance() {
    for soil in [Material::default(), soft()] {
        let problem = slab("GIMP-SRI-patch", &soil, 6, 2);
        let mut body = Body::new(problem);
        assert_eq!(body.actions.plate.as_ref().map(|plate| plate.nodes.len()), Some(7));
        body.settle_undrained(1, TimeLimit::default()).expect("held");
        assert!(body.unbalanced_force() < 1e-9, "{}", body.unbalanced_force());
        let parameters = column_parameters(&Column::slab().with_extent(1.0 / 3.0), &soil);
        let exact = Mandel::new(&parameters).expect("possible");
        let settled = exact.settlement(0.0).expect("a time");
        assert!((body.settlement(1.0) / settled - 1.0).abs() < 1e-9);
        let pressure = exact.fields(0.0, 1.0).expect("inside").pressure;
        for computed in &body.points.pressure {
            assert!((computed / pressure - 1.0).abs() < 1e-9, "{computed} for {pressure}");
        }
    }
}

#[test]
fn tying_keeps_momentum_and_makes_one_velocity() {
    let mut body = Body::new(slab("GIMP", &soft(), 4, 1));
    let plate = body.actions.plate.clone().expect("a plate");
    for node in 0..body.nodes.len() {
        body.nodes.solid_velocity[node] = [node as f64, 1.0];
        body.nodes.water_velocity[node] = [-0.5 * node as f64, 2.0];
    }
    let momentum = |body: &Body<2>| -> f64 {
        let nodes = &body.nodes;
        let of_node = |node: usize| {
            nodes.solid_mass[node] * nodes.solid_velocity[node][0]
                + nodes.water_mass[node] * nodes.water_velocity[node][0]
        };
        (0..nodes.len()).map(of_node).sum()
    };
    let before = momentum(&body);
    plate.tie_velocities(&mut body.nodes);
    assert!((momentum(&body) / before - 1.0).abs() < 1e-13);
    let lead = body.nodes.solid_velocity[plate.nodes[0]][0];
    for node in &plate.nodes {
        assert_eq!([body.nodes.solid_velocity[*node][0], body.nodes.water_velocity[*node][0]], [lead; 2]);
        assert_eq!([body.nodes.solid_velocity[*node][1], body.nodes.water_velocity[*node][1]], [1.0, 2.0]);
    }
}

#[test]
fn a_second_row_of_cells_under_the_plate_changes_nothing() {
    for method in ["GIMP", "GIMP-SRI-patch"] {
        let single = implicit(slab(method, &soft(), 6, 1));
        let double = implicit(slab(method, &soft(), 6, 2));
        for (single, double) in single.snapshots.iter().zip(&double.snapshots) {
            // Twice as far between the plates: twice the way.
            assert!((double.settlement / single.settlement - 2.0).abs() < 1e-9, "{method}");
            let profile = |samples: &[f64], across: usize| -> Vec<f64> {
                samples.iter().step_by(across).copied().collect()
            };
            let (narrow, wide) = (profile(&single.points.pressure, 2), profile(&double.points.pressure, 4));
            assert!(apart(&wide, &narrow) < 1e-8, "{method}: {}", apart(&wide, &narrow));
        }
    }
}

#[test]
fn the_assembled_slab_is_the_point_wise_one_and_explicit_is_implicit_within_the_time_error() {
    let rule = TimeStep::Stable(0.6);
    for method in ["GIMP-SRI", "GIMP-SRI-patch"] {
        let [fast, plain] = [Kernel::Fastest, Kernel::PointWise]
            .map(|kernel| solved(slab(method, &soft(), 4, 1), IntegratorKind::Explicit, kernel, rule));
        let (fast, plain) = (&fast.snapshots[2], &plain.snapshots[2]);
        assert!(apart(&fast.points.pressure, &plain.points.pressure) < 1e-9, "{method}");
        assert!((fast.settlement / plain.settlement - 1.0).abs() < 1e-9, "{method}");
        assert!(
            (fast.totals.surface_flux - plain.totals.surface_flux).abs() < 1e-9 * plain.settlement,
            "{method}"
        );
        let calm = implicit(slab(method, &soft(), 4, 1));
        let calm = &calm.snapshots[2];
        assert!((fast.settlement / calm.settlement - 1.0).abs() < 1e-3, "{method}");
        assert!(apart(&fast.centres.pressure, &calm.centres.pressure) < 3e-3, "{method}");
    }
}

#[test]
fn the_assembled_plate_is_tied_whatever_the_velocities_are_mapped_by() {
    // The velocities of rows under the plate are seen again by trial velocities alone: where these strain, and where
    // they are a part of what is mapped back.
    for (flip, mapping_back) in [(1.0, false), (0.9, true)] {
        let [fast, plain] = [Kernel::Fastest, Kernel::PointWise].map(|kernel| {
            let schedule = Schedule {
                outputs: vec![3e-4 / soft().coefficient_of_consolidation()],
                history: Vec::new(),
                notes_energy: false,
                time_step: TimeStep::Stable(0.5),
                settings: ExplicitSettings {
                    drag: Drag::Implicit,
                    flip,
                    mapping_back,
                    ..ExplicitSettings::default()
                },
                kernel,
                integrator: IntegratorKind::Explicit,
                critical_step: None,
                formulation: Formulation::VW,
                threads: 1,
                time_limit: TimeLimit::default(),
            };
            // Under a plate over one row of cells all nodes map to one velocity by themselves.
            let outcome = run(slab("GIMP-SRI-patch", &soft(), 4, 2), &schedule, &|_, _| true);
            assert_eq!(outcome.status, Ok(()));
            outcome.snapshots[0].clone()
        });
        let name = format!("flip {flip}, mapping back {mapping_back}");
        assert!(apart(&fast.points.pressure, &plain.points.pressure) < 1e-9, "{name}");
        assert!((fast.settlement / plain.settlement - 1.0).abs() < 1e-9, "{name}");
    }
}

#[test]
fn water_leaves_by_the_drained_side_and_before_the_plate_in_balance() {
    for integrator in [IntegratorKind::Implicit, IntegratorKind::Explicit] {
        let problem = slab("GIMP-SRI", &soft(), 4, 1);
        let rule = match integrator {
            IntegratorKind::Explicit => TimeStep::Stable(0.6),
            _ => TimeStep::Growth(0.01),
        };
        let outcome = solved(problem, integrator, Kernel::Fastest, rule);
        let totals = outcome.snapshots[2].totals;
        let expanded = totals.water_expansion / 0.25;
        assert!(expanded.abs() > 1e-9, "{expanded}");
        assert!((totals.surface_flux / expanded - 1.0).abs() < 1e-6, "{totals:?}");
    }
}

#[test]
fn newtons_iteration_ends_with_a_plate_and_gives_what_the_linear_system_does() {
    let calm = implicit(slab("GIMP-SRI", &soft(), 4, 1));
    for formulation in [Formulation::UP, Formulation::VW] {
        let kind = (IntegratorKind::Implicit, formulation);
        let rule = TimeStep::Growth(0.02);
        let outcome = solved_with(slab("GIMP-SRI", &soft(), 4, 1), kind, Kernel::Fastest, rule);
        let (steps, iterations) = (outcome.counters.steps, outcome.counters.iterations);
        assert!(outcome.counters.rejected_steps == 0 && iterations < 12 * steps, "{iterations} in {steps}");
        let (waves, calm) = (&outcome.snapshots[2], &calm.snapshots[2]);
        assert!((waves.settlement / calm.settlement - 1.0).abs() < 1e-3, "{formulation:?}");
        assert!(apart(&waves.centres.pressure, &calm.centres.pressure) < 3e-3, "{formulation:?}");
    }
}
