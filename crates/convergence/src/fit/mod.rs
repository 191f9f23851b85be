//! Fits of an error over refinement, and the least squares and searches that they share.

pub(crate) mod approach_to_limit;
pub(crate) mod bending_order;
pub(crate) mod floor;
pub(crate) mod odd_level;
pub(crate) mod two_terms;

use nalgebra::{DMatrix, DVector};
use oedometer_soil::elementary::{exp_m1, ln, powf};

/// An exponent that is given, or searched for in a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exponent {
    /// This one.
    Fixed(f64),
    /// The best between these two.
    Between(f64, f64),
}

/// Coefficients and sum of squares of a linear fit.
pub(crate) type LinearFit = (Vec<f64>, f64);

/// Solves `min Σ w_i (Σ_j c_j a_ij − y_i)²`; returns the coefficients and the weighted sum of squares, or `None`
/// where the columns do not determine them.
pub(crate) fn solve(columns: &[Vec<f64>], target: &[f64], weights: &[f64]) -> Option<LinearFit> {
    let root = |row: usize| weights[row].sqrt();
    let matrix =
        DMatrix::from_fn(target.len(), columns.len(), |row, column| root(row) * columns[column][row]);
    let wanted = DVector::from_fn(target.len(), |row, _| root(row) * target[row]);
    if matrix.iter().chain(wanted.iter()).any(|value| !value.is_finite()) {
        return None;
    }
    let svd = matrix.clone().svd(true, true);
    if svd.singular_values.min() <= 1e-12 * svd.singular_values.max() {
        return None;
    }
    let coefficients = svd.solve(&wanted, 0.0).ok()?;
    let square = (&matrix * &coefficients - &wanted).norm_squared();
    Some((coefficients.iter().copied().collect(), square))
}

/// Fits (size, value) levels by `c_0 + Σ_j c_j h^{p_j}` with weights; sizes should be of the order of 1.
pub(crate) fn fit_powers(levels: &[(f64, f64)], exponents: &[f64], weights: &[f64]) -> Option<LinearFit> {
    let power = |p: &f64| levels.iter().map(|level| powf(level.0, *p)).collect();
    let mut columns = vec![vec![1.0; levels.len()]];
    columns.extend(exponents.iter().map(power));
    let target: Vec<f64> = levels.iter().map(|level| level.1).collect();
    solve(&columns, &target, weights)
}

/// The exponent `p` in a range for which `c_0 + c_1 h^p` fits the levels best.
pub(crate) fn best_power(levels: &[(f64, f64)], range: Exponent, weights: &[f64]) -> f64 {
    minimum(range, |p| fit_powers(levels, &[p], weights).map_or(f64::INFINITY, |fit| fit.1))
}

/// Minimises a function of one exponent: a scan, then golden sections about the best place.
pub(crate) fn minimum(exponent: Exponent, value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 48;
    const SHRINK: f64 = 0.618_033_988_749_894_9;
    let (from, to) = match exponent {
        Exponent::Fixed(exponent) => return exponent,
        Exponent::Between(from, to) => (from, to),
    };
    let place = |step: u32| from + (to - from) * f64::from(step) / f64::from(STEPS);
    let best = (0..=STEPS)
        .map(|step| (step, value(place(step))))
        .fold((0, f64::INFINITY), |best, new| if new.1 < best.1 { new } else { best });
    let (mut left, mut right) = (place(best.0.saturating_sub(1)), place((best.0 + 1).min(STEPS)));
    let (mut a, mut b) = (right - SHRINK * (right - left), left + SHRINK * (right - left));
    let (mut at_a, mut at_b) = (value(a), value(b));
    while right - left > 1e-15 * right.abs().max(1.0) && a < b {
        if at_a <= at_b {
            (right, b, at_b) = (b, a, at_a);
            a = right - SHRINK * (right - left);
            at_a = value(a);
        } else {
            (left, a, at_a) = (a, b, at_b);
            b = left + SHRINK * (right - left);
            at_b = value(b);
        }
    }
    // The end of the range itself may be best, and the scan is never worse than what it found.
    let better = |best: f64, other: f64| if value(other) < value(best) { other } else { best };
    [from, to, place(best.0)].into_iter().fold(f64::midpoint(left, right), better)
}

/// Largest order that [`order_of_differences`] looks for.
const LARGEST_ORDER: f64 = 50.0;

/// The order `p` of values `c_0 + c_1 h^p` on three levels, from the ratio of their differences:
/// `(φ3 − φ2)/(φ2 − φ1) = r21^p (r32^p − 1)/(r21^p − 1)`, fine to coarse 1, 2, 3 (Celik et al. 2008, Eq. 3).
///
/// The right side rises with `p` from `ln r32/ln r21`, so bisection finds it; `None` above 50.
pub(crate) fn order_of_differences(ratio: f64, r21: f64, r32: f64) -> Option<f64> {
    let (a, b) = (ln(r21), ln(r32));
    // The logarithm of the right side, which stays in range for large orders.
    let side = |p: f64| b * p + ln(-exp_m1(-b * p)) - ln(-exp_m1(-a * p));
    let wanted = ln(ratio);
    let (mut low, mut high) = (0.0, LARGEST_ORDER);
    if side(high).partial_cmp(&wanted) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if side(middle) < wanted { low = middle } else { high = middle }
    }
    Some(f64::midpoint(low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_combination_is_found_and_a_singular_one_is_not() {
        let columns = [vec![1.0; 4], vec![1.0, 2.0, 3.0, 4.0]];
        let (coefficients, square) = solve(&columns, &[3.0, 5.0, 7.0, 9.0], &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!(
            (coefficients[0] - 1.0).abs() < 1e-12 && (coefficients[1] - 2.0).abs() < 1e-12 && square < 1e-24
        );
        let twice = [columns[0].clone(), columns[0].clone()];
        assert_eq!(solve(&twice, &[1.0; 4], &[1.0; 4]), None);
        assert_eq!(solve(&columns, &[f64::NAN; 4], &[1.0; 4]), None);
    }
}
