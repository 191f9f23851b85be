//! Shape functions of one direction, in units of the cell: the rows that a stencil is made of.
//!
//! `W` is the number of nodes a row may touch. Every row sums to one and its gradients to zero,
//! by construction and not up to round-off of a normalisation.

/// Weights and gradients of one point in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<const W: usize> {
    /// Lowest node of the row.
    pub first: usize,
    /// Weight of each node.
    pub weights: [f64; W],
    /// Gradient of each weight, 1/cell.
    pub gradients: [f64; W],
}

/// Whole part of a coordinate in cells; 32 bits convert several times faster than 64.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "coordinates in cells are positive, the ghost layers see to it"
)]
pub(crate) fn whole(in_cells: f64) -> usize {
    in_cells as u32 as usize
}

/// `max(x, 0)` in one instruction; `f64::max` takes three to mind a NaN.
#[inline]
fn positive_part(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// Piecewise linear hat functions (Sulsky, Chen & Schreyer 1994): `cell` is the cell that holds
/// `place`, both counted in cells.
#[inline]
pub fn hat(place: f64, cell: usize) -> Row<2> {
    let upper = place - cell as f64;
    Row { first: cell, weights: [1.0 - upper, upper], gradients: [-1.0, 1.0] }
}

/// The hat function convolved with the top-hat domain of a point (Bardenhagen & Kober 2004,
/// Eq. 24), `half_length` in cells and at most one half.
///
/// The outer weights come from squared overlaps with the nearest node's sides, the middle one is
/// what is left: no branch, and the partition of unity is exact.
#[inline]
pub fn gimp(place: f64, half_length: f64) -> Row<3> {
    let nearest = whole(place + 0.5);
    let offset = place - nearest as f64;
    let (low, high) = (offset - half_length, offset + half_length);
    let per_length = 0.5 / half_length;
    let (left_near, left_far) = (positive_part(-high), positive_part(-low));
    let (right_near, right_far) = (positive_part(low), positive_part(high));
    let left = 0.5 * per_length * (left_far * left_far - left_near * left_near);
    let right = 0.5 * per_length * (right_far * right_far - right_near * right_near);
    let left_gradient = -per_length * (left_far - left_near);
    let right_gradient = per_length * (right_far - right_near);
    Row::about(nearest, [left, right], [left_gradient, right_gradient])
}

/// The hat functions averaged over the two ends of a point's domain (CPDI, Sadeghirad, Brannon &
/// Burghardt 2011, in one direction), `half_length` in cells and at most one half.
///
/// The gradient is the difference between the ends over the length, which is that of GIMP; the
/// weights move the middle of the domain as its ends move, so that neighbours stay neighbours.
#[inline]
pub fn domain_ends(place: f64, half_length: f64) -> Row<3> {
    let (low, high) = (place - half_length, place + half_length);
    let first = whole(low);
    let middle = first as f64 + 1.0;
    // The end below the middle node weighs in on its left, the one above on its right.
    let at = |end: f64| [positive_part(middle - end), positive_part(end - middle)];
    let ([low_left, low_right], [high_left, high_right]) = (at(low), at(high));
    let per_length = 0.5 / half_length;
    let (left, right) = (0.5 * (low_left + high_left), 0.5 * (low_right + high_right));
    let (left_gradient, right_gradient) =
        (per_length * (high_left - low_left), per_length * (high_right - low_right));
    Row::about(first + 1, [left, right], [left_gradient, right_gradient])
}

/// Quadratic B-splines about the nodes (Steffen, Kirby & Berzins 2008).
#[inline]
pub fn quadratic_spline(place: f64) -> Row<3> {
    let nearest = whole(place + 0.5);
    let x = place - nearest as f64;
    let (left, right) = (0.5 * (0.5 - x) * (0.5 - x), 0.5 * (0.5 + x) * (0.5 + x));
    Row::about(nearest, [left, right], [x - 0.5, x + 0.5])
}

/// Cubic B-splines about the nodes, at a place in a cell.
#[inline]
pub fn cubic_spline(place: f64, cell: usize) -> Row<4> {
    let x = place - cell as f64;
    let y = 1.0 - x;
    let (outer_left, outer_right) = (y * y * y / 6.0, x * x * x / 6.0);
    let left = 2.0 / 3.0 - x * x * (1.0 - 0.5 * x);
    let (left_gradient, right_gradient) = (-2.0 * x + 1.5 * x * x, 2.0 * y - 1.5 * y * y);
    Row {
        first: cell - 1,
        weights: [outer_left, left, 1.0 - outer_left - left - outer_right, outer_right],
        gradients: [-0.5 * y * y, left_gradient, right_gradient, 0.5 * x * x],
    }
}

impl Row<3> {
    /// The row about a node from the weights and gradients of its neighbours: the node has what is left.
    #[inline]
    fn about(node: usize, [left, right]: [f64; 2], [left_gradient, right_gradient]: [f64; 2]) -> Self {
        Self {
            first: node - 1,
            weights: [left, 1.0 - left - right, right],
            gradients: [left_gradient, -left_gradient - right_gradient, right_gradient],
        }
    }
}

impl<const W: usize> Row<W> {
    /// Takes the nodes beyond a wall out of the row: a field goes on there as a line through its value
    /// at the wall and that at the mirrored node, which for a velocity that the wall holds is its odd
    /// image. Linear fields are still met exactly, and the weights still add up to one; a field that bends
    /// at the wall, as above a rough base, is met to first order there.
    #[inline]
    pub fn fold_at(&mut self, wall: usize, is_beyond: impl Fn(usize) -> bool) {
        for k in 0..W {
            let node = self.first + k;
            if is_beyond(node) {
                // A row that lies behind the wall altogether is of a run that is lost, and stays as it is.
                let at_wall = wall.wrapping_sub(self.first);
                let mirrored = (2 * wall).wrapping_sub(node + self.first);
                if at_wall >= W || mirrored >= W {
                    continue;
                }
                for side in [&mut self.weights, &mut self.gradients] {
                    let beyond = std::mem::replace(&mut side[k], 0.0);
                    side[at_wall] += 2.0 * beyond;
                    side[mirrored] -= beyond;
                }
            }
        }
    }

    /// Takes the nodes above a last one out of the row: their values go on along the line through the last
    /// two. Linear fields are still met exactly, and the weights still add up to one. A row that would be
    /// left with one node keeps two.
    #[inline]
    pub fn straighten_beyond(&mut self, last: usize) {
        let last = last.saturating_sub(self.first).max(1);
        for k in 0..W {
            let beyond = k.saturating_sub(last) as f64;
            if beyond > 0.0 {
                for side in [&mut self.weights, &mut self.gradients] {
                    let share = std::mem::replace(&mut side[k], 0.0);
                    side[last] += (1.0 + beyond) * share;
                    side[last - 1] -= beyond * share;
                }
            }
        }
    }

    /// Mean of two rows, and the slope between them `length` apart, as a row of up to `V` nodes.
    #[inline]
    pub fn between<const V: usize>(low: &Self, high: &Self, length: f64) -> Row<V> {
        let first = low.first.min(high.first);
        let mut row = Row { first, weights: [0.0; V], gradients: [0.0; V] };
        for (end, sign) in [(low, -1.0), (high, 1.0)] {
            for k in 0..W {
                // Ends more than a cell apart are no domain: what has no place is left out.
                if let Some(weight) = row.weights.get_mut(end.first - first + k) {
                    *weight += 0.5 * end.weights[k];
                    row.gradients[end.first - first + k] += sign * end.weights[k] / length;
                }
            }
        }
        row
    }
}

/// No division in the step's innermost loops.
pub(crate) const SIXTH: f64 = 1.0 / 6.0;

/// Lagrange interpolation through the nodes of a cell and of its neighbours, for the composite
/// MPM (González Acosta, Vardon & Hicks 2017): cubic with both neighbours, quadratic with one,
/// linear with none. Always written as four weights from the node below the cell.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
pub fn composite(place: f64, cell: usize, has_lower: bool, has_upper: bool) -> Row<4> {
    // Local coordinate with the cell's own nodes at 0 and 1.
    let x = place - cell as f64;
    let (weights, gradients) = match (has_lower, has_upper) {
        (true, true) => (
            [
                -SIXTH * x * (x - 1.0) * (x - 2.0),
                0.5 * (x + 1.0) * (x - 1.0) * (x - 2.0),
                -0.5 * (x + 1.0) * x * (x - 2.0),
                SIXTH * (x + 1.0) * x * (x - 1.0),
            ],
            [
                x - 0.5 * x * x - 2.0 * SIXTH,
                0.5 * (3.0 * x * x - 4.0 * x - 1.0),
                -0.5 * (3.0 * x * x - 2.0 * x - 2.0),
                0.5 * x * x - SIXTH,
            ],
        ),
        (true, false) => (
            [x * (x - 1.0) / 2.0, (1.0 + x) * (1.0 - x), x * (x + 1.0) / 2.0, 0.0],
            [x - 0.5, -2.0 * x, x + 0.5, 0.0],
        ),
        (false, true) => (
            [0.0, (x - 1.0) * (x - 2.0) / 2.0, x * (2.0 - x), x * (x - 1.0) / 2.0],
            [0.0, x - 1.5, 2.0 - 2.0 * x, x - 0.5],
        ),
        (false, false) => ([0.0, 1.0 - x, x, 0.0], [0.0, -1.0, 1.0, 0.0]),
    };
    Row { first: cell - 1, weights, gradients }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Moment of a row: sum of `f(node)` with the weights, and with the gradients.
    fn moments<const W: usize>(row: &Row<W>, f: impl Fn(f64) -> f64) -> (f64, f64) {
        (0..W).fold((0.0, 0.0), |(value, gradient), k| {
            let node = f((row.first + k) as f64);
            (value + row.weights[k] * node, gradient + row.gradients[k] * node)
        })
    }

    proptest! {
        #[test]
        fn hat_and_gimp_reproduce_a_linear_field(place in 3.0..9.0f64, half_length in 0.01..0.5f64) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let cell = place as usize;
            for (value, gradient) in [
                moments(&hat(place, cell), |x| 2.0 + 3.0 * x),
                moments(&gimp(place, half_length), |x| 2.0 + 3.0 * x),
                moments(&domain_ends(place, half_length), |x| 2.0 + 3.0 * x),
                moments(&quadratic_spline(place), |x| 2.0 + 3.0 * x),
                moments(&cubic_spline(place, cell), |x| 2.0 + 3.0 * x),
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
                let quadratic = slope(&|x| moments(&quadratic_spline(x), cube).0);
                prop_assert!((moments(&quadratic_spline(place), cube).1 - quadratic).abs() < 1e-4);
                let cubic = slope(&|x| moments(&cubic_spline(x, cell), cube).0);
                prop_assert!((moments(&cubic_spline(place, cell), cube).1 - cubic).abs() < 1e-4);
            }
        }

        #[test]
        fn rows_between_walls_meet_linear_fields(place in 5.0..6.5f64, width in 1..3_usize) {
            // Walls at node 5 and `width` cells above it.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let (place, cell) = (place.min(5.0 + width as f64 - 1e-9), (place as usize).min(4 + width));
            let held = |node: usize| node < 5 || node > 5 + width;
            let linear = |x: f64| 2.0 + 3.0 * (x - 5.0);
            let (mut quadratic, mut cubic) = (quadratic_spline(place), cubic_spline(place, cell));
            for (wall, above) in [(5, false), (5 + width, true)] {
                let is_beyond = |node: usize| if above { node > wall } else { node < wall };
                quadratic.fold_at(wall, is_beyond);
                cubic.fold_at(wall, is_beyond);
            }
            for (value, gradient) in [moments(&quadratic, linear), moments(&cubic, linear)] {
                prop_assert!((value - linear(place)).abs() < 1e-12);
                prop_assert!((gradient - 3.0).abs() < 1e-12);
            }
            prop_assert!((quadratic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((cubic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((0..3).all(|k| !held(quadratic.first + k) || quadratic.weights[k] == 0.0));
            prop_assert!((0..4).all(|k| !held(cubic.first + k) || cubic.weights[k] == 0.0));
        }

        #[test]
        fn a_row_behind_a_wall_stays_as_it_is(place in 2.5..4.4f64) {
            let (mut quadratic, mut cubic) = (quadratic_spline(place), cubic_spline(place, whole(place)));
            let before = quadratic;
            quadratic.fold_at(7, |node| node < 7);
            cubic.fold_at(7, |node| node < 7);
            prop_assert_eq!(before, quadratic);
            prop_assert!((cubic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn rows_that_end_at_a_surface_meet_linear_fields(place in 5.0..6.0f64, above in 0.0..0.5f64) {
            let linear = |x: f64| 2.0 + 3.0 * x;
            let (mut quadratic, mut cubic) = (quadratic_spline(place), cubic_spline(place, 5));
            // The surface lies a little above the place, and the last node beside it.
            let last = whole(place + above + 0.5);
            quadratic.straighten_beyond(last.max(quadratic.first + 1));
            cubic.straighten_beyond(5);
            for (row, end) in [(moments(&quadratic, linear), last), (moments(&cubic, linear), 5)] {
                prop_assert!((row.0 - linear(place)).abs() < 1e-12 && (row.1 - 3.0).abs() < 1e-12, "{end}");
            }
            prop_assert_eq!(&cubic.weights[2..], &[0.0, 0.0]);
        }

        #[test]
        fn a_row_between_ends_adds_up_to_the_field(low in 3.0..8.0f64, length in 0.05..0.9f64) {
            // Cubic fields are met exactly at both ends, so their difference is too.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "test range")]
            let row_at = |x: f64| composite(x, x as usize, true, true);
            let row = Row::between::<6>(&row_at(low), &row_at(low + length), length);
            let cubic = |x: f64| x * x * x - 4.0 * x;
            let (mean, slope) = moments(&row, cubic);
            prop_assert!((mean - 0.5 * (cubic(low) + cubic(low + length))).abs() < 1e-10);
            prop_assert!((slope - (cubic(low + length) - cubic(low)) / length).abs() < 1e-9);
        }

        #[test]
        fn gimp_weights_are_never_negative(place in 3.0..9.0f64, half_length in 0.01..0.5f64) {
            let row = gimp(place, half_length);
            prop_assert!(row.weights.iter().all(|w| *w >= -1e-16));
            prop_assert!((row.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }

        #[test]
        fn gimp_is_the_hat_averaged_over_the_domain(place in 3.0..9.0f64, half_length in 0.05..0.5f64) {
            // Midpoint rule of the definition, fine enough for its kinks.
            let row = gimp(place, half_length);
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

        #[test]
        fn composite_gradient_is_exact_for_its_degree(x in 0.0..1.0f64, lower: bool, upper: bool) {
            let row = composite(5.0 + x, 5, lower, upper);
            let degree = 1 + i32::from(lower) + i32::from(upper);
            for power in 0..=degree {
                let (value, gradient) = moments(&row, |node| (node - 5.0).powi(power));
                let exact = if power == 0 { 0.0 } else { f64::from(power) * x.powi(power - 1) };
                prop_assert!((value - x.powi(power)).abs() < 1e-13);
                prop_assert!((gradient - exact).abs() < 1e-12, "power {power}: {gradient} for {exact}");
            }
        }
    }

    #[test]
    fn gimp_with_domains_that_tile_the_cell_has_the_hat_s_mean_gradient() {
        // On the regular lattice the domains tile the cells, so GIMP equals the hat.
        for place in [5.25, 5.75] {
            let row = gimp(place, 0.25);
            let hat = hat(place, 5);
            for k in 0..2 {
                let slot = hat.first + k - row.first;
                assert!((row.weights[slot] - hat.weights[k]).abs() < 1e-15);
                assert!((row.gradients[slot] - hat.gradients[k]).abs() < 1e-15);
            }
        }
    }
}
