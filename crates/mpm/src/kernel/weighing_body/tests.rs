//! Weight in the balances: a column at rest stays at rest under every method, and results give the excess.

use super::*;
use crate::kernel::body::Discrete;
use crate::tests::column_problem;
use oedometer_problem::method::Method;
use oedometer_problem::settings::{Drag, ExplicitSettings};
use oedometer_scenes::column::Column;
use oedometer_scenes::{AT_REST, Scene, TERZAGHI, XIE_LEO};
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

fn resting(method: &str, configuration: Configuration) -> Discrete<1> {
    let column = (AT_REST.column)();
    assert!(column.self_weight);
    let method =
        Method { configuration: Some(configuration), ..Method::named(method).expect("a known method") };
    column_problem::<1>(&AT_REST, &column, &Material::default(), method, 6, 2).expect("a column")
}

#[test]
fn a_column_under_its_weight_rests_whatever_the_method() {
    for method in ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch", "uGIMP-SRI-patch"] {
        for configuration in [Configuration::Frozen, Configuration::Updated, Configuration::Total] {
            let mut body = Body::new(resting(method, configuration));
            // The base carries the saturated column: 21 kPa.
            let base = body.points.pressure[0] - body.points.effective_stress[0][0][0];
            assert!((base / (2155.0 * 9.81) - 11.5 / 12.0).abs() < 1e-12, "{base}");
            assert!(
                body.unbalanced_force() < 1e-11,
                "{method} {configuration:?}: {}",
                body.unbalanced_force()
            );
            let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
            for _ in 0..2000 {
                body.explicit_step(2e-5, &settings);
            }
            // Over the conductivity of 1e-4 m/s: twelve digits.
            assert!(
                body.largest_velocity() < 1e-16,
                "{method} {configuration:?}: {}",
                body.largest_velocity()
            );
        }
    }
}

#[test]
fn an_unbalanced_weight_moves() {
    let mut problem = resting("GIMP-SRI", Configuration::Frozen);
    problem.points.pressure[3] += 1e-6;
    let mut body = Body::new(problem);
    for _ in 0..10 {
        body.explicit_step(2e-5, &ExplicitSettings::default());
    }
    assert!(body.largest_velocity() > 1e-14);
}

#[test]
fn results_give_the_excess_and_a_settled_surface_lies_under_free_water() {
    for configuration in [Configuration::Updated, Configuration::Total] {
        let column = Column { load: 2e5, self_weight: true, ..Column::default() };
        let soil = Material { law: Law::LogLinear, ..Material::default() };
        let method =
            Method { configuration: Some(configuration), ..Method::named("GIMP-SRI").expect("known") };
        let problem = column_problem::<1>(&XIE_LEO, &column, &soil, method, 8, 2).expect("a column");
        let excess = problem.points.pressure[0];
        let mut body = Body::new(problem);
        let in_excess = body.in_excess().expect("it weighs");
        for pressure in &in_excess.points.pressure {
            assert!((pressure / excess - 1.0).abs() < 1e-12, "{pressure}");
        }
        // Half a metre down without a change of stress: the free water presses with γ_w/2 on both phases.
        let weights = body.actions.surface.weights(&body.grid, &body.points);
        let (top_node, share) = weights.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("a node");
        let top =
            |body: &Body<1>| (body.nodes.mixture_force[top_node][0], body.nodes.water_force[top_node][0]);
        body.map_forces();
        let before = top(&body);
        body.actions.weight.as_mut().expect("it weighs").rise = -0.5;
        body.map_forces();
        let after = top(&body);
        for (after, before) in [(after.0, before.0), (after.1, before.1)] {
            assert!((before - after - share * 0.5 * 9810.0).abs() < 1e-6, "{before} {after} {share}");
        }
    }
}

#[test]
fn a_point_that_has_sunk_lies_under_more_water() {
    for configuration in [Configuration::Updated, Configuration::Total] {
        let column = Column { self_weight: true, ..Column::default() };
        let soil = Material { law: Law::LogLinear, ..Material::default() };
        let method = Method { configuration: Some(configuration), ..Method::named("GIMP").expect("known") };
        let problem = column_problem::<1>(&XIE_LEO, &column, &soil, method, 4, 2).expect("a column");
        let mut body = Body::new(problem);
        let before = body.hydrostatic_pressure(5);
        body.points.position[5][0] -= 0.1;
        body.points.displacement[5][0] -= 0.1;
        assert!((body.hydrostatic_pressure(5) - before - 981.0).abs() < 1e-9, "{configuration:?}");
    }
}

#[test]
fn a_weight_that_points_integrate_inexactly_is_balanced_at_the_start() {
    let spline = Method {
        basis: oedometer_problem::method::Basis::Bspline2,
        ..Method::named("GIMP-SRI").expect("known")
    };
    for (method, jitter) in [(Method::named("GIMP-SRI").expect("known"), 0.2), (spline, 0.0), (spline, 0.2)] {
        for configuration in [Configuration::Frozen, Configuration::Updated, Configuration::Total] {
            let method = Method { configuration: Some(configuration), ..method };
            let start = |scene: &'static Scene, self_weight: bool, load: f64| {
                let mut column = Column { load, self_weight, ..Column::default() };
                column.points.jitter = jitter;
                let problem = column_problem::<1>(scene, &column, &Material::default(), method, 8, 2);
                Body::new(problem.expect("a column"))
            };
            // Only the load leaves points off their lattice unbalanced, with weight as without.
            let [mut weighing, mut weightless] = [true, false].map(|weighs| start(&TERZAGHI, weighs, 1.0));
            weighing.map_forces();
            weightless.map_forces();
            let pairs = |field: fn(&Body<1>) -> &Vec<Vector<1>>| -> f64 {
                let free = weighing.nodes.free.iter();
                let pairs = field(&weighing).iter().zip(field(&weightless)).zip(free);
                pairs
                    .map(|((with_weight, without), free)| (with_weight[0] - without[0]).abs() * free[0])
                    .fold(0.0, f64::max)
            };
            let apart = [pairs(|body| &body.nodes.mixture_force), pairs(|body| &body.nodes.water_force)];
            assert!(
                apart.iter().all(|apart| *apart < 1e-9),
                "{} {configuration:?}: {apart:?}",
                method.basis.name()
            );
            // A column at rest is there to show it: three thousandths of its 21 kPa and more.
            assert!(start(&AT_REST, true, 1.0).unbalanced_force() > 60.0);
        }
    }
}
