//! One integrator against the other, step by step; whole runs are in `crates/mpm/tests/runs/implicit.rs`.

use crate::integrate::implicit::linear::LinearStepper;
use crate::integrate::implicit::newton::NewtonStepper;
use crate::integrate::implicit::trial::{Skeleton, Trial};
use crate::integrate::implicit::unknowns::Unknowns;
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{EqualSteps, Stepper};
use crate::kernel::body::{Body, Discrete};
use crate::run::{Kernel, Schedule};
use crate::tests::column_problem;
use crate::time_limit::TimeLimit;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::Method;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::Column;
use oedometer_scenes::{TERZAGHI, XIE_LEO};
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

fn seed(method: &str, soil: &Material, cells: usize) -> Discrete<1> {
    let method = Method::named(method).expect("a known method");
    column_problem(&TERZAGHI, &Column::default(), soil, method, cells, 2).expect("a possible column")
}

fn large_strain(method: &str, soil: &Material, cells: usize) -> Discrete<1> {
    let method = Method::named(method).expect("a known method");
    let column = Column { load: 2e5, ..Column::default() };
    column_problem(&XIE_LEO, &column, soil, method, cells, 4).expect("a possible column")
}

fn schedule() -> Schedule {
    Schedule {
        critical_step: None,
        outputs: Vec::new(),
        history: Vec::new(),
        notes_energy: false,
        time_step: TimeStep::Seconds(1.0),
        settings: ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
        kernel: Kernel::Fastest,
        formulation: IntegratorKind::Implicit.default_formulation(),
        integrator: IntegratorKind::Implicit,
        threads: 1,
        time_limit: TimeLimit::default(),
    }
}

/// Largest difference of two fields over the largest value of the second.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / scale
}

#[test]
fn newton_on_a_frozen_body_is_the_linear_system() {
    for name in ["GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "GIMP-mean", "GIMP-SRI-nodal"] {
        let body = || Body::new(seed(name, &Material::default(), 6));
        let schedule = schedule();
        let plan = Plan::new(&seed(name, &Material::default(), 6), &schedule);
        let mut linear = LinearStepper::new(body(), &plan);
        let mut newton = NewtonStepper::new(body(), &plan);
        for dt in [0.05, 0.05, 0.1, 0.1, 0.3] {
            let step = EqualSteps::first(0.0, dt, 1);
            let estimates = [linear.advance(&step, 1.0), newton.advance(&step, 1.0)]
                .map(|error| error.expect("solvable"));
            assert!((estimates[0] / estimates[1] - 1.0).abs() < 1e-6, "{name}: {estimates:?}");
        }
        let (by_linear, by_newton) = (linear.snapshot(0.6), newton.snapshot(0.6));
        assert!(difference(&by_newton.points.pressure, &by_linear.points.pressure) < 1e-9, "{name}");
        assert!((by_linear.settlement / by_newton.settlement - 1.0).abs() < 1e-9, "{name}");
        let rates = [linear.settlement_rate(), newton.settlement_rate()].map(|rate| rate.expect("a rate"));
        assert!((rates[0] / rates[1] - 1.0).abs() < 1e-6, "{name}");
        let flux = by_linear.totals.surface_flux - by_newton.totals.surface_flux;
        assert!(flux.abs() < 1e-8 * by_linear.settlement, "{name}");
    }
}

#[test]
fn a_rejected_step_leaves_the_history_of_the_soil_unchanged() {
    let soil = Material {
        law: Law::Preconsolidated,
        reload_modulus: 4.8e6,
        preconsolidation: 0.3,
        ..Material::default()
    };
    let trial = || {
        let body = Body::new(seed("GIMP-SRI-patch", &soil, 6));
        Trial::new(body, Formulation::QuasiStatic, Skeleton::Implicit)
    };
    let (mut tried, mut fresh) = (trial(), trial());
    let along = |trial: &Trial<1>, strain: f64| {
        let mut increments = vec![0.0; trial.unknowns.count];
        for (node, [number]) in trial.unknowns.displacement.iter().enumerate() {
            if let Some(number) = number {
                let height = trial.body.grid.node_position(node)[0] / trial.unknowns.scales.length;
                increments[*number] = -strain * height;
            }
        }
        increments
    };
    // 0.48 Pa at the modulus of reloading is beyond the yield stress, 0.048 Pa is not.
    tried.move_to(&along(&tried, 1e-7));
    assert!(tried.body.points.history.iter().all(|history| history.yield_stress > 0.3), "it yields");
    assert!(tried.anchor.history.iter().all(|history| history.yield_stress == 0.3), "an anchor stays");
    for trial in [&mut tried, &mut fresh] {
        trial.move_to(&along(trial, 1e-8));
    }
    assert_eq!(tried.body.points, fresh.body.points, "nothing is left of the larger trial");
    fresh.end_step(&along(&fresh, 1e-7), 0.0);
    assert!(fresh.anchor.history.iter().all(|history| history.yield_stress > 0.3), "an end is kept");
    // Whole steps: one that is refused for its error, and one without it.
    let schedule = schedule();
    let plan = Plan::new(&seed("GIMP-SRI-patch", &soil, 6), &schedule);
    let settled = [true, false].map(|is_refused| {
        let mut newton = NewtonStepper::new(Body::new(seed("GIMP-SRI-patch", &soil, 6)), &plan);
        if is_refused {
            newton.advance(&EqualSteps::first(0.0, 2.0, 1), 1e-9).expect("solvable");
            assert_eq!(newton.work().rejected_steps, 1);
        }
        newton.advance(&EqualSteps::first(0.0, 0.5, 1), f64::INFINITY).expect("solvable");
        newton.snapshot(0.5)
    });
    let [after, without] = &settled;
    assert!(difference(&after.points.pressure, &without.points.pressure) < 1e-9);
    assert!((after.settlement / without.settlement - 1.0).abs() < 1e-9);
}

#[test]
fn an_unloaded_column_keeps_its_plastic_strain_and_reloads_stiffly() {
    let (virgin, reload, preconsolidation) = (Material::default().oedometric_modulus(), 6e6, 0.3);
    let soil = Material {
        law: Law::Preconsolidated,
        reload_modulus: reload,
        preconsolidation,
        ..Material::default()
    };
    let problem = || seed("GIMP-SRI-patch", &soil, 6);
    let schedule = schedule();
    let plan = Plan::new(&problem(), &schedule);
    let mut newton = NewtonStepper::new(Body::new(problem()), &plan);
    let (start, full_load) = (newton.settlement(), newton.trial.body.actions.surface.load);
    // The seed's start is that of a linear soil: the load of the start is in its strain.
    let mut settled_under = |share: f64| {
        newton.trial.body.actions.surface.load = share * full_load;
        newton.trial.body.apply_loads();
        // Steps that grow: L-stable ones that are too large overshoot, and what has yielded stays.
        let mut dt = 0.01;
        for _ in 0..120 {
            newton.advance(&EqualSteps::first(0.0, dt, 1), f64::INFINITY).expect("solvable");
            dt *= 1.1;
        }
        newton.settlement() - start
    };
    let (loaded, unloaded, reloaded, beyond) =
        (settled_under(1.0), settled_under(0.0), settled_under(1.0), settled_under(1.5));
    let stiff = 1.0 / reload;
    assert!(((loaded - unloaded) * reload - 1.0).abs() < 1e-6, "unloading: {loaded} {unloaded}");
    assert!(
        (reloaded / loaded - 1.0).abs() < 1e-6,
        "reloading ends at {reloaded}, unloading began at {loaded}"
    );
    assert!(((beyond - reloaded) * virgin / 0.5 - 1.0).abs() < 1e-6, "beyond it the soil is soft again");
    let residual = (1.0 - preconsolidation) * (1.0 / virgin - stiff);
    let undrained = seed("GIMP-SRI-patch", &soil, 6).initial_gradient[0][0];
    let gap = unloaded - undrained - residual;
    assert!(gap.abs() < 1e-3 * residual, "residual settlement: {unloaded} for {residual}");
}

/// Settlement and pressures from the base up of a preconsolidated column of 1 m under loads `(share of 1 Pa, seconds)`,
/// each at once: finite volumes, explicit in time.
fn finite_volumes(soil: &Material, cells: usize, loads: &[(f64, f64)]) -> (f64, Vec<f64>) {
    let size = 1.0 / cells as f64;
    let (virgin, reload) = (soil.oedometric_modulus(), soil.reload_modulus);
    let (water, mobility) =
        (1.0 / soil.coupling_modulus(), soil.hydraulic_conductivity / soil.unit_weight_of_water());
    let mut pressure = vec![0.0; cells];
    let (mut stress, mut largest) = (vec![0.0; cells], vec![soil.preconsolidation; cells]);
    let (mut settlement, mut load) = (0.0, 0.0);
    for &(share, seconds) in loads {
        let longest = 0.25 * size * size / (mobility * reload);
        let steps = (0..31).map(|power| 1_u32 << power).find(|steps| seconds <= longest * f64::from(*steps));
        let steps = steps.expect("not that many");
        let dt = seconds / f64::from(steps);
        for step in 0..steps {
            // The load of the phase comes on with its first step.
            let more = if step == 0 { share - load } else { 0.0 };
            let flux = |i: usize| match pressure.get(i + 1) {
                Some(above) => mobility * (pressure[i] - above) / size,
                None => mobility * pressure[i] / (0.5 * size),
            };
            let flows: Vec<f64> = (0..cells).map(flux).collect();
            for i in 0..cells {
                let outflow = flows[i] - if i == 0 { 0.0 } else { flows[i - 1] };
                let out = dt * outflow / size;
                // Where it has yielded it yields on as its stress grows.
                let yields = stress[i] >= largest[i] && water * more + out > 0.0;
                let modulus = if yields { virgin } else { reload };
                let change = (more / modulus - out) / (1.0 / modulus + water);
                stress[i] += more - change;
                settlement += size * (more - change) / modulus;
                largest[i] = largest[i].max(stress[i]);
                pressure[i] += change;
            }
        }
        load = share;
    }
    (settlement, pressure)
}

#[test]
fn loading_unloading_and_reloading_follow_finite_volumes() {
    let soil = Material {
        law: Law::Preconsolidated,
        reload_modulus: 4.8e6,
        preconsolidation: 0.3,
        ..Material::default()
    };
    let problem = || seed("GIMP-SRI-patch", &soil, 20);
    let schedule = schedule();
    let plan = Plan::new(&problem(), &schedule);
    let mut newton = NewtonStepper::new(Body::new(problem()), &plan);
    let (start, full_load) = (newton.settlement(), newton.trial.body.actions.surface.load);
    let (mut loads, mut references) = (Vec::new(), Vec::new());
    // The front stops on its way, and is met again.
    for share in [1.0, 0.1, 1.2] {
        newton.trial.body.actions.surface.load = share * full_load;
        newton.trial.body.apply_loads();
        let (mut dt, mut seconds) = (0.002, 0.0);
        for _ in 0..90 {
            newton.advance(&EqualSteps::first(0.0, dt, 1), f64::INFINITY).expect("solvable");
            (seconds, dt) = (seconds + dt, 1.08 * dt);
        }
        loads.push((share, seconds));
        let [coarse, fine] = [40, 80].map(|cells| finite_volumes(&soil, cells, &loads));
        // The seed starts undrained, and the settlement of that is in its start.
        let settlement = newton.settlement() - start;
        references.push([
            settlement,
            coarse.0,
            fine.0,
            newton.snapshot(0.0).points.pressure[0],
            coarse.1[0],
            fine.1[0],
        ]);
    }
    for [settlement, coarse, fine, pressure, coarse_pressure, fine_pressure] in &references {
        // The errors are of first order in the step: twice the finer less the coarser is their limit.
        let [limit, limit_pressure] = [2.0 * fine - coarse, 2.0 * fine_pressure - coarse_pressure];
        let misses = [settlement / limit - 1.0, pressure - limit_pressure];
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{references:?}");
        assert!(misses.iter().all(|miss| miss.abs() < 2e-3), "{references:?}");
    }
}

#[test]
fn unknowns_renumbered_as_points_empty_cells_equal_a_fresh_numbering() {
    let soil = Material { law: Law::LogLinear, ..Material::default() };
    for method in ["GIMP-SRI-patch", "CE-SRI-patch-cells", "GIMP", "GC-Bbar-patch"] {
        let body = Body::new(large_strain(method, &soil, 8));
        let mut trial = Trial::new(body, Formulation::QuasiStatic, Skeleton::Implicit);
        let (count, mut renumbered) = (trial.unknowns.count, 0);
        for _ in 0..12 {
            // Three per cent of the height a step: the cell at the top ends empty.
            let mut increments = vec![0.0; trial.unknowns.count];
            for (node, [number]) in trial.unknowns.displacement.iter().enumerate() {
                let height = trial.body.grid.node_position(node)[0] / trial.unknowns.scales.length;
                if let Some(number) = number {
                    increments[*number] = -0.03 * height;
                }
            }
            trial.begin_step(0.0);
            trial.end_step(&increments, 0.0);
            let anew = Unknowns::new(&trial.body);
            let followed = &trial.unknowns;
            assert_eq!(
                (&followed.displacement, &followed.pressure, &followed.rows.sites, followed.count),
                (&anew.displacement, &anew.pressure, &anew.rows.sites, anew.count),
                "{method}"
            );
            renumbered += usize::from(anew.count != count);
            trial.unknowns.take_rows(&trial.body);
            assert_eq!(trial.unknowns.rows, anew.rows, "{method}");
        }
        assert!(renumbered > 0, "{method}");
    }
}
