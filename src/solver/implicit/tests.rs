//! The implicit integrator against the explicit one, against itself and across dimensions.

use crate::scene::{Column, SceneKind, column_problem};
use crate::solver::body::Problem;
use crate::solver::explicit::{Drag, ExplicitSettings};
use crate::solver::grid::Grid;
use crate::solver::integrator::IntegratorKind;
use crate::solver::material::Material;
use crate::solver::method::Method;
use crate::solver::nodes::Support;
use crate::solver::outcome::{Outcome, RunStatus};
use crate::solver::points::Points;
use crate::solver::run::{Kernel, Schedule, TimeStepRule, run};

const METHODS: [&str; 5] = ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch"];

fn seed(method: &str, soil: &Material, cells: usize) -> Problem<1> {
    let method = Method::named(method).expect("a known method");
    column_problem(SceneKind::Terzaghi, &Column::default(), soil, method, cells, 2)
        .expect("a possible column")
}

/// A run to time factors of the seed column.
fn solve<const D: usize>(
    problem: Problem<D>,
    integrator: IntegratorKind,
    rule: TimeStepRule,
    time_factors: &[f64],
) -> Outcome {
    let per_factor = 1.0 / problem.material.coefficient_of_consolidation();
    let schedule = Schedule {
        outputs: time_factors.iter().map(|factor| factor * per_factor).collect(),
        history: Vec::new(),
        rule,
        settings: ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
        kernel: Kernel::Fastest,
        integrator,
    };
    let outcome = run(problem, &schedule, &|_, _| true);
    assert_eq!(outcome.status, RunStatus::Ok);
    outcome
}

fn implicit(problem: Problem<1>, growth: f64, time_factors: &[f64]) -> Outcome {
    solve(problem, IntegratorKind::Implicit, TimeStepRule::Growth(growth), time_factors)
}

/// Largest difference of two fields over the largest value of the second.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / scale
}

#[test]
fn small_steps_end_where_the_explicit_integrator_does() {
    for method in METHODS {
        let problem = || seed(method, &Material::default(), 5);
        let explicit = solve(problem(), IntegratorKind::Explicit, TimeStepRule::Stable(0.8), &[0.05])
            .snapshots
            .remove(0);
        let fine = implicit(problem(), 0.004, &[0.05]).snapshots.remove(0);
        for (a, b) in [
            (&fine.points.pressure, &explicit.points.pressure),
            (&fine.points.effective_stress, &explicit.points.effective_stress),
            (&fine.points.displacement, &explicit.points.displacement),
            (&fine.nodes.displacement, &explicit.nodes.displacement),
            (&vec![fine.settlement], &vec![explicit.settlement]),
            (&vec![fine.totals.surface_flux], &vec![explicit.totals.surface_flux]),
        ] {
            // What is left is the inertia, c_v/(H V) = 6.6e-6.
            assert!(difference(a, b) < 2e-4, "{method}: {}", difference(a, b));
        }
    }
}

#[test]
fn the_error_in_time_falls_with_the_square_of_the_step() {
    let pressure = |growth| {
        implicit(seed("GC-SRI-patch", &Material::default(), 8), growth, &[0.2])
            .snapshots
            .remove(0)
            .points
            .pressure
    };
    let exact = pressure(0.000_5);
    let errors = [0.08, 0.04, 0.02, 0.01].map(|growth| difference(&pressure(growth), &exact));
    assert!(errors[0] < 3e-3, "{errors:?}");
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((order - 2.0).abs() < 0.15, "order {order}, {errors:?}");
}

#[test]
fn scaled_results_know_neither_the_permeability_nor_a_stiff_water() {
    let pressure = |soil: &Material| {
        let outcome = implicit(seed("GC-SRI-patch", soil, 10), 0.05, &[0.05, 0.2, 1.0]);
        let fields = outcome.snapshots.into_iter().map(|snapshot| snapshot.points.pressure);
        (fields.collect::<Vec<_>>().concat(), outcome.counters.steps)
    };
    let (seed_column, steps) = pressure(&Material::default());
    for hydraulic_conductivity in [1e-2, 1e-6, 1e-12] {
        let soil = Material { hydraulic_conductivity, ..Material::default() };
        let (tight, same_steps) = pressure(&soil);
        assert_eq!(steps, same_steps);
        assert!(difference(&tight, &seed_column) < 1e-9, "k = {hydraulic_conductivity}");
    }
    let stiff = |ratio: f64| pressure(&Material { water_bulk_modulus: ratio * 1e6, ..Material::default() }).0;
    assert!(difference(&stiff(1e6), &stiff(1e5)) < 1e-5);
}

#[test]
fn a_run_factors_once_a_step_size() {
    let counters = implicit(seed("GC-SRI-patch", &Material::default(), 10), 0.05, &[0.05, 0.2, 1.0]).counters;
    assert!(counters.steps < 160 && counters.factorisations < 25, "{counters:?}");
}

/// The seed column `across` cells wide in two dimensions, between rollers.
fn plane_column(method: &str, across: usize, cells: usize) -> Problem<2> {
    let one = seed(method, &Material::default(), cells);
    let h = one.grid.cell_size;
    let mut points = Points::<2>::lattice(h, [across, cells], 2);
    let strain = one.initial_gradient[0][0];
    points.pressure.fill(one.points.pressure[0]);
    points.effective_stress.fill(one.material.stiffness().stress(&[[0.0, 0.0], [0.0, strain]]));
    Problem {
        grid: Grid::new(h, [across, cells + 1]),
        support: Support::oedometer(),
        points,
        material: one.material,
        method: one.method,
        configuration: one.configuration,
        load: one.load,
        load_shape: crate::solver::surface::LoadShape::Uniform,
        undrained_start: false,
        loading_time: 0.0,
        initial_gradient: [[0.0, 0.0], [0.0, strain]],
        pressure_scale: one.pressure_scale,
    }
}

#[test]
fn a_plane_column_is_the_column() {
    for method in METHODS {
        let rule = TimeStepRule::Growth(0.1);
        let line = solve(seed(method, &Material::default(), 6), IntegratorKind::Implicit, rule, &[0.1]);
        let plane = solve(plane_column(method, 3, 6), IntegratorKind::Implicit, rule, &[0.1]);
        assert_eq!(line.counters.steps, plane.counters.steps);
        let (line, plane) = (&line.snapshots[0], &plane.snapshots[0]);
        assert!((line.settlement / plane.settlement - 1.0).abs() < 1e-9, "{method}");
        for (height, pressure) in plane.points.initial_height.iter().zip(&plane.points.pressure) {
            let same = line.points.initial_height.iter().position(|other| (other - height).abs() < 1e-9);
            let expected = same.map_or(f64::NAN, |point| line.points.pressure[point]);
            assert!((pressure - expected).abs() < 1e-9, "{method}: {pressure} for {expected}");
        }
    }
}
