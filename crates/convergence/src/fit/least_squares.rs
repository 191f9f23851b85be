//! Linear least squares with a few columns, for the fits that need more than two.

use nalgebra::{DMatrix, DVector};

/// Solves `min Σ w_i (Σ_j c_j a_ij − y_i)²`; returns the coefficients and the weighted sum of
/// squares, or nothing where the columns do not determine them.
pub fn solve(columns: &[Vec<f64>], target: &[f64], weights: &[f64]) -> Option<(Vec<f64>, f64)> {
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
}
