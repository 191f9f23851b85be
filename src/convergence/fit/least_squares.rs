//! Linear least squares with a few columns, for the fits that need more than two.

use nalgebra::{DMatrix, DVector};

/// Solves `min Σ w_i (Σ_j c_j a_ij − y_i)²`; returns the coefficients and the weighted sum of
/// squares, or nothing where the columns do not determine them.
pub(crate) fn solve(columns: &[Vec<f64>], target: &[f64], weights: &[f64]) -> Option<(Vec<f64>, f64)> {
    let root = |row: usize| weights[row].sqrt();
    let matrix =
        DMatrix::from_fn(target.len(), columns.len(), |row, column| root(row) * columns[column][row]);
    let wanted = DVector::from_fn(target.len(), |row, _| root(row) * target[row]);
    if matrix.iter().chain(wanted.iter()).any(|value| !value.is_finite()) {
        return None;
    }
    let svd = matrix.clone().svd(true, true);
    let largest = svd.singular_values.max();
    if svd.singular_values.min() <= 1e-12 * largest {
        return None;
    }
    let coefficients = svd.solve(&wanted, 0.0).ok()?;
    let square = (&matrix * &coefficients - &wanted).norm_squared();
    Some((coefficients.iter().copied().collect(), square))
}

/// As [`solve`], with no coefficient negative: the best of all subsets of the columns, which for
/// the four columns there are at most is exact and cheap.
pub(crate) fn solve_nonnegative(
    columns: &[Vec<f64>],
    target: &[f64],
    weights: &[f64],
) -> Option<(Vec<f64>, f64)> {
    // Mostly none wants to be negative, and then the whole set is the best.
    let mut best = solve(columns, target, weights)
        .filter(|(found, _)| found.iter().all(|coefficient| *coefficient >= 0.0));
    if best.is_some() {
        return best;
    }
    for subset in 1..1_u32 << columns.len() {
        let members: Vec<_> = (0..columns.len()).filter(|j| subset >> j & 1 == 1).collect();
        let chosen: Vec<_> = members.iter().map(|j| columns[*j].clone()).collect();
        let Some((found, square)) = solve(&chosen, target, weights) else {
            continue;
        };
        let better = best.as_ref().is_none_or(|(_, least)| square < *least);
        if better && found.iter().all(|coefficient| *coefficient >= 0.0) {
            let mut coefficients = vec![0.0; columns.len()];
            for (j, coefficient) in members.into_iter().zip(found) {
                coefficients[j] = coefficient;
            }
            best = Some((coefficients, square));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_combination_is_found_and_a_singular_one_is_not() {
        let columns = [vec![1.0; 4], vec![1.0, 2.0, 3.0, 4.0]];
        let (found, square) = solve(&columns, &[3.0, 5.0, 7.0, 9.0], &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12 && square < 1e-24);
        let twice = [columns[0].clone(), columns[0].clone()];
        assert_eq!(solve(&twice, &[1.0; 4], &[1.0; 4]), None);
        assert_eq!(solve(&columns, &[f64::NAN; 4], &[1.0; 4]), None);
    }

    #[test]
    fn a_negative_coefficient_gives_way() {
        let columns = [vec![1.0; 3], vec![1.0, 2.0, 3.0]];
        let (found, _) = solve_nonnegative(&columns, &[3.0, 2.0, 1.0], &[1.0; 3]).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-12 && found[1] == 0.0);
        assert_eq!(solve_nonnegative(&columns, &[-1.0; 3], &[1.0; 3]), None);
    }
}
