//! A body on which body forces and a source act: one step against what they give, and the places that they are
//! taken at.

use super::*;
use crate::actions::forcing::{BodyForces, Forcing};
use crate::tests::column_problem;
use oedometer_problem::integrator::Formulation;
use oedometer_problem::method::Method;
use oedometer_scenes::MANUFACTURED_BOX;
use std::sync::Arc;

/// Constant forces, and a source that is the place along x, so that it says where it was asked for.
#[derive(Debug)]
struct Plain;

impl Forcing<2> for Plain {
    fn body_forces(&self, _: Formulation, _: &[Vector<2>], time: f64, forces: &mut [BodyForces<2>]) {
        forces.fill([[3.0 + time, -2.0], [0.5, 0.25]]);
    }
    fn sources(
        &self,
        places: &[Vector<2>],
        sites: &mut dyn Iterator<Item = usize>,
        time: f64,
        sources: &mut [f64],
    ) {
        sites.for_each(|site| sources[site] = places[site][0] + 10.0 * time);
    }
    fn material_places(
        &self,
        present: &dyn Fn(usize) -> Vector<2>,
        sites: &mut dyn Iterator<Item = usize>,
        _: f64,
        places: &mut [Vector<2>],
    ) {
        // The body was moved by a tenth along x.
        sites.for_each(|site| places[site] = [present(site)[0] - 0.1, present(site)[1]]);
    }
}

fn body(method: &str) -> Body<2> {
    let scene = &MANUFACTURED_BOX;
    let (column, soil) = ((scene.column)(), (scene.soil)());
    let method = Method::named(method).expect("a method");
    let mut problem = column_problem::<2>(scene, &column, &soil, method, 4, 2).expect("the unit square");
    problem.forcing = Some(Arc::new(Plain));
    let mut body = Body::new(problem);
    body.begin_forced_step(1.5);
    body
}

#[test]
fn nodal_body_forces_sum_to_those_of_the_volume() {
    for method in ["GIMP-SRI-patch", "TL-GIMP", "uGIMP-SRI", "CPDI-SRI-patch"] {
        let mut body = body(method);
        // Half the volume everywhere: forces are of the current one.
        body.points.volume_ratio.fill(0.5);
        body.map_forces();
        let sum = |forces: &[Vector<2>], d: usize| forces.iter().map(|force| force[d]).sum::<f64>();
        let nodes = &body.nodes;
        for (got, exact) in [
            (sum(&nodes.mixture_force, 0), 0.5 * 4.5),
            (sum(&nodes.mixture_force, 1), -1.0),
            (sum(&nodes.water_force, 0), 0.25),
            (sum(&nodes.water_force, 1), 0.125),
        ] {
            assert!((got - exact).abs() < 1e-13, "{method}: {got} for {exact}");
        }
    }
}

#[test]
fn a_source_raises_the_pressure_where_its_divergence_is_taken_at_the_middle_of_the_step() {
    let dt = 1e-3;
    for (method, shift, is_by_cells) in
        [("GIMP-SRI", 0.1, true), ("TL-GIMP-SRI", 0.0, true), ("GIMP", 0.0, false), ("TL-GIMP", 0.0, false)]
    {
        let mut body = body(method);
        body.map_forces();
        body.update_forced_pressure(dt);
        let stiffness = body.material.water_bulk_modulus / body.material.porosity;
        for (place, pressure) in body.points.initial_position.iter().zip(&body.points.pressure) {
            let x = if is_by_cells { (place[0] * 4.0).floor() / 4.0 + 0.125 - shift } else { place[0] };
            let exact = dt * stiffness * (x + 10.0 * (1.5 + 0.5 * dt));
            assert!((pressure - exact).abs() < 1e-12, "{method} at {place:?}: {pressure} for {exact}");
        }
    }
}

#[test]
fn porosities_of_a_source_are_those_of_the_middle_and_volumes_those_of_the_end() {
    let mut body = body("GIMP-SRI");
    body.map_forces();
    // The step ends at J = 1.2: its middle is 1.1, with n = 1 − 0.4/1.1.
    body.points.volume_ratio.fill(1.2);
    body.update_forced_pressure(1e-3);
    let porosity = 1.0 - 0.4 / 1.1;
    let x = 0.125 - 0.1;
    let exact = 1e-3 * body.material.water_bulk_modulus / porosity * (x + 10.0 * 1.5005);
    assert!((body.points.pressure[0] - exact).abs() < 1e-12, "{} for {exact}", body.points.pressure[0]);
    assert!(body.points.volume_ratio.iter().all(|ratio| *ratio == 1.2));
}

#[test]
fn a_divergence_is_taken_on_the_configuration_of_the_middle() {
    // v = 2x along x: L = 2, and at the middle of a step of 0.1 the divergence is 2/(1 + 0.1).
    let mut body = body("GIMP-SRI");
    for node in 0..body.nodes.len() {
        let x = body.grid.node_position(node)[0];
        body.nodes.solid_velocity[node] = [2.0 * x, 0.0];
    }
    let field = body.nodes.solid_velocity.clone();
    let cell = body.cells.occupied().next().expect("a cell");
    for place in [Place::Centre(cell), Place::Point(9)] {
        let back = body.half_step_back(place, 0.1);
        let got = body.middle_divergence(place, &back, &field);
        assert!((got - 2.0 / 1.1).abs() < 1e-13, "{got}");
    }
}

#[test]
fn strains_are_taken_on_the_configuration_of_the_middle() {
    // The same field: a step of 0.1 stretches by exp(0.2/1.1) = 1.199…, which is 1 + 0.2 but for third order;
    // exp(0.2) = 1.221… would be the strain of the start.
    // B-bar has nothing to correct.
    for method in [
        "GIMP-SRI",
        "GC-SRI-patch",
        "CE-SRI-patch",
        "TL-GIMP-SRI",
        "GIMP-Bbar-patch",
        "VP-Bbar",
        "TL-GC-Bbar-patch",
    ] {
        let mut body = body(method);
        for node in 0..body.nodes.len() {
            let x = body.grid.node_position(node)[0];
            body.nodes.solid_velocity[node] = [2.0 * x, 0.0];
        }
        body.update_effective_stress(0.1);
        let strain = 0.2_f64 / 1.1;
        // λ = μ = 0.4
        for (ratio, [[along, _], [_, up]]) in
            body.points.volume_ratio.iter().zip(&body.points.effective_stress)
        {
            assert!((ratio - strain.exp()).abs() < 1e-12, "{method}: {ratio} for {}", strain.exp());
            assert!((along - 1.2 * strain).abs() < 1e-12, "{method}: {along} for {}", 1.2 * strain);
            assert!((up - 0.4 * strain).abs() < 1e-12, "{method}: {up} for {}", 0.4 * strain);
        }
    }
}

#[test]
fn domains_turn_with_a_step_and_carry_their_corners_along() {
    // A body that turns by 0.1: a point's long edge goes from (h, 0) to h (1, 0.1) but for third order.
    let mut body = body("CPDI-SRI-patch");
    let half = body.points.half_length[0][0];
    for node in 0..body.nodes.len() {
        let [x, y] = body.grid.node_position(node);
        body.nodes.solid_velocity[node] = [-y, x];
    }
    body.update_effective_stress(0.1);
    body.build_operators();
    let [[along, up], _] = body.operators.domains.as_ref().expect("domains that turn").half_edges[9];
    assert!((along / half - 1.0).abs() < 2e-3 && (up / half - 0.1).abs() < 2e-3, "{along} {up}");
    // A field whose hats' interpolant turns with the corners: |x − a| about a line of nodes through the domain's edge.
    let kink: Vec<Vector<2>> =
        (0..body.nodes.len()).map(|node| [(body.grid.node_position(node)[0] - 0.25).abs(), 0.0]).collect();
    let place = body.points.position[9];
    let edges = body.operators.domains.as_ref().expect("domains").half_edges[9];
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mean: f64 =
        corners.iter().map(|(s, t)| 0.25 * (place[0] + s * edges[0][0] + t * edges[1][0] - 0.25).abs()).sum();
    let got = body.operators.basis.value(body.grid.node_stride(), 9, &kink)[0];
    assert!((got - mean).abs() < 1e-14, "{got} for {mean}");
}

#[test]
fn velocity_gradients_give_the_nodes_a_linear_field_wherever_the_points_lie() {
    let linear = |[x, y]: Vector<2>| [0.3 + 2.0 * x - y, 0.1 - x + 0.5 * y];
    for method in ["GIMP-SRI-patch", "CPDI-SRI-patch", "uGIMP"] {
        let mut body = body(method);
        for point in 0..body.points.len() {
            // Points that have moved, each to somewhere else in its cell.
            let [x, y] = body.points.position[point];
            body.points.position[point] = [x + 0.03 * (9.0 * x + y).sin(), y + 0.02 * (7.0 * y - x).cos()];
        }
        body.build_operators();
        body.map_masses();
        for node in 0..body.nodes.len() {
            let velocity = linear(body.grid.node_position(node));
            (body.nodes.solid_velocity[node], body.nodes.water_velocity[node]) = (velocity, velocity);
        }
        body.use_apic();
        for point in 0..body.points.len() {
            let velocity = linear(body.points.position[point]);
            (body.points.solid_velocity[point], body.points.water_velocity[point]) = (velocity, velocity);
        }
        body.map_velocities();
        let mut plain = body.clone();
        plain.actions.velocity_gradients = None;
        plain.map_velocities();
        let mut least: f64 = 1.0;
        for node in (0..body.nodes.len()).filter(|node| body.nodes.is_active(*node)) {
            let exact = linear(body.grid.node_position(node));
            for d in (0..2).filter(|d| body.nodes.free[node][*d] > 0.0) {
                for got in [body.nodes.solid_velocity[node][d], body.nodes.water_velocity[node][d]] {
                    assert!((got - exact[d]).abs() < 1e-12, "{method}: {got} for {}", exact[d]);
                }
                least = least.min((plain.nodes.solid_velocity[node][d] - exact[d]).abs());
            }
        }
        assert!(least > 1e-9, "{method}: without slopes a node has it too");
    }
}
