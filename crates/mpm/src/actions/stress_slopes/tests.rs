//! Stresses that slope over the points' domains: their forces are those of the field itself.

use super::*;
use crate::kernel::body::Body;
use crate::tests::column_problem;
use oedometer_problem::method::Method;
use oedometer_scenes::MANUFACTURED_BOX;
use oedometer_soil::tensor::Tensor;

/// The unit square in four by four cells, its points' domains tiling it in rows and columns that are nowhere alike.
fn body_of_uneven_tiles() -> Body<2> {
    let scene = &MANUFACTURED_BOX;
    let (column, soil) = ((scene.column)(), (scene.soil)());
    let method = Method::named("GIMP-SRI-patch").expect("a method");
    let problem = column_problem::<2>(scene, &column, &soil, method, 4, 2).expect("the unit square");
    let mut body = Body::new(problem);
    body.actions.forcing = None;
    let moved = |x: f64, d: usize| x + [0.06, -0.04][d] * (std::f64::consts::PI * x).sin();
    for point in 0..body.points.len() {
        let mut ratio = 1.0;
        for d in 0..2 {
            let (middle, half) = (body.points.position[point][d], body.points.half_length[point][d]);
            let (low, high) = (moved(middle - half, d), moved(middle + half, d));
            body.points.position[point][d] = 0.5 * (low + high);
            body.points.half_length[point][d] = 0.5 * (high - low);
            ratio *= 0.5 * (high - low) / half;
        }
        body.points.volume_ratio[point] = ratio;
    }
    body.build_operators();
    body.map_masses();
    body
}

/// Stresses of a plane: of the skeleton, and of the water.
fn plane([x, y]: Vector<2>) -> (Tensor<2>, f64) {
    let shear = 0.3 + 0.7 * x - 1.1 * y;
    ([[0.2 - x + 2.0 * y, shear], [shear, -0.4 + 0.5 * x + 1.5 * y]], 1.0 + 3.0 * x - 0.8 * y)
}

/// The same stresses times the gradient of a node's hat over the square, by Simpson's rule in each cell.
fn exact_force(node: Vector<2>, cell_size: f64) -> [Vector<2>; 2] {
    let mut force = [[0.0; 2]; 2];
    let rule = [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)];
    for cell in 0..16 {
        let low = [f64::from(cell % 4) * cell_size, f64::from(cell / 4) * cell_size];
        for (a, along) in rule {
            for (b, up) in rule {
                let place = [low[0] + a * cell_size, low[1] + b * cell_size];
                let middle = [low[0] + 0.5 * cell_size, low[1] + 0.5 * cell_size];
                let near = |d: usize| (1.0 - (place[d] - node[d]).abs() / cell_size).max(0.0);
                let slope = |d: usize| {
                    let apart = middle[d] - node[d];
                    if apart.abs() < cell_size { -apart.signum() / cell_size } else { 0.0 }
                };
                let gradient = [slope(0) * near(1), near(0) * slope(1)];
                let (effective, pressure) = plane(place);
                let area = along * up * cell_size * cell_size;
                for c in 0..2 {
                    let total = pressure * gradient[c]
                        - effective[c][0] * gradient[0]
                        - effective[c][1] * gradient[1];
                    force[0][c] += area * total;
                    force[1][c] += area * pressure * gradient[c];
                }
            }
        }
    }
    force
}

#[test]
fn forces_of_a_linear_stress_are_exact_wherever_the_points_lie() {
    let mut body = body_of_uneven_tiles();
    for point in 0..body.points.len() {
        (body.points.effective_stress[point], body.points.pressure[point]) =
            plane(body.points.position[point]);
    }
    let mut plain = body.clone();
    plain.map_forces();
    body.slope_stresses();
    body.map_forces();
    let (mut most, mut most_without) = (0.0_f64, 0.0_f64);
    for node in (0..body.nodes.len()).filter(|node| body.nodes.is_active(*node)) {
        let exact = exact_force(body.grid.node_position(node), body.grid.cell_size);
        for c in 0..2 {
            most = most
                .max((body.nodes.mixture_force[node][c] - exact[0][c]).abs())
                .max((body.nodes.water_force[node][c] - exact[1][c]).abs());
            most_without = most_without.max((plain.nodes.mixture_force[node][c] - exact[0][c]).abs());
        }
    }
    assert!(most < 1e-14, "{most}");
    assert!(most_without > 1e-3, "without slopes a node has it too: {most_without}");
}

#[test]
fn a_uniform_stress_has_no_slopes() {
    let mut body = body_of_uneven_tiles();
    body.points.pressure.fill(2.0);
    let mut plain = body.clone();
    plain.map_forces();
    body.slope_stresses();
    body.map_forces();
    for (sloped, plain) in body.nodes.mixture_force.iter().zip(&plain.nodes.mixture_force) {
        assert!((0..2).all(|c| (sloped[c] - plain[c]).abs() < 1e-14), "{sloped:?} {plain:?}");
    }
}

#[test]
fn levers_are_means_over_the_domain() {
    let cell_size = 0.5;
    for (distance, half_length) in
        [(0.1, 0.2), (-0.3, 0.15), (0.45, 0.1), (0.6, 0.25), (0.0, 0.25), (-0.7, 0.1)]
    {
        let hat = |at: f64| (1.0 - at.abs() / cell_size).max(0.0);
        let count = 200_000;
        let [mut weight, mut lever] = [0.0; 2];
        for step in 0..count {
            let from_middle = half_length * ((2.0 * f64::from(step) + 1.0) / f64::from(count) - 1.0);
            weight += hat(distance + from_middle) / f64::from(count);
            lever += from_middle * hat(distance + from_middle) / f64::from(count);
        }
        let got = Levers::new(distance, half_length / cell_size, weight, cell_size);
        let gradient = 0.5 * (hat(distance - half_length) + hat(distance + half_length)) - weight;
        assert!((got.value - lever).abs() < 1e-9, "{} for {lever}", got.value);
        assert!((got.gradient - gradient).abs() < 1e-9, "{} for {gradient}", got.gradient);
    }
}
