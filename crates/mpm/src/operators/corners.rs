//! Shape functions of domains that turn: the hats at the four corners of a parallelogram (CPDI in the plane).
//!
//! ```text
//! N_p  = ¼ Σ_c N(x_c),   x_c = x_p ± r_1 ± r_2
//! ∇N_p = Σ_c g_c N(x_c),   g_c = [±(r_2y, −r_2x) ± (−r_1y, r_1x)]/V,   V = 4 r_1 × r_2
//! ```
//!
//! The gradient is the mean over the parallelogram of the gradient of what its corners interpolate, from its
//! boundary: exact for linear fields whatever its shape. Each corner is a block of hats, so a point has four blocks.

use crate::operators::basis::{Hat, ShapeFunction};
use crate::operators::row::Row;
use crate::operators::stencil::{PointStencils, Stencils};
use crate::state::grid::{GHOST_LAYERS, Grid, integer_part};
use crate::state::points::Points;
use oedometer_problem::method::{Basis, Configuration, Method};
use oedometer_soil::tensor::{Tensor, Vector, inverse};

/// Corners of a parallelogram by the signs of its half-edges, one after the other around it.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Room for the stencils of so many points with domains that turn.
pub fn corner_stencils<const D: usize>(points: usize) -> PointStencils<D> {
    PointStencils::Two(Stencils::new(points, CORNERS.len()))
}

/// Builds `N` and `∇N` of points at places (in cells) with half-edges of their domains (m), `[point][edge][component]`.
pub fn build_corners<const D: usize>(
    stencils: &mut PointStencils<D>,
    grid: &Grid<D>,
    places: &[Vector<D>],
    half_edges: &[Tensor<D>],
) {
    let PointStencils::Two(stencils) = stencils else { unreachable!("stencils of another basis") };
    let last = D - 1;
    for (point, (place, [first_edge, second_edge])) in
        places.iter().zip(half_edges.iter().map(|edges| [edges[0], edges[last]])).enumerate()
    {
        let per_cell = grid.inverse_cell_size();
        let [a, b] = [first_edge, second_edge].map(|edge| edge.map(|component| component * per_cell));
        let per_volume = 0.25 / (a[0] * b[last] - a[last] * b[0]);
        for (part, [along, up]) in CORNERS.into_iter().enumerate() {
            // g_c = Σ_edges of the normal of the edges that meet in the corner, half each, over the volume.
            let slope =
                [along * b[last] - up * a[last], up * a[0] - along * b[0]].map(|normal| per_volume * normal);
            let rows: [Row<2>; D] = std::array::from_fn(|d| {
                let corner = place[d] + along * a[d] + up * b[d];
                corner_row(grid, d, corner, slope[d.min(1)])
            });
            stencils.set(grid, point * CORNERS.len() + part, &rows);
        }
    }
}

/// Row of a corner along a direction. The product of the rows is a quarter of the hat, and that with the gradient of
/// a direction the hat times the corner's slope there.
#[inline]
fn corner_row<const D: usize>(grid: &Grid<D>, direction: usize, corner: f64, slope: f64) -> Row<2> {
    // `max` and `min`, not `clamp`: they turn a NaN into a place. The outermost node is no cell's lowest.
    let end = (grid.cells[direction] + 2 * GHOST_LAYERS) as f64;
    let corner = corner.max(0.0).min(end - 1e-9);
    let hat = Hat::row(corner, integer_part(corner), 0.0);
    // A half a direction, a quarter in the plane.
    Row {
        values: hat.values.map(|value| 0.5 * value),
        gradients: hat.values.map(|value| 2.0 * slope * value),
        ..hat
    }
}

/// Half-edges of the points' domains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Domains<const D: usize> {
    /// Half-lengths at the start of the run along the axes, m, `[point][direction]`.
    initial: Vec<Vector<D>>,
    /// Vectors from each point to the middles of its domain's edges, m, `[point][edge][component]`.
    pub half_edges: Vec<Tensor<D>>,
}

impl<const D: usize> Domains<D> {
    /// The domains of points if the method has domains that turn: in the plane, where points move. Otherwise domains keep
    /// their axes, and a parallelogram is the product of its sides.
    pub fn for_method(method: Method, configuration: Configuration, points: &Points<D>) -> Option<Self> {
        let turns = method.basis == Basis::Cpdi && D == 2 && configuration.moves_points();
        turns.then(|| {
            let mut domains = Self { initial: points.half_length.clone(), half_edges: Vec::new() };
            domains.half_edges.resize(points.len(), [[0.0; D]; D]);
            domains.follow(&points.inverse_deformation);
            domains
        })
    }

    /// Sets the edges from the deformation since the start of the run, by its inverses: `r_i = F r_i0`.
    pub fn follow(&mut self, inverse_deformation: &[Tensor<D>]) {
        let lengths = self.initial.iter().zip(inverse_deformation);
        for (edges, (lengths, back)) in self.half_edges.iter_mut().zip(lengths) {
            let deformation = inverse(back).0;
            for edge in 0..D {
                for component in 0..D {
                    edges[edge][component] = deformation[component][edge] * lengths[edge];
                }
            }
        }
    }

    /// Deforms a point's edges by the deformation of a step.
    pub fn carry(&mut self, point: usize, deformation: &Tensor<D>) {
        for edge in &mut self.half_edges[point] {
            let before = *edge;
            *edge = std::array::from_fn(|i| (0..D).map(|j| deformation[i][j] * before[j]).sum());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::tensor::product;
    use proptest::prelude::*;

    /// A point at a place, m, with a domain of half-edges, m, on cells of half a metre.
    fn point(place: Vector<2>, half_edges: Tensor<2>) -> (Grid<2>, PointStencils<2>) {
        let grid = Grid::new(0.5, [6, 5]);
        let mut stencils = corner_stencils(2);
        let places = [grid.held_in_cells(&[1.0, 1.0]), grid.held_in_cells(&place)];
        build_corners(&mut stencils, &grid, &places, &[[[0.1, 0.0], [0.0, 0.1]], half_edges]);
        (grid, stencils)
    }

    fn field(grid: &Grid<2>, function: impl Fn(f64, f64) -> f64) -> Vec<Vector<2>> {
        let nodes = 0..grid.node_count();
        nodes.map(|node| grid.node_position(node)).map(|[x, y]| [function(x, y), 0.0]).collect()
    }

    /// The hats' interpolant of a field at a place, m.
    fn interpolated(grid: &Grid<2>, function: &impl Fn(f64, f64) -> f64, [x, y]: Vector<2>) -> f64 {
        let h = grid.cell_size;
        let ([i, j], [a, b]) = ([x, y].map(|at| (at / h).floor()), [x, y].map(|at| (at / h).fract()));
        let node = |right: f64, up: f64| function((i + right) * h, (j + up) * h);
        (1.0 - b) * ((1.0 - a) * node(0.0, 0.0) + a * node(1.0, 0.0))
            + b * ((1.0 - a) * node(0.0, 1.0) + a * node(1.0, 1.0))
    }

    /// Whether a domain is far from a line: round-off of the gradient grows with one over its area.
    fn has_area([long, wide]: Tensor<2>) -> bool {
        long[0] * wide[1] - long[1] * wide[0] > 5e-3
    }

    proptest! {
        #[test]
        fn linear_fields_are_reproduced_and_gradients_sum_to_zero(
            place in [1.0..2.0f64, 1.0..1.5f64],
            long in [0.1..0.4f64, -0.3..0.3f64],
            wide in [-0.09..0.09f64, 0.1..0.4f64],
        ) {
            prop_assume!(has_area([long, wide]));
            let (grid, stencils) = point(place, [long, wide]);
            let (mut weights, mut gradients) = (0.0, [0.0; 2]);
            stencils.visit(grid.node_stride(), 1, |_, weight, gradient| {
                weights += weight;
                gradients = std::array::from_fn(|d| gradients[d] + gradient[d]);
            });
            prop_assert!((weights - 1.0).abs() < 1e-14);
            prop_assert!(gradients[0].abs() < 1e-12 && gradients[1].abs() < 1e-12);
            let linear = field(&grid, |x, y| 1.0 + 2.0 * x - 3.0 * y);
            let value = stencils.value(grid.node_stride(), 1, &linear)[0];
            prop_assert!((value - (1.0 + 2.0 * place[0] - 3.0 * place[1])).abs() < 1e-12);
            let [slope, _] = stencils.gradient(grid.node_stride(), 1, &linear);
            prop_assert!((slope[0] - 2.0).abs() < 1e-11 && (slope[1] + 3.0).abs() < 1e-11);
        }

        /// The gradient is the mean over the domain of that of the corners' bilinear interpolant: by its boundary,
        /// with the trapezoidal rule on each edge.
        #[test]
        fn the_mean_gradient_is_the_integral_over_the_boundary(
            place in [1.0..2.0f64, 1.0..1.5f64],
            [a, b] in [[0.1..0.4f64, -0.3..0.3f64], [-0.09..0.09f64, 0.1..0.4f64]],
        ) {
            prop_assume!(has_area([a, b]));
            let (grid, stencils) = point(place, [a, b]);
            let wavy = |x: f64, y: f64| (1.3 * x - 0.4 * y).sin() + x * y;
            let at = |s: f64, t: f64| -> Vector<2> {
                std::array::from_fn(|d| place[d] + s * a[d] + t * b[d])
            };
            let corners = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
            let values = corners.map(|corner| interpolated(&grid, &wavy, corner));
            let (mut area, mut boundary) = (0.0, [0.0; 2]);
            for i in 0..4 {
                let ([x0, y0], [x1, y1]) = (corners[i], corners[(i + 1) % 4]);
                area += 0.5 * (x0 * y1 - x1 * y0);
                let mean = 0.5 * (values[i] + values[(i + 1) % 4]);
                boundary = [boundary[0] + mean * (y1 - y0), boundary[1] - mean * (x1 - x0)];
            }
            let nodes = field(&grid, wavy);
            let [slope, _] = stencils.gradient(grid.node_stride(), 1, &nodes);
            for d in 0..2 {
                prop_assert!((slope[d] - boundary[d] / area).abs() < 1e-11, "{} for {}", slope[d], boundary[d] / area);
            }
            let value = stencils.value(grid.node_stride(), 1, &nodes)[0];
            prop_assert!((value - 0.25 * values.iter().sum::<f64>()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_domain_along_the_axes_has_products_of_one_dimensional_weights() {
        use crate::operators::basis::Shapes;
        use crate::state::nodes::Support;
        let (place, half) = ([1.37, 0.81], [0.2, 0.13]);
        let (grid, corners) = point(place, [[half[0], 0.0], [0.0, half[1]]]);
        let mut ends = Basis::Cpdi.stencils(1);
        let places = [&[grid.held_in_cells(&place)][..], &[half][..]];
        Basis::Cpdi.build(&mut ends, &grid, &Support::free(), places);
        let spread = |stencils: &PointStencils<2>, point: usize| {
            let mut nodes = vec![[0.0; 3]; grid.node_count()];
            stencils.visit(grid.node_stride(), point, |node, weight, [along, up]| {
                for (sum, part) in nodes[node].iter_mut().zip([weight, *along, *up]) {
                    *sum += part;
                }
            });
            nodes
        };
        for (got, exact) in spread(&corners, 1).iter().flatten().zip(spread(&ends, 0).iter().flatten()) {
            assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
        }
    }

    #[test]
    fn edges_follow_the_deformation_at_once_and_step_by_step_and_their_area_the_volume() {
        let mut points = Points::<2>::lattice(0.5, [2, 1], 2);
        let method = Method::named("CPDI-SRI-patch").expect("a method");
        let mut stepwise =
            Domains::for_method(method, Configuration::Updated, &points).expect("domains that turn");
        assert_eq!(stepwise.half_edges[3], [[0.125, 0.0], [0.0, 0.125]]);
        let mut at_once = stepwise.clone();
        // Sheared by a half, and turned by a right angle.
        let [shear, turn] = [[[1.0, 0.5], [0.0, 0.8]], [[0.0, -1.0], [1.0, 0.0]]];
        for step in [shear, turn] {
            (0..points.len()).for_each(|point| stepwise.carry(point, &step));
        }
        points.inverse_deformation.fill(inverse(&product(&turn, &shear)).0);
        at_once.follow(&points.inverse_deformation);
        for domains in [stepwise, at_once] {
            let [[ax, ay], [bx, by]] = domains.half_edges[3];
            for (got, exact) in [(ax, 0.0), (ay, 0.125), (bx, -0.1), (by, 0.0625)] {
                assert!((got - exact).abs() < 1e-16, "{got} for {exact}");
            }
            // 4 |r_1 × r_2| = J V_0
            assert!((4.0 * (ax * by - ay * bx) - 0.8 * points.initial_volume[3]).abs() < 1e-16);
        }
    }

    #[test]
    fn only_cpdi_on_moving_points_in_the_plane_turns_its_domains() {
        let named = |name| Method::named(name).expect("a method");
        let (plane, column) = (Points::<2>::lattice(1.0, [1, 1], 1), Points::<1>::lattice(1.0, [1], 1));
        assert!(Domains::for_method(named("CE-SRI-patch"), Configuration::Updated, &plane).is_some());
        assert!(Domains::for_method(named("GIMP-SRI-patch"), Configuration::Updated, &plane).is_none());
        assert!(Domains::for_method(named("CPDI-SRI-patch"), Configuration::Total, &plane).is_none());
        assert!(Domains::for_method(named("CPDI-SRI-patch"), Configuration::Updated, &column).is_none());
    }
}
