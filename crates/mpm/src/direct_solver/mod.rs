//! Direct solution of the linear systems of implicit steps and of the undrained start.
//!
//! A column's matrix is a narrow band ([`banded`]). The matrix of a body in the plane is sparse and is factored front by
//! front ([`frontal`]) in the order of nested dissection ([`dissection`]), which costs `N^1.5` operations where a band
//! costs `N^2`; solutions read the factors in the order in which [`panels`] store them. [`system`] chooses between the two
//! and adds the row and column of a rigid plate.

mod banded;
pub(crate) mod dense;
mod dissection;
mod frontal;
mod panels;
mod sparse_matrix;
pub mod system;

use crate::wide::wide;
use std::array;

/// Independent partial sums of a dot product.
const PARTS: usize = 16;

/// A matrix that has no inverse to working precision. A factorisation that was given up because the time of the run was
/// over ends with it too; the caller, who knows the time limit, tells the two apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The row without a pivot.
    pub row: usize,
}

/// Dot product by independent partial sums.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    wide!({
        let ((a, rest_of_a), (b, rest_of_b)) = (a.as_chunks::<PARTS>(), b.as_chunks::<PARTS>());
        let mut sums = [0.0; PARTS];
        for (a, b) in a.iter().zip(b) {
            for part in 0..PARTS {
                sums[part] += a[part] * b[part];
            }
        }
        let rest: f64 = rest_of_a.iter().zip(rest_of_b).map(|(a, b)| a * b).sum();
        sums.iter().sum::<f64>() + rest
    })
}

/// The first rows of a column; zeros beyond its end.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn first_rows<const N: usize>(column: &[f64]) -> [f64; N] {
    match column.first_chunk() {
        Some(rows) => *rows,
        None => array::from_fn(|row| column.get(row).copied().unwrap_or(0.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_products_take_every_place() {
        for count in [0, 1, PARTS - 1, PARTS, 5 * PARTS + 3] {
            let numbers: Vec<f64> = (1..=count).map(|i| i as f64).collect();
            let exact = count * (count + 1) * (2 * count + 1) / 6;
            assert_eq!(dot(&numbers, &numbers), exact as f64, "{count}");
        }
    }
}
