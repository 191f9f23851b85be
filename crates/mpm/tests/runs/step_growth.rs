//! No pair of eigenvalues of the explicit step grows in the plane: of the program's own step, applied to one unit of each
//! unknown after the other, for every method, boundary, treatment of the drag, and with mapping back and without.
//!
//! A run of thirty thousand steps cannot show what these show in seconds: what doubles in ten thousand of them. For the
//! combinations named here something grows under any step, and the program must say so.

use crate::discretised;
use crate::run;
use oedometer_exact::parameters::Base;
use oedometer_mpm::discretise::Discretised;
use oedometer_mpm::run::{Kernel, Schedule};
use oedometer_problem::critical_step::Probe;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::column::{Column, Shape};
use oedometer_scenes::{COSINE_LAYER, MANDEL, XIE_LEO};
use oedometer_soil::material::Material;

/// A doubling in seventy thousand steps.
const NO_GROWTH: f64 = 1e-5;
/// Share of the predicted step.
const SHARE: f64 = 0.8;

/// A small plane of a method.
fn plane(method: &str, boundary: &str, cells: usize, conductivity: f64) -> Discretised {
    let (scene, column) = match boundary {
        "rough" => (&COSINE_LAYER, Column::layer()),
        "smooth" => (
            &COSINE_LAYER,
            Column { shape: Shape::Layer { length: 1.0, base: Base::Smooth }, ..Column::layer() },
        ),
        _ => (&MANDEL, Column::slab().with_extent(0.5)),
    };
    let soil = Material { hydraulic_conductivity: conductivity, ..Material::default() };
    let method = Method::named(method).expect("a known method");
    discretised(scene, &column, &soil, method, cells, 2).expect("a plane")
}

/// Growth a step at a share of the predicted one; none where no limit is known.
fn growth_of(problem: &Discretised, settings: &ExplicitSettings) -> Option<f64> {
    let predicted = problem.known_critical_step(settings)?;
    Some(problem.growth_under(settings, SHARE * predicted).expect("a small plane") - 1.0)
}

/// The names of combinations in which no limit is known; none of the others may grow.
fn without_limit(
    methods: &[String],
    boundary: &str,
    cells: usize,
    conductivities: &[(Drag, f64)],
) -> Vec<String> {
    let mut names = Vec::new();
    for method in methods {
        for (drag, conductivity) in conductivities {
            let problem = plane(method, boundary, cells, *conductivity);
            for mapping_back in [true, false] {
                let settings = ExplicitSettings { drag: *drag, mapping_back, ..ExplicitSettings::default() };
                let mapped = if mapping_back { "mapped back" } else { "not mapped back" };
                let name = format!("{method} {boundary} {cells} {drag:?} {conductivity:e} {mapped}");
                match growth_of(&problem, &settings) {
                    None => names.push(name),
                    Some(growth) => assert!(growth <= NO_GROWTH, "{name}: {growth:e} a step"),
                }
            }
        }
    }
    names
}

/// Every method with operators of its own at the start: `u`, `TL-`, `-cells` and `-moments` have those of the name behind
/// or before, and in one soil so has `-soils`.
fn methods() -> Vec<String> {
    let same = ["-cells", "-moments", "-soils"];
    let is_distinct = |name: &String| {
        !name.starts_with(['u'])
            && !name.starts_with("TL-")
            && !same.iter().any(|ending| name.ends_with(ending))
    };
    Method::names().into_iter().filter(is_distinct).collect()
}

const DRAGS: [(Drag, f64); 3] = [(Drag::Explicit, 1e-3), (Drag::Centred, 1e-8), (Drag::Implicit, 1e-8)];

#[test]
fn nothing_grows_on_a_rough_base() {
    assert_eq!(without_limit(&methods(), "rough", 4, &DRAGS), [""; 0]);
}

#[test]
fn nothing_grows_on_a_smooth_base() {
    assert_eq!(without_limit(&methods(), "smooth", 3, &DRAGS), [""; 0]);
}

#[test]
fn nothing_grows_under_a_plate() {
    // Rates of a patch are not the adjoint of the points' forces; where cubic splines meet next to no drag their waves grow,
    // and the program says that no limit is known.
    let unlimited = without_limit(&methods(), "plate", 4, &DRAGS);
    assert_eq!(unlimited, ["B3-SRI-patch plate 4 Explicit 1e-3 mapped back"]);
}

#[test]
fn with_little_drag_a_rough_base_of_more_cells_has_no_limit() {
    let ladder = ["GC-SRI-patch".to_owned()];
    let weak = [(Drag::Implicit, 1e-3), (Drag::Implicit, 0.1)];
    // Rates of a patch are not the adjoint of the points' forces; with next to no drag their waves grow.
    assert_eq!(without_limit(&ladder, "rough", 6, &weak), ["GC-SRI-patch rough 6 Implicit 1e-1 mapped back"]);
}

#[test]
fn stable_steps_are_refused_where_a_mode_grows_far_and_give_its_growth_elsewhere() {
    let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
    let schedule = |end, rule| Schedule {
        // The last output ends the run.
        outputs: vec![0.01 * end, end],
        history: Vec::new(),
        notes_energy: false,
        time_step: rule,
        settings,
        kernel: Kernel::Fastest,
        integrator: IntegratorKind::Explicit,
        critical_step: None,
        formulation: IntegratorKind::Explicit.default_formulation(),
        threads: 1,
        time_limit: oedometer_mpm::time_limit::TimeLimit::default(),
    };
    let problem = || plane("GC-SRI-patch", "rough", 6, 0.1);
    let step = problem().predicted_critical_step(&settings);
    let rate = problem().growth_under(&settings, step).expect("a small plane").ln() / step;
    // The time in which the mode grows by a hundred times.
    let end = 100.0_f64.ln() / rate;
    let share = TimeStep::Stable(0.5);
    let Err(failure) = run(problem(), &schedule(1.05 * end, share)).status else {
        panic!("it ran");
    };
    assert!(failure.step == 0 && failure.reason.starts_with("no limit is known: "), "{}", failure.reason);
    let run_of = |end, rule| {
        let outcome = run(problem(), &schedule(end, rule));
        assert_eq!(outcome.status, Ok(()));
        outcome.step_sizes
    };
    let sizes = run_of(0.5 * end, share);
    let of_step = problem().growth_under(&settings, sizes.target).expect("a small plane");
    let wanted = of_step.powf(0.5 * end / sizes.target);
    let growth = sizes.growth.expect("a mode grows");
    assert!(growth > 2.0 && (growth / wanted - 1.0).abs() < 1e-3, "{growth} for {wanted}");
    assert_eq!(run_of(1e-6, TimeStep::Seconds(1e-7)).growth, None, "steps as they are asked for");
}

#[test]
fn the_predicted_step_of_a_plane_is_the_observed_one_where_growth_begins_slowly() {
    let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
    let problem = plane("GC-SRI-patch", "rough", 8, 1e-7);
    let limit = problem.critical_step(&settings, 0.0, 0, &|_, _| true).expect("nobody stops it");
    let deviation = limit.deviation().expect("a step that fails");
    assert!(limit.probes_agree() && deviation.abs() < 0.03, "{limit:?}");
    // What the eigenvalues say of the probes themselves: a doubling in ten thousand steps beyond the limit alone.
    let grows = |probe: &Probe| probe.predicted_growth.map(|growth| growth > 1.0 + 6.9e-5);
    assert!(limit.probes.iter().all(|probe| grows(probe) == Some(probe.share > 1.0)), "{limit:?}");
}

#[test]
fn the_predicted_step_of_f_bar_is_the_observed_one_at_large_strain() {
    let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
    let column = Column { load: 1e5, dimensions: 2, ..Column::default() }.with_extent(0.5);
    for name in ["GIMP-Bbar", "GC-Bbar-patch", "VP-Bbar", "TL-GC-Bbar-patch"] {
        let method = Method::named(name).expect("a known method");
        let problem = discretised(&XIE_LEO, &column, &Material::default(), method, 4, 2);
        let limit = problem.expect("a column").critical_step(&settings, 0.0, 0, &|_, _| true);
        let limit = limit.expect("nobody stops it");
        let deviation = limit.deviation().expect("a step that fails");
        assert!(limit.probes_agree() && deviation.abs() < 0.03, "{name}: {limit:?}");
    }
}
