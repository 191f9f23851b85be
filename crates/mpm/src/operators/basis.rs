//! The bases: shape functions between points and nodes, as rows of one direction in units of the cell.
//!
//! A basis has its place here and in [`Basis`]: every stencil, load and displacement asks for its rows here.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::operators::row::Row;
use crate::operators::stencil::{Line, PointStencils, Stencils};
use crate::state::grid::{GHOST_LAYERS, Grid, integer_part, power};
use crate::state::nodes::Support;
use crate::wide::wide;
use oedometer_problem::method::Basis;
use oedometer_soil::tensor::Vector;
use std::hint::black_box;

/// The shape functions of a basis: rows of `W` nodes per direction.
pub trait ShapeFunction<const W: usize> {
    /// Whether nodes beyond a wall would have a share in what is inside it.
    const PASSES_WALLS: bool = false;

    /// Lowest node, and values and gradients (1/cell) of the nodes from there on, at a place in a cell, for a point with a
    /// domain of a half-length, all in cells. Cell and node are whole numbers of the kind that wide registers hold.
    fn nodes(place: f64, cell: f64, half_length: f64) -> (f64, [[f64; W]; 2]);

    /// The same as a row.
    #[inline(always)]
    fn row(place: f64, cell: usize, half_length: f64) -> Row<W> {
        let (first, [values, gradients]) = Self::nodes(place, cell as f64, half_length);
        Row { first: integer_part(first), values, gradients }
    }
}

/// Evaluates an expression with the shape function of a [`Basis`] and with [`Stencils`] of its width, under names.
macro_rules! with_shape {
    ($basis:expr, $point_stencils:expr, $shape:ident, $name:ident => $result:expr) => {{
        use oedometer_problem::method::Basis;
        use $crate::operators::basis as shapes;
        use $crate::operators::stencil::PointStencils;
        match ($basis, $point_stencils) {
            (Basis::Hat, PointStencils::Two($name)) => {
                type $shape = shapes::Hat;
                $result
            }
            (Basis::Ugimp | Basis::Cpgimp, PointStencils::Three($name)) => {
                type $shape = shapes::Gimp;
                $result
            }
            (Basis::Cpdi, PointStencils::Three($name)) => {
                type $shape = shapes::DomainEnds;
                $result
            }
            (Basis::Bspline2, PointStencils::Three($name)) => {
                type $shape = shapes::QuadraticSpline;
                $result
            }
            (Basis::Bspline3, PointStencils::Four($name)) => {
                type $shape = shapes::CubicSpline;
                $result
            }
            _ => unreachable!("stencils of another basis"),
        }
    }};
}
pub(crate) use with_shape;

/// What shape functions make of points and surfaces, on a grid.
pub trait Shapes: Sized {
    /// Room for the stencils of `points` points.
    fn stencils<const D: usize>(self, points: usize) -> PointStencils<D>;

    /// Builds `N` and `∇N` of points at places (in cells) with half-lengths of their domains (m), `[point][direction]`.
    fn build<const D: usize>(
        self,
        stencils: &mut PointStencils<D>,
        grid: &Grid<D>,
        support: &Support<D>,
        points: [&[Vector<D>]; 2],
    );

    /// Visits the nodes that carry a place of the surface (in cells), with the values of their shape functions: those
    /// of the basis, and hats where domains smear them.
    fn visit_surface<const D: usize>(
        self,
        grid: &Grid<D>,
        support: &Support<D>,
        place: &Vector<D>,
        visitor: impl FnMut(usize, f64),
    );

    /// Last node that a surface at a height (in cells) leaves a spline to stand alone on; none without splines.
    fn outermost_node(self, height: f64) -> Option<usize>;
}

impl Shapes for Basis {
    fn stencils<const D: usize>(self, points: usize) -> PointStencils<D> {
        match self {
            Self::Hat => PointStencils::Two(Stencils::new(points, 1)),
            Self::Ugimp | Self::Cpgimp | Self::Cpdi | Self::Bspline2 => {
                PointStencils::Three(Stencils::new(points, 1))
            }
            Self::Bspline3 => PointStencils::Four(Stencils::new(points, 1)),
        }
    }

    fn build<const D: usize>(
        self,
        stencils: &mut PointStencils<D>,
        grid: &Grid<D>,
        support: &Support<D>,
        points: [&[Vector<D>]; 2],
    ) {
        with_shape!(self, stencils, S, stencils => build::<D, _, S>(stencils, grid, support, points));
    }

    fn visit_surface<const D: usize>(
        self,
        grid: &Grid<D>,
        support: &Support<D>,
        place: &Vector<D>,
        visitor: impl FnMut(usize, f64),
    ) {
        let no_domain = [0.0; D];
        match self {
            Self::Hat | Self::Ugimp | Self::Cpgimp | Self::Cpdi => {
                visit_product(grid, &rows_at::<D, 2, Hat>(grid, support, place, &no_domain), visitor);
            }
            Self::Bspline2 => {
                let rows = rows_at::<D, 3, QuadraticSpline>(grid, support, place, &no_domain);
                visit_product(grid, &rows, visitor);
            }
            Self::Bspline3 => {
                visit_product(grid, &rows_at::<D, 4, CubicSpline>(grid, support, place, &no_domain), visitor);
            }
        }
    }

    fn outermost_node(self, height: f64) -> Option<usize> {
        match self {
            Self::Bspline2 => Some(integer_part(height + 0.5)),
            // The upper node of the cell that the surface is in; one on a face is in the cell below.
            Self::Bspline3 => Some(integer_part(height - ON_A_FACE) + 1),
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
    stencils.truncate(places.len());
    wide!(for (point, (place, half_length)) in places.iter().zip(half_lengths).enumerate() {
        stencils.set(grid, point, &rows_at::<D, W, S>(grid, support, place, half_length));
    });
}

/// Rows of a basis at a place (in cells), for a domain of half-lengths (m), without nodes beyond held faces:
/// `[direction]`.
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

/// Builds the lowest nodes and the lines of `N` points from their places (in cells), the half-lengths of their domains (m) and
/// their cells (whole numbers), `[point][direction]`, without nodes beyond held faces.
#[inline(always)]
pub(crate) fn build_blocks<const D: usize, const W: usize, const N: usize, S: ShapeFunction<W>>(
    grid: &Grid<D>,
    support: &Support<D>,
    [places, half_lengths, cells]: [&[Vector<D>; N]; 3],
    first: &mut [usize; N],
    lines: &mut [[Line<W>; D]; N],
) {
    let (per_cell, stride) = (grid.inverse_cell_size(), grid.node_stride().map(|stride| stride as f64));
    // `[node][point][direction]`: every line of a shape function is a loop over points and directions.
    let mut lowest = [0.0; N];
    let [mut values, mut gradients] = [[[[0.0; D]; N]; W]; 2];
    for p in 0..N {
        for d in 0..D {
            let half_length = half_lengths[p][d] * per_cell;
            let (node, mut shares) = S::nodes(places[p][d], cells[p][d], half_length);
            if S::PASSES_WALLS {
                let row = Row { first: integer_part(node), values: shares[0], gradients: shares[1] };
                let row = folded(support, grid, d, row);
                shares = [row.values, row.gradients];
            }
            lowest[p] += node * stride[d];
            for k in 0..W {
                (values[k][p][d], gradients[k][p][d]) = (shares[0][k], shares[1][k] * per_cell);
            }
        }
    }
    let mut rows = (lowest, values, gradients);
    if N > 1 {
        // In memory point beside point: otherwise the compiler works row by row.
        black_box(&mut rows);
    }
    let (lowest, values, gradients) = &rows;
    for p in 0..N {
        first[p] = integer_part(lowest[p]);
        for d in 0..D {
            let line = &mut lines[p][d];
            for k in 0..W {
                (line.values[k], line.gradients[k]) = (values[k][p][d], gradients[k][p][d]);
            }
        }
    }
}

/// A row along a direction without nodes beyond held faces, nor far beyond a free surface: those
/// have no freedom of their own.
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

/// Visits the nodes of a tensor product of rows with the values of their shape functions.
fn visit_product<const D: usize, const W: usize>(
    grid: &Grid<D>,
    rows: &[Row<W>; D],
    mut visitor: impl FnMut(usize, f64),
) {
    for corner in 0..power(W, D) {
        let (mut node, mut value, mut rest) = (0, 1.0, corner);
        for direction in 0..D {
            let k = rest % W;
            rest /= W;
            node += (rows[direction].first + k) * grid.node_stride()[direction];
            value *= rows[direction].values[k];
        }
        visitor(node, value);
    }
}

/// `max(x, 0)` in one instruction; `f64::max` takes three to mind a NaN.
#[inline(always)]
fn positive_part(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// Values and gradients of three nodes from those of the outer two: the middle one has what is left.
#[inline(always)]
fn about_middle([left, right]: [f64; 2], [left_slope, right_slope]: [f64; 2]) -> [[f64; 3]; 2] {
    [[left, 1.0 - left - right, right], [left_slope, -left_slope - right_slope, right_slope]]
}

/// Piecewise linear hat functions (Sulsky, Chen & Schreyer 1994).
#[derive(Clone, Copy, Debug)]
pub struct Hat;

impl ShapeFunction<2> for Hat {
    #[inline(always)]
    fn nodes(place: f64, cell: f64, _half_length: f64) -> (f64, [[f64; 2]; 2]) {
        let upper = place - cell;
        (cell, [[1.0 - upper, upper], [-1.0, 1.0]])
    }
}

/// The hat function convolved with the top-hat domain of a point (Bardenhagen & Kober 2004,
/// Eq. 24); a domain wider than a cell would need a fourth node and is cut there.
///
/// The outer values come from squared overlaps with the nearest node's sides, the middle one is
/// what is left: no branch, and the partition of unity is exact.
#[derive(Clone, Copy, Debug)]
pub struct Gimp;

impl ShapeFunction<3> for Gimp {
    #[inline(always)]
    fn nodes(place: f64, _cell: f64, half_length: f64) -> (f64, [[f64; 3]; 2]) {
        let nearest = (place + 0.5).floor();
        let half_length = half_length.min(0.5);
        let offset = place - nearest;
        let (low, high) = (offset - half_length, offset + half_length);
        let per_length = 0.5 / half_length;
        let (left_near, left_far) = (positive_part(-high), positive_part(-low));
        let (right_near, right_far) = (positive_part(low), positive_part(high));
        let left = 0.5 * per_length * (left_far * left_far - left_near * left_near);
        let right = 0.5 * per_length * (right_far * right_far - right_near * right_near);
        let slopes = [-per_length * (left_far - left_near), per_length * (right_far - right_near)];
        (nearest - 1.0, about_middle([left, right], slopes))
    }
}

/// The hat functions averaged over the two ends of a point's domain (CPDI, Sadeghirad, Brannon &
/// Burghardt 2011, in one direction); domains wider than a cell are cut there.
///
/// The gradient is the difference between the ends over the length, which is that of GIMP; the
/// values move the middle of the domain as its ends move, so that neighbours stay neighbours.
#[derive(Clone, Copy, Debug)]
pub struct DomainEnds;

impl ShapeFunction<3> for DomainEnds {
    #[inline(always)]
    fn nodes(place: f64, _cell: f64, half_length: f64) -> (f64, [[f64; 3]; 2]) {
        let half_length = half_length.min(0.5);
        let (low, high) = (place - half_length, place + half_length);
        let first = low.floor();
        let middle = first + 1.0;
        // The end below the middle node weighs in on its left, the one above on its right.
        let at = |end: f64| [positive_part(middle - end), positive_part(end - middle)];
        let ([low_left, low_right], [high_left, high_right]) = (at(low), at(high));
        let per_length = 0.5 / half_length;
        let values = [0.5 * (low_left + high_left), 0.5 * (low_right + high_right)];
        let slopes = [per_length * (high_left - low_left), per_length * (high_right - low_right)];
        (first, about_middle(values, slopes))
    }
}

/// Quadratic B-splines about the nodes (Steffen, Kirby & Berzins 2008).
#[derive(Clone, Copy, Debug)]
pub struct QuadraticSpline;

impl ShapeFunction<3> for QuadraticSpline {
    const PASSES_WALLS: bool = true;

    #[inline(always)]
    fn nodes(place: f64, _cell: f64, _half_length: f64) -> (f64, [[f64; 3]; 2]) {
        let nearest = (place + 0.5).floor();
        let x = place - nearest;
        let (left, right) = (0.5 * (0.5 - x) * (0.5 - x), 0.5 * (0.5 + x) * (0.5 + x));
        (nearest - 1.0, about_middle([left, right], [x - 0.5, x + 0.5]))
    }
}

/// Cubic B-splines about the nodes.
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline;

impl ShapeFunction<4> for CubicSpline {
    const PASSES_WALLS: bool = true;

    #[inline(always)]
    fn nodes(place: f64, cell: f64, _half_length: f64) -> (f64, [[f64; 4]; 2]) {
        let x = place - cell;
        let y = 1.0 - x;
        let (outer_left, outer_right) = (y * y * y / 6.0, x * x * x / 6.0);
        let left = 2.0 / 3.0 - x * x * (1.0 - 0.5 * x);
        let (left_slope, right_slope) = (-2.0 * x + 1.5 * x * x, 2.0 * y - 1.5 * y * y);
        let values = [outer_left, left, 1.0 - outer_left - left - outer_right, outer_right];
        (cell - 1.0, [values, [-0.5 * y * y, left_slope, right_slope, 0.5 * x * x]])
    }
}

/// Moments of a row: sums of `f(node)` with the values, and with the gradients.
#[cfg(test)]
pub(crate) fn moments<const W: usize>(row: &Row<W>, f: impl Fn(f64) -> f64) -> (f64, f64) {
    (0..W).fold((0.0, 0.0), |(value, gradient), k| {
        let node = f((row.first + k) as f64);
        (value + row.values[k] * node, gradient + row.gradients[k] * node)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
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
        fn gradients_are_those_of_the_values(place in 3.01..8.99f64) {
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
        fn gimp_values_are_never_negative(place in 3.0..9.0f64, half_length in 0.01..0.5f64) {
            let row = Gimp::row(place, 0, half_length);
            prop_assert!(row.values.iter().all(|w| *w >= -1e-16));
            prop_assert!((row.values.iter().sum::<f64>() - 1.0).abs() < 1e-15);
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
                prop_assert!((mean - row.values[k]).abs() < 1e-6);
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
                assert!((row.values[slot] - hat.values[k]).abs() < 1e-15);
                assert!((row.gradients[slot] - hat.gradients[k]).abs() < 1e-15);
            }
        }
    }

    proptest! {
        #[test]
        fn rows_between_walls_meet_linear_fields(place in 5.0..6.5f64, width in 1..3_usize) {
            // Walls at node 5 and `width` cells above it.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let (place, cell) = (place.min(5.0 + width as f64 - 1e-9), (place as usize).min(4 + width));
            let held = |node: usize| node < 5 || node > 5 + width;
            let linear = |x: f64| 2.0 + 3.0 * (x - 5.0);
            let (mut quadratic, mut cubic) = (QuadraticSpline::row(place, 0, 0.0), CubicSpline::row(place, cell, 0.0));
            for (wall, above) in [(5, false), (5 + width, true)] {
                let is_beyond = |node: usize| if above { node > wall } else { node < wall };
                quadratic.fold_at(wall, is_beyond);
                cubic.fold_at(wall, is_beyond);
            }
            for (value, gradient) in [moments(&quadratic, linear), moments(&cubic, linear)] {
                prop_assert!((value - linear(place)).abs() < 1e-12);
                prop_assert!((gradient - 3.0).abs() < 1e-12);
            }
            prop_assert!((quadratic.values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((cubic.values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((0..3).all(|k| !held(quadratic.first + k) || quadratic.values[k] == 0.0));
            prop_assert!((0..4).all(|k| !held(cubic.first + k) || cubic.values[k] == 0.0));
        }

        #[test]
        fn a_row_behind_a_wall_stays_as_it_is(place in 2.5..4.4f64) {
            let (mut quadratic, mut cubic) = (QuadraticSpline::row(place, 0, 0.0), CubicSpline::row(place, integer_part(place), 0.0));
            let before = quadratic;
            quadratic.fold_at(7, |node| node < 7);
            cubic.fold_at(7, |node| node < 7);
            prop_assert_eq!(before, quadratic);
            prop_assert!((cubic.values.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn rows_that_end_at_a_surface_meet_linear_fields(place in 5.0..6.0f64, above in 0.0..0.5f64) {
            let linear = |x: f64| 2.0 + 3.0 * x;
            let (mut quadratic, mut cubic) = (QuadraticSpline::row(place, 0, 0.0), CubicSpline::row(place, 5, 0.0));
            // The surface lies a little above the place, and the last node beside it.
            let last = integer_part(place + above + 0.5);
            quadratic.straighten_beyond(last.max(quadratic.first + 1));
            cubic.straighten_beyond(5);
            for (row, end) in [(moments(&quadratic, linear), last), (moments(&cubic, linear), 5)] {
                prop_assert!((row.0 - linear(place)).abs() < 1e-12 && (row.1 - 3.0).abs() < 1e-12, "{end}");
            }
            prop_assert_eq!(&cubic.values[2..], &[0.0, 0.0]);
        }
    }
}
