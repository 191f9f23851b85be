//! The bases: weights between points and nodes, as rows of one direction in units of the cell.
//!
//! A basis has its place here and in [`Basis`]: every stencil, load and displacement asks for its rows here.

use crate::method::Basis;
use crate::operators::block_rows::LaneRows;
use crate::operators::row::Row;
use crate::operators::stencil::{PointStencils, Stencils, visit_block};
use crate::state::grid::{GHOST_LAYERS, Grid, Line, index_of, whole, whole_part};
use crate::state::lanes::{LANES, Lanes, lanes_of};
use crate::state::nodes::Support;
use crate::wide::wide;
use oedometer_soil::tensor::Vector;

/// A basis as the compiler sees it: rows of `W` nodes per direction, which sum to one by construction.
pub trait ShapeFunction<const W: usize> {
    /// Whether nodes beyond a wall would have a share in what is inside it.
    const PASSES_WALLS: bool = false;

    /// Lowest node, as a whole number, of the row of a place in a cell, of a point with a domain of half-length
    /// `half_length`, all in cells.
    fn lowest_node(place: f64, cell: f64, half_length: f64) -> f64;

    /// Weights and gradients at such a place from such a node, without a branch: loops over lanes ask for them.
    fn values(place: f64, lowest: f64, half_length: f64) -> [[f64; W]; 2];

    /// Both as one row.
    #[inline]
    fn row(place: f64, cell: usize, half_length: f64) -> Row<W> {
        let lowest = Self::lowest_node(place, cell as f64, half_length);
        let [weights, gradients] = Self::values(place, lowest, half_length);
        Row { first: index_of(lowest), weights, gradients }
    }
}

impl Basis {
    /// Room for the stencils of so many points.
    pub fn stencils<const D: usize>(self, points: usize) -> PointStencils<D> {
        match self {
            Self::Hat => PointStencils::Two(Stencils::with_points(points)),
            Self::Ugimp | Self::Cpgimp | Self::Cpdi | Self::Bspline2 => {
                PointStencils::Three(Stencils::with_points(points))
            }
            Self::Bspline3 => PointStencils::Four(Stencils::with_points(points)),
        }
    }

    /// Builds `N` and `∇N` of points at places (in cells) with half-lengths of their domains (m), `[point][direction]`.
    pub fn build<const D: usize>(
        self,
        stencils: &mut PointStencils<D>,
        grid: &Grid<D>,
        support: &Support<D>,
        points: [&[Vector<D>]; 2],
    ) {
        match (self, stencils) {
            (Self::Hat, PointStencils::Two(stencils)) => build::<D, 2, Hat>(stencils, grid, support, points),
            (Self::Ugimp | Self::Cpgimp, PointStencils::Three(stencils)) => {
                build::<D, 3, Gimp>(stencils, grid, support, points);
            }
            (Self::Cpdi, PointStencils::Three(stencils)) => {
                build::<D, 3, DomainEnds>(stencils, grid, support, points);
            }
            (Self::Bspline2, PointStencils::Three(stencils)) => {
                build::<D, 3, QuadraticSpline>(stencils, grid, support, points);
            }
            (Self::Bspline3, PointStencils::Four(stencils)) => {
                build::<D, 4, CubicSpline>(stencils, grid, support, points);
            }
            _ => unreachable!("stencils of another basis"),
        }
    }

    /// Whether the basis reaches beyond walls and free surfaces, with coefficients that are no values.
    pub fn is_spline(self) -> bool {
        matches!(self, Self::Bspline2 | Self::Bspline3)
    }

    /// Visits the nodes that carry a place of the surface (in cells), with their weights: those of the basis,
    /// and hats where domains smear them.
    #[inline]
    pub fn visit_surface<const D: usize>(
        self,
        grid: &Grid<D>,
        support: &Support<D>,
        place: &Vector<D>,
        node_visitor: impl FnMut(usize, f64),
    ) {
        let no_domain = [0.0; D];
        match self {
            Self::Hat | Self::Ugimp | Self::Cpgimp | Self::Cpdi => {
                visit_block(grid, &rows_at::<D, 2, Hat>(grid, support, place, &no_domain), node_visitor);
            }
            Self::Bspline2 => {
                let rows = rows_at::<D, 3, QuadraticSpline>(grid, support, place, &no_domain);
                visit_block(grid, &rows, node_visitor);
            }
            Self::Bspline3 => {
                let rows = rows_at::<D, 4, CubicSpline>(grid, support, place, &no_domain);
                visit_block(grid, &rows, node_visitor);
            }
        }
    }

    /// Last node that a surface at a height (in cells) leaves a spline to stand alone on; none without splines.
    #[inline]
    pub fn outermost_node(self, height: f64) -> Option<usize> {
        match self {
            Self::Bspline2 => Some(whole(height + 0.5)),
            // The upper node of the cell that the surface is in; one on a face is in the cell below.
            Self::Bspline3 => Some(whole(height - ON_A_FACE) + 1),
            Self::Hat | Self::Ugimp | Self::Cpgimp | Self::Cpdi => None,
        }
    }
}

/// A surface this near to a face, in cells, lies on it.
const ON_A_FACE: f64 = 1e-9;

fn build<const D: usize, const W: usize, S: ShapeFunction<W>>(
    stencils: &mut Stencils<D, W>,
    grid: &Grid<D>,
    support: &Support<D>,
    [places, half_lengths]: [&[Vector<D>]; 2],
) {
    if S::PASSES_WALLS {
        for (point, (place, half_length)) in places.iter().zip(half_lengths).enumerate() {
            stencils.set(grid, point, &rows_at::<D, W, S>(grid, support, place, half_length));
        }
        return;
    }
    wide!(stencils.set_lanes(
        grid,
        places,
        #[inline(always)]
        |first, direction, place, rows| {
            let half_length = lanes_of(&half_lengths[first..], direction, 0.5 * grid.cell_size);
            fill_rows::<W, S>(grid.line(direction), place, &half_length, rows)
        },
    ));
}

/// Fills the rows of some points along a direction, at places in cells, of domains of half-lengths in m; returns the
/// lowest node of each.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn fill_rows<const W: usize, S: ShapeFunction<W>>(
    line: Line,
    place: &Lanes,
    half_length: &Lanes,
    rows: &mut LaneRows<W>,
) -> Lanes {
    let mut lowest = [0.0; LANES];
    for lane in 0..LANES {
        let (place, half_length) = (place[lane], half_length[lane] * line.per_cell);
        let first = S::lowest_node(place, line.cell_at(place), half_length);
        let [weights, gradients] = S::values(place, first, half_length);
        lowest[lane] = first;
        for k in 0..W {
            rows.weights[k][lane] = weights[k];
            rows.gradients[k][lane] = gradients[k] * line.per_cell;
        }
    }
    lowest
}

/// Rows of a basis at a place (in cells), for a domain of half-lengths (m), without nodes beyond held faces:
/// `[direction]`.
#[inline]
fn rows_at<const D: usize, const W: usize, S: ShapeFunction<W>>(
    grid: &Grid<D>,
    support: &Support<D>,
    place: &Vector<D>,
    half_length: &Vector<D>,
) -> [Row<W>; D] {
    let (cell, per_cell) = (grid.cell_at(place), grid.inverse_cell_size());
    std::array::from_fn(|d| {
        let row = S::row(place[d], cell[d], half_length[d] * per_cell);
        if S::PASSES_WALLS { folded(support, grid, d, row) } else { row }
    })
}

/// A row along a direction without nodes beyond held faces, nor far beyond a free surface: those
/// have no freedom of their own.
#[inline]
fn folded<const D: usize, const W: usize>(
    support: &Support<D>,
    grid: &Grid<D>,
    direction: usize,
    mut row: Row<W>,
) -> Row<W> {
    let (lowest, highest) = (GHOST_LAYERS, GHOST_LAYERS + grid.cells[direction]);
    if support.lower[direction] {
        row.fold_at(lowest, |node| node < lowest);
    }
    if support.upper[direction] {
        row.fold_at(highest, |node| node > highest);
    }
    if let Some(outermost) = support.outermost.filter(|_| direction == D - 1) {
        row.straighten_beyond(outermost);
    }
    row
}

/// `max(x, 0)` in one instruction; `f64::max` takes three to mind a NaN.
#[inline]
fn positive_part(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// The weights and gradients of three nodes from those of the outer two: the middle one has what is left.
#[inline]
fn about_middle([left, right]: [f64; 2], [left_gradient, right_gradient]: [f64; 2]) -> [[f64; 3]; 2] {
    [[left, 1.0 - left - right, right], [left_gradient, -left_gradient - right_gradient, right_gradient]]
}

/// Piecewise linear hat functions (Sulsky, Chen & Schreyer 1994).
#[derive(Clone, Copy, Debug)]
pub struct Hat;

impl ShapeFunction<2> for Hat {
    #[inline]
    fn lowest_node(_place: f64, cell: f64, _half_length: f64) -> f64 {
        cell
    }

    #[inline]
    fn values(place: f64, lowest: f64, _half_length: f64) -> [[f64; 2]; 2] {
        let upper = place - lowest;
        [[1.0 - upper, upper], [-1.0, 1.0]]
    }
}

/// The hat function convolved with the top-hat domain of a point (Bardenhagen & Kober 2004,
/// Eq. 24); a domain wider than a cell would need a fourth node and is cut there.
///
/// The outer weights come from squared overlaps with the nearest node's sides, the middle one is
/// what is left: no branch, and the partition of unity is exact.
#[derive(Clone, Copy, Debug)]
pub struct Gimp;

impl ShapeFunction<3> for Gimp {
    #[inline]
    fn lowest_node(place: f64, _cell: f64, _half_length: f64) -> f64 {
        whole_part(place + 0.5) - 1.0
    }

    #[inline]
    fn values(place: f64, lowest: f64, half_length: f64) -> [[f64; 3]; 2] {
        let half_length = half_length.min(0.5);
        let offset = place - (lowest + 1.0);
        let (low, high) = (offset - half_length, offset + half_length);
        let per_length = 0.5 / half_length;
        let (left_near, left_far) = (positive_part(-high), positive_part(-low));
        let (right_near, right_far) = (positive_part(low), positive_part(high));
        let left = 0.5 * per_length * (left_far * left_far - left_near * left_near);
        let right = 0.5 * per_length * (right_far * right_far - right_near * right_near);
        let left_gradient = -per_length * (left_far - left_near);
        let right_gradient = per_length * (right_far - right_near);
        about_middle([left, right], [left_gradient, right_gradient])
    }
}

/// The hat functions averaged over the two ends of a point's domain (CPDI, Sadeghirad, Brannon &
/// Burghardt 2011, in one direction); domains wider than a cell are cut there.
///
/// The gradient is the difference between the ends over the length, which is that of GIMP; the
/// weights move the middle of the domain as its ends move, so that neighbours stay neighbours.
#[derive(Clone, Copy, Debug)]
pub struct DomainEnds;

impl ShapeFunction<3> for DomainEnds {
    #[inline]
    fn lowest_node(place: f64, _cell: f64, half_length: f64) -> f64 {
        whole_part(place - half_length.min(0.5))
    }

    #[inline]
    fn values(place: f64, lowest: f64, half_length: f64) -> [[f64; 3]; 2] {
        let half_length = half_length.min(0.5);
        let (low, high) = (place - half_length, place + half_length);
        let middle = lowest + 1.0;
        // The end below the middle node weighs in on its left, the one above on its right.
        let at = |end: f64| [positive_part(middle - end), positive_part(end - middle)];
        let ([low_left, low_right], [high_left, high_right]) = (at(low), at(high));
        let per_length = 0.5 / half_length;
        let (left, right) = (0.5 * (low_left + high_left), 0.5 * (low_right + high_right));
        let (left_gradient, right_gradient) =
            (per_length * (high_left - low_left), per_length * (high_right - low_right));
        about_middle([left, right], [left_gradient, right_gradient])
    }
}

/// Quadratic B-splines about the nodes (Steffen, Kirby & Berzins 2008).
#[derive(Clone, Copy, Debug)]
pub struct QuadraticSpline;

impl ShapeFunction<3> for QuadraticSpline {
    const PASSES_WALLS: bool = true;

    #[inline]
    fn lowest_node(place: f64, _cell: f64, _half_length: f64) -> f64 {
        whole_part(place + 0.5) - 1.0
    }

    #[inline]
    fn values(place: f64, lowest: f64, _half_length: f64) -> [[f64; 3]; 2] {
        let x = place - (lowest + 1.0);
        let (left, right) = (0.5 * (0.5 - x) * (0.5 - x), 0.5 * (0.5 + x) * (0.5 + x));
        about_middle([left, right], [x - 0.5, x + 0.5])
    }
}

/// Cubic B-splines about the nodes.
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline;

impl ShapeFunction<4> for CubicSpline {
    const PASSES_WALLS: bool = true;

    #[inline]
    fn lowest_node(_place: f64, cell: f64, _half_length: f64) -> f64 {
        cell - 1.0
    }

    #[inline]
    fn values(place: f64, lowest: f64, _half_length: f64) -> [[f64; 4]; 2] {
        let x = place - (lowest + 1.0);
        let y = 1.0 - x;
        let (outer_left, outer_right) = (y * y * y / 6.0, x * x * x / 6.0);
        let left = 2.0 / 3.0 - x * x * (1.0 - 0.5 * x);
        let (left_gradient, right_gradient) = (-2.0 * x + 1.5 * x * x, 2.0 * y - 1.5 * y * y);
        [
            [outer_left, left, 1.0 - outer_left - left - outer_right, outer_right],
            [-0.5 * y * y, left_gradient, right_gradient, 0.5 * x * x],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::row::moments;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn hat_and_gimp_reproduce_a_linear_field(place in 3.0..9.0f64, half_length in 0.01..0.5f64) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let cell = place as usize;
            for (value, gradient) in [
                moments(&Hat::row(place, cell, 0.0), |x| 2.0 + 3.0 * x),
                moments(&Gimp::row(place, 0, half_length), |x| 2.0 + 3.0 * x),
                moments(&DomainEnds::row(place, 0, half_length), |x| 2.0 + 3.0 * x),
                moments(&QuadraticSpline::row(place, 0, 0.0), |x| 2.0 + 3.0 * x),
                moments(&CubicSpline::row(place, cell, 0.0), |x| 2.0 + 3.0 * x),
            ] {
                prop_assert!((value - (2.0 + 3.0 * place)).abs() < 1e-12, "value {value}");
                prop_assert!((gradient - 3.0).abs() < 1e-11, "gradient {gradient}");
            }
        }

        #[test]
        fn gradients_are_those_of_the_weights(place in 3.01..8.99f64) {
            // Hat functions have kinks; splines have none that a small step sees.
            let step = 1e-5;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let cell = place as usize;
            let slope = |field: &dyn Fn(f64) -> f64| (field(place + step) - field(place - step)) / (2.0 * step);
            for power in 1..4 {
                let cube = |x: f64| x.powi(power);
                let quadratic = slope(&|x| moments(&QuadraticSpline::row(x, 0, 0.0), cube).0);
                prop_assert!((moments(&QuadraticSpline::row(place, 0, 0.0), cube).1 - quadratic).abs() < 1e-4);
                let cubic = slope(&|x| moments(&CubicSpline::row(x, cell, 0.0), cube).0);
                prop_assert!((moments(&CubicSpline::row(place, cell, 0.0), cube).1 - cubic).abs() < 1e-4);
            }
        }

        #[test]
        fn gimp_weights_are_never_negative(place in 3.0..9.0f64, half_length in 0.01..0.5f64) {
            let row = Gimp::row(place, 0, half_length);
            prop_assert!(row.weights.iter().all(|w| *w >= -1e-16));
            prop_assert!((row.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }

        #[test]
        fn gimp_is_the_hat_averaged_over_the_domain(place in 3.0..9.0f64, half_length in 0.05..0.5f64) {
            // Midpoint rule of the definition, fine enough for its kinks.
            let row = Gimp::row(place, 0, half_length);
            let slices = 20_000;
            for k in 0..3 {
                let node = (row.first + k) as f64;
                let mean: f64 = (0..slices)
                    .map(|i| place - half_length + (f64::from(i) + 0.5) * 2.0 * half_length / f64::from(slices))
                    .map(|x| (1.0 - (x - node).abs()).max(0.0))
                    .sum::<f64>() / f64::from(slices);
                prop_assert!((mean - row.weights[k]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn gimp_with_domains_that_tile_the_cell_has_the_hat_s_mean_gradient() {
        // On the regular lattice the domains tile the cells, so GIMP equals the hat.
        for place in [5.25, 5.75] {
            let row = Gimp::row(place, 0, 0.25);
            let hat = Hat::row(place, 5, 0.0);
            for k in 0..2 {
                let slot = hat.first + k - row.first;
                assert!((row.weights[slot] - hat.weights[k]).abs() < 1e-15);
                assert!((row.gradients[slot] - hat.gradients[k]).abs() < 1e-15);
            }
        }
    }
}
