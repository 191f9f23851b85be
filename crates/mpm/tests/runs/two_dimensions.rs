//! The paper's grid, 0.1 m × 1.0 m and one cell wide, against its column: one problem, two
//! dimensions, one result.

use crate::column_problem;
use crate::run;
use oedometer_exact::parameters::Base;
use oedometer_mpm::kernel::body::Discrete;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_mpm::time_limit::TimeLimit;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Basis, Memory, Method};
use oedometer_problem::outcome::Outcome;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::snapshot::Snapshot;
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::{Column, Shape};
use oedometer_scenes::{COSINE_LAYER, SINGLE_MODE, Scene, TERZAGHI, XIE_LEO};
use oedometer_soil::material::Material;

const CELLS: usize = 10;
const PER_CELL: usize = 2;

/// Runs a scene in one and in two dimensions with the same steps.
fn run_in_both_dimensions(
    scene: &'static Scene,
    method: Method,
    load: f64,
    end: f64,
    drag: Drag,
) -> (Outcome, Outcome) {
    let soil = Material { law: (scene.soil)().law, ..Material::default() };
    let column = Column { load, ..Column::default() };
    let plane = Column { dimensions: 2, ..column };
    let schedule = Schedule {
        critical_step: None,
        outputs: vec![0.5 * end, end],
        history: vec![0.25 * end],
        notes_energy: false,
        time_step: TimeStep::Seconds(1.2e-5),
        settings: ExplicitSettings { drag, ..ExplicitSettings::default() },
        kernel: Kernel::PointWise,
        integrator: IntegratorKind::Explicit,
        formulation: IntegratorKind::Explicit.default_formulation(),
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let narrow = column_problem::<1>(scene, &column, &soil, method, CELLS, PER_CELL).expect("the seed");
    let wide = column_problem::<2>(scene, &plane, &soil, method, CELLS, PER_CELL).expect("the seed");
    (run(narrow, &schedule), run(wide, &schedule))
}

/// Largest difference of two fields over the largest value of the first, point by point: the plane
/// has two points side by side for each of the column.
fn difference(column: &[f64], plane: &[f64]) -> f64 {
    assert_eq!(plane.len(), PER_CELL * column.len());
    let scale = column.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    let pairs = plane.iter().enumerate().map(|(point, value)| (value, column[point / PER_CELL]));
    pairs.fold(0.0, |worst: f64, (plane, column)| worst.max((plane - column).abs())) / scale
}

fn assert_same(what: &str, column: &Outcome, plane: &Outcome, tolerance: f64) {
    assert_eq!(column.status, Ok(()), "{what}");
    assert_eq!(plane.status, Ok(()), "{what}");
    assert_eq!(column.counters.steps, plane.counters.steps, "{what}");
    for (column, plane) in column.snapshots.iter().zip(&plane.snapshots) {
        let fields: [fn(&Snapshot) -> &Vec<f64>; 3] = [
            |snapshot| &snapshot.points.pressure,
            |snapshot| &snapshot.points.effective_stress,
            |snapshot| &snapshot.points.displacement,
        ];
        for field in fields {
            let worst = difference(field(column), field(plane));
            assert!(worst < tolerance, "{what} at {} s: {worst:e}", column.time);
        }
        let settled = (plane.settlement / column.settlement - 1.0).abs();
        assert!(settled < tolerance, "{what}: settlement {settled:e}");
        let sideways = plane.points.plane.as_ref().expect("two dimensions");
        let drift = sideways.horizontal_displacement.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        assert!(drift < tolerance * column.settlement.abs(), "{what}: {drift:e} m sideways");
    }
}

/// Every method that has a name, and B-splines with each strain gradient and place of the pressure.
fn methods() -> Vec<Method> {
    let named = Method::names().into_iter().map(|name| Method::named(&name).expect("its own name"));
    let like = |name: &str, basis| Method { basis, ..Method::named(name).expect("a known method") };
    let splines = [Basis::Bspline2, Basis::Bspline3].into_iter().flat_map(|basis| {
        [
            "GIMP",
            "GIMP-SRI",
            "GIMP-SRI-patch",
            "GC-SRI-patch",
            "GIMP-Bbar-patch",
            "GIMP-mean",
            "TL-GC-SRI-patch",
        ]
        .map(|name| like(name, basis))
    });
    named.chain(splines).collect()
}

#[test]
fn the_paper_s_grid_is_its_column_at_small_strain_whatever_the_method() {
    for scene in [&TERZAGHI, &SINGLE_MODE] {
        for method in methods().into_iter().filter(|method| method.configuration.is_none()) {
            let (column, plane) = run_in_both_dimensions(scene, method, 1e3, 0.005, Drag::Explicit);
            assert_same(&format!("{} {method}", scene.name), &column, &plane, 1e-10);
        }
    }
}

#[test]
fn the_paper_s_grid_is_its_column_at_200_kpa_whatever_the_method() {
    // Points of a column share the length of their cell (`-cells`); domains that turn do so in the column alone.
    let turns = |method: &Method| method.basis == Basis::Cpdi && method.memory == Memory::Cells;
    for method in methods().into_iter().filter(|method| !turns(method)) {
        let (column, plane) = run_in_both_dimensions(&XIE_LEO, method, 2e5, 0.015, Drag::Implicit);
        assert_same(&format!("xie-leo {method}"), &column, &plane, 1e-9);
    }
}

/// The seed layer on 6 × 6 cells.
fn layer(method: &str, base: Base) -> Discrete<2> {
    let (column, soil) =
        (Column { shape: Shape::Layer { length: 1.0, base }, ..Column::layer() }, Material::default());
    let method = Method::named(method).expect("a known method");
    column_problem(&COSINE_LAYER, &column, &soil, method, 6, PER_CELL).expect("the seed layer")
}

#[test]
fn the_assembled_plane_is_the_point_wise_step_to_round_off() {
    for name in Method::names().iter().filter(|name| !name.starts_with(['T', 'u'])) {
        for (drag, flip, mapping_back) in
            [(Drag::Explicit, 1.0, true), (Drag::Implicit, 1.0, false), (Drag::Implicit, 0.99, true)]
        {
            let run_by = |kernel: Kernel| {
                let schedule = Schedule {
                    // Any step above that of the run: to search for the critical one takes far longer than the run.
                    critical_step: Some(1e-3),
                    outputs: vec![0.0, 0.001],
                    history: vec![0.0005],
                    notes_energy: false,
                    time_step: TimeStep::Seconds(1e-5),
                    settings: ExplicitSettings { drag, flip, mapping_back, ..ExplicitSettings::default() },
                    kernel,
                    integrator: IntegratorKind::Explicit,
                    formulation: IntegratorKind::Explicit.default_formulation(),
                    threads: 1,
                    time_limit: TimeLimit::default(),
                };
                run(layer(name, Base::Rough), &schedule)
            };
            let (fast, plain) = (run_by(Kernel::Fastest), run_by(Kernel::PointWise));
            assert_eq!(fast.status, Ok(()), "{name}");
            assert_eq!(fast.counters, plain.counters);
            let (fast, plain) = (&fast.snapshots[1], &plain.snapshots[1]);
            let sideways =
                |snapshot: &Snapshot| snapshot.nodes.plane.clone().expect("a plane").horizontal_displacement;
            for (a, b) in [
                (&fast.points.pressure, &plain.points.pressure),
                (&fast.points.effective_stress, &plain.points.effective_stress),
                (&fast.points.displacement, &plain.points.displacement),
                (&sideways(fast), &sideways(plain)),
                (&vec![fast.settlement], &vec![plain.settlement]),
            ] {
                let scale = b.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
                for (x, y) in a.iter().zip(b) {
                    assert!((x - y).abs() <= 1e-10 * scale, "{name} {drag:?} {flip}: {x} for {y}");
                }
            }
        }
    }
}

#[test]
fn the_predicted_step_of_a_plane_separates_stable_from_unstable_runs() {
    for name in ["GIMP", "GIMP-SRI", "GC-SRI-patch", "PPP", "GC-Bbar-patch"] {
        for mapping_back in [true, false] {
            for (share, stable) in [(0.98, true), (1.02, false)] {
                let schedule = Schedule {
                    critical_step: None,
                    outputs: vec![0.3],
                    history: Vec::new(),
                    notes_energy: false,
                    time_step: TimeStep::Stable(share),
                    settings: ExplicitSettings { mapping_back, ..ExplicitSettings::default() },
                    kernel: Kernel::Fastest,
                    integrator: IntegratorKind::Explicit,
                    formulation: IntegratorKind::Explicit.default_formulation(),
                    threads: 1,
                    time_limit: TimeLimit::default(),
                };
                let outcome = run(layer(name, Base::Smooth), &schedule);
                let limit = outcome.step_sizes.predicted_critical;
                assert_eq!(outcome.status.is_ok(), stable, "{name} {mapping_back} {share}: {limit:e}");
            }
        }
    }
}
