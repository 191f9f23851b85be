//! Rows: weights and gradients of one point in one direction, over neighbouring nodes, in units of the cell.
//!
//! Every row sums to one and its gradients to zero, by construction and not up to round-off of a normalisation.

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

/// Moment of a row: sum of `f(node)` with the weights, and with the gradients.
#[cfg(test)]
pub(crate) fn moments<const W: usize>(row: &Row<W>, f: impl Fn(f64) -> f64) -> (f64, f64) {
    (0..W).fold((0.0, 0.0), |(value, gradient), k| {
        let node = f((row.first + k) as f64);
        (value + row.weights[k] * node, gradient + row.gradients[k] * node)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::basis::{CubicSpline, QuadraticSpline, ShapeFunction};
    use crate::state::grid::whole;
    use proptest::prelude::*;

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
            prop_assert!((quadratic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((cubic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((0..3).all(|k| !held(quadratic.first + k) || quadratic.weights[k] == 0.0));
            prop_assert!((0..4).all(|k| !held(cubic.first + k) || cubic.weights[k] == 0.0));
        }

        #[test]
        fn a_row_behind_a_wall_stays_as_it_is(place in 2.5..4.4f64) {
            let (mut quadratic, mut cubic) = (QuadraticSpline::row(place, 0, 0.0), CubicSpline::row(place, whole(place), 0.0));
            let before = quadratic;
            quadratic.fold_at(7, |node| node < 7);
            cubic.fold_at(7, |node| node < 7);
            prop_assert_eq!(before, quadratic);
            prop_assert!((cubic.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn rows_that_end_at_a_surface_meet_linear_fields(place in 5.0..6.0f64, above in 0.0..0.5f64) {
            let linear = |x: f64| 2.0 + 3.0 * x;
            let (mut quadratic, mut cubic) = (QuadraticSpline::row(place, 0, 0.0), CubicSpline::row(place, 5, 0.0));
            // The surface lies a little above the place, and the last node beside it.
            let last = whole(place + above + 0.5);
            quadratic.straighten_beyond(last.max(quadratic.first + 1));
            cubic.straighten_beyond(5);
            for (row, end) in [(moments(&quadratic, linear), last), (moments(&cubic, linear), 5)] {
                prop_assert!((row.0 - linear(place)).abs() < 1e-12 && (row.1 - 3.0).abs() < 1e-12, "{end}");
            }
            prop_assert_eq!(&cubic.weights[2..], &[0.0, 0.0]);
        }
    }
}
