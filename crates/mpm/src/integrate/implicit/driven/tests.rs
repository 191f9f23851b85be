use crate::run::{Kernel, Schedule, run};
use crate::tests::column_problem;
use crate::time_limit::TimeLimit;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::Method;
use oedometer_problem::outcome::Outcome;
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::FOOTING;
use oedometer_scenes::column::{Column, Footing, Undrained, column_parameters};
use oedometer_soil::base::Base;
use oedometer_soil::material::Material;

/// A run of a footing to settlements over its width.
fn pushed(column: &Column, soil: &Material, mesh: (&str, usize), settlements: &[f64]) -> Outcome {
    stepped(column, soil, mesh, settlements, TimeStep::Growth(0.1))
}

/// The same with steps by a rule.
fn stepped(
    column: &Column,
    soil: &Material,
    (method, cells): (&str, usize),
    settlements: &[f64],
    rule: TimeStep,
) -> Outcome {
    let method = Method::named(method).expect("a known method");
    let problem = column_problem::<2>(&FOOTING, column, soil, method, cells, 2).expect("a layer");
    let parameters = column_parameters(column, soil);
    let schedule = Schedule {
        outputs: settlements.iter().map(|settlement| parameters.time(*settlement)).collect(),
        critical_step: None,
        history: Vec::new(),
        notes_energy: false,
        time_step: rule,
        settings: ExplicitSettings::default(),
        kernel: Kernel::Fastest,
        integrator: IntegratorKind::Implicit,
        formulation: Formulation::QuasiStatic,
        threads: 1,
        time_limit: TimeLimit::default(),
    };
    let outcome = run(problem, &schedule, &|_, _| true);
    assert_eq!(outcome.status, Ok(()));
    outcome
}

/// Load factors of the outputs of a run on the seed soil.
fn load_factors(column: &Column, method: &str, cells: usize) -> Vec<f64> {
    let soil = (FOOTING.soil)();
    let outcome = pushed(column, &soil, (method, cells), &[0.02, 0.05]);
    let half = 0.5 * column.footing.width * soil.undrained_strength;
    outcome.snapshots.iter().map(|snapshot| snapshot.plate_force.expect("a plate") / half).collect()
}

#[test]
fn a_plate_over_the_whole_layer_strains_it_uniaxially_as_the_closed_form_says() {
    // The plate, three cells wide, covers the layer and a node beyond it: an oedometer without water.
    let footing = Footing { width: 1.0, contact: Base::Smooth, ..Footing::default() };
    let column = Column { footing, height: 1.0, ..Column::under_footing().with_extent(1.0 / 3.0) };
    let soil = Material { poissons_ratio: 0.3, ..(FOOTING.soil)() };
    let (bulk, shear) = (soil.stiffness().bulk(), soil.stiffness().shear);
    for method in ["GIMP", "GIMP-SRI", "GC-SRI-patch"] {
        let settlements = [5e-4, 2e-3, 1e-2];
        let outcome = pushed(&column, &soil, (method, 2), &settlements);
        for (snapshot, strain) in outcome.snapshots.iter().zip(settlements) {
            // s_yy = 4/3 G ε up to 2k/√3.
            let deviator = (4.0 / 3.0 * shear * strain).min(2.0 / 3.0_f64.sqrt() * soil.undrained_strength);
            let expected = (bulk * strain + deviator) / 3.0;
            let force = snapshot.plate_force.expect("a plate");
            assert!((force / expected - 1.0).abs() < 1e-8, "{method} {strain}: {force} for {expected}");
        }
    }
}

#[test]
fn full_integration_locks_and_its_cures_end_on_a_plateau_near_the_exact_load() {
    let column = Column::under_footing();
    for method in ["MPM", "GIMP"] {
        let [before, after] = load_factors(&column, method, 4)[..] else { panic!("two outputs") };
        assert!(after > 1.15 * LOAD_FACTOR && after > 1.5 * before, "{method}: {before} {after}");
    }
    for method in ["GIMP-SRI", "GIMP-mean", "GIMP-SRI-patch", "GC-SRI-patch", "GIMP-SRI-nodal", "GIMP-Bbar"] {
        let [before, after] = load_factors(&column, method, 4)[..] else { panic!("two outputs") };
        assert!((after / LOAD_FACTOR - 1.0).abs() < 0.1, "{method}: {after}");
        assert!((after - before).abs() < 0.02 * after, "{method}: {before} {after}");
    }
}

#[test]
fn the_error_of_the_load_falls_with_the_cells() {
    let error = |cells| load_factors(&Column::under_footing(), "GIMP-SRI", cells)[1] / LOAD_FACTOR - 1.0;
    let (coarse, fine) = (error(4), error(8));
    assert!(fine.abs() < 0.6 * coarse.abs(), "{coarse} {fine}");
}

#[test]
fn undrained_soil_of_two_phases_bears_the_load_of_total_stress() {
    let column = Column::under_footing();
    let footing = Footing { undrained: Undrained::TwoPhase, ..column.footing };
    let wet = Column { footing, ..column };
    let soil = Material { poissons_ratio: 0.3, ..(FOOTING.soil)() };
    let half = 0.5 * soil.undrained_strength;
    let load = |method: &str| {
        let outcome = pushed(&wet, &soil, (method, 4), &[0.05]);
        outcome.snapshots[0].plate_force.expect("a plate") / half
    };
    for method in ["GIMP-Bbar", "GIMP-Bbar-patch"] {
        let (saturated, dry) = (load(method), load_factors(&column, method, 4)[1]);
        assert!((saturated / dry - 1.0).abs() < 0.02, "{method}: {saturated} with water, {dry} without");
    }
    // A flow that keeps the volume locks in the skeleton too, where the water alone is cured.
    let alone = load("GIMP-SRI");
    assert!(alone > 1.15 * LOAD_FACTOR, "{alone}");
}

/// A single step far beyond yield finds no balance, and its halves do: together they last as long as it.
#[test]
fn a_step_that_does_not_converge_is_halved_and_ends_where_small_steps_do() {
    let column = Column::under_footing();
    let soil = (FOOTING.soil)();
    let single_step = TimeStep::Seconds(column_parameters(&column, &soil).time(0.05));
    let [single, small] = [single_step, TimeStep::Growth(0.1)]
        .map(|rule| stepped(&column, &soil, ("GIMP-SRI", 4), &[0.05], rule));
    assert!(
        single.counters.rejected_steps > 0 && small.counters.rejected_steps == 0,
        "{:?}",
        single.counters
    );
    let end_of = |outcome: &Outcome| {
        let end = &outcome.snapshots[0];
        (end.settlement, end.plate_force.expect("a plate"))
    };
    let ((settled, force), (right, load)) = (end_of(&single), end_of(&small));
    assert!((settled / right - 1.0).abs() < 1e-12, "{settled} for {right}");
    assert!((force / load - 1.0).abs() < 0.02, "{force} for {load}");
}
