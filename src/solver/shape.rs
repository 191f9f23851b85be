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
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "coordinates in cells are positive, the ghost layers see to it"
)]
pub fn gimp(place: f64, half_length: f64) -> Row<3> {
    let nearest = (place + 0.5) as usize;
    let offset = place - nearest as f64;
    let (low, high) = (offset - half_length, offset + half_length);
    let per_length = 0.5 / half_length;
    let (left_near, left_far) = ((-high).max(0.0), (-low).max(0.0));
    let (right_near, right_far) = (low.max(0.0), high.max(0.0));
    let left = 0.5 * per_length * (left_far * left_far - left_near * left_near);
    let right = 0.5 * per_length * (right_far * right_far - right_near * right_near);
    let left_gradient = -per_length * (left_far - left_near);
    let right_gradient = per_length * (right_far - right_near);
    Row {
        first: nearest - 1,
        weights: [left, 1.0 - left - right, right],
        gradients: [left_gradient, -left_gradient - right_gradient, right_gradient],
    }
}

/// Lagrange interpolation through the nodes of a cell and of its neighbours, for the composite
/// MPM (González Acosta, Vardon & Hicks 2017): cubic with both neighbours, quadratic with one,
/// linear with none. Always written as four weights from the node below the cell.
#[inline]
pub fn composite(place: f64, cell: usize, has_lower: bool, has_upper: bool) -> Row<4> {
    // Local coordinate with the cell's own nodes at 0 and 1.
    let x = place - cell as f64;
    let (weights, gradients) = match (has_lower, has_upper) {
        (true, true) => (
            [
                -x * (x - 1.0) * (x - 2.0) / 6.0,
                (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
                -(x + 1.0) * x * (x - 2.0) / 2.0,
                (x + 1.0) * x * (x - 1.0) / 6.0,
            ],
            [
                -(3.0 * x * x - 6.0 * x + 2.0) / 6.0,
                (3.0 * x * x - 4.0 * x - 1.0) / 2.0,
                -(3.0 * x * x - 2.0 * x - 2.0) / 2.0,
                (3.0 * x * x - 1.0) / 6.0,
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
            ] {
                prop_assert!((value - (2.0 + 3.0 * place)).abs() < 1e-12, "value {value}");
                prop_assert!((gradient - 3.0).abs() < 1e-11, "gradient {gradient}");
            }
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
