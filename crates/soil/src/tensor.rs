//! Vectors and tensors in `D` dimensions and their algebra; the last component is the vertical one.

/// A vector, `[component]`.
pub type Vector<const D: usize> = [f64; D];

/// A tensor of second order, `[row][column]`.
pub type Tensor<const D: usize> = [[f64; D]; D];

/// The unit tensor.
#[inline]
pub fn identity<const D: usize>() -> Tensor<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }))
}

/// `a b`.
#[inline]
pub fn product<const D: usize>(a: &Tensor<D>, b: &Tensor<D>) -> Tensor<D> {
    let mut product = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            for k in 0..D {
                product[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    product
}

/// `a bᵀ`.
#[inline]
pub fn product_with_transpose<const D: usize>(a: &Tensor<D>, b: &Tensor<D>) -> Tensor<D> {
    let mut product = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            for k in 0..D {
                product[i][j] += a[i][k] * b[j][k];
            }
        }
    }
    product
}

/// `a · b`.
#[inline]
pub fn dot<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    let mut sum = 0.0;
    for d in 0..D {
        sum += a[d] * b[d];
    }
    sum
}

/// Solution `x` of `A x = b` for a symmetric positive semi-definite matrix, by elimination without pivoting; a component
/// is zero if its pivot `is_left_out`.
#[inline]
pub fn solve_symmetric<const D: usize>(
    matrix: &Tensor<D>,
    right: &Vector<D>,
    mut is_left_out: impl FnMut(usize, f64) -> bool,
) -> Vector<D> {
    let (mut matrix, mut solution) = (*matrix, *right);
    for i in 0..D {
        if is_left_out(i, matrix[i][i]) {
            for row in &mut matrix {
                row[i] = 0.0;
            }
            matrix[i] = [0.0; D];
            matrix[i][i] = 1.0;
            solution[i] = 0.0;
        }
        for j in i + 1..D {
            let factor = matrix[j][i] / matrix[i][i];
            for k in i..D {
                matrix[j][k] -= factor * matrix[i][k];
            }
            solution[j] -= factor * solution[i];
        }
    }
    for i in (0..D).rev() {
        for j in i + 1..D {
            solution[i] -= matrix[i][j] * solution[j];
        }
        solution[i] /= matrix[i][i];
    }
    solution
}

/// Inverse and determinant of a deformation gradient: in the plane for any rotation, otherwise for gradients close
/// enough to the unit tensor to need no pivoting. Not finite if the gradient is singular.
#[inline]
pub fn inverse<const D: usize>(tensor: &Tensor<D>) -> (Tensor<D>, f64) {
    if D == 2 {
        let determinant = tensor[0][0] * tensor[1][1] - tensor[0][1] * tensor[1][0];
        let per_determinant = 1.0 / determinant;
        let adjugate = |i: usize, j: usize| if i == j { tensor[1 - i][1 - j] } else { -tensor[i][j] };
        let inverse = std::array::from_fn(|i| std::array::from_fn(|j| per_determinant * adjugate(i, j)));
        return (inverse, determinant);
    }
    let (mut rest, mut inverse, mut determinant) = (*tensor, identity::<D>(), 1.0);
    for pivot in 0..D {
        let per_pivot = 1.0 / rest[pivot][pivot];
        determinant *= rest[pivot][pivot];
        for j in 0..D {
            rest[pivot][j] *= per_pivot;
            inverse[pivot][j] *= per_pivot;
        }
        for i in (0..D).filter(|i| *i != pivot) {
            let factor = rest[i][pivot];
            for j in 0..D {
                rest[i][j] -= factor * rest[pivot][j];
                inverse[i][j] -= factor * inverse[pivot][j];
            }
        }
    }
    (inverse, determinant)
}

/// Logarithm of the deformation `F₁ F₀⁻¹` between two deformation gradients in one dimension or the plane, whose symmetric
/// part is the strain: exact if the stretch keeps its axes, so that a column has the same strain in both dimensions.
///
/// From the Cayley transform `X = (F₁ − F₀)(F₁ + F₀)⁻¹` of Hughes & Winget (1980), which is half the logarithm to third
/// order: `ln F₁ F₀⁻¹ = 2 artanh X`. The trace of it is the logarithm of the volume ratio; for the rest, `Y = X − tr(X)/2`,
/// `Y² = s²` (Cayley & Hamilton) leaves `Y artanh(z)/s` with `z = 2 s/(1 + s² − tr(X)²/4)`, a series in `z²`.
#[inline]
pub fn strain_between<const D: usize>(before: &Tensor<D>, after: &Tensor<D>, log_volume: f64) -> Tensor<D> {
    if D == 1 {
        return [[log_volume; D]; D];
    }
    let difference = std::array::from_fn(|i| std::array::from_fn(|j| after[i][j] - before[i][j]));
    let sum = std::array::from_fn(|i| std::array::from_fn(|j| after[i][j] + before[i][j]));
    let mut strain = product(&difference, &inverse(&sum).0);
    let mean = (0..D).map(|d| strain[d][d]).sum::<f64>() / D as f64;
    for d in 0..D {
        strain[d][d] -= mean;
    }
    let square = (0..D).map(|j| strain[0][j] * strain[j][0]).sum::<f64>();
    let per_half = 2.0 / (1.0 + square - mean * mean);
    let z_squared = square * per_half * per_half;
    let series = [1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];
    let factor = per_half * series.iter().fold(0.0, |sum, term| sum * z_squared + term);
    for i in 0..D {
        for j in 0..D {
            strain[i][j] *= factor;
        }
        strain[i][i] += log_volume / D as f64;
    }
    strain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_and_a_determinant_is_the_volume() {
        let tensor = [[0.9, 0.2], [-0.1, 0.8]];
        let (inverse, determinant) = inverse(&tensor);
        assert!((determinant - 0.74).abs() < 1e-15);
        let unit = product(&tensor, &inverse);
        for i in 0..2 {
            for j in 0..2 {
                assert!((unit[i][j] - if i == j { 1.0 } else { 0.0 }).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_right_angle_is_turned_back() {
        assert_eq!(inverse(&[[0.0, -1.0], [1.0, 0.0]]), ([[0.0, 1.0], [-1.0, 0.0]], 1.0));
    }

    #[test]
    fn a_component_left_out_is_zero_and_the_others_solve_what_is_left() {
        let (matrix, right) = ([[4.0, 1.0], [1.0, 3.0]], [1.0, 2.0]);
        let solved = solve_symmetric(&matrix, &right, |_, pivot| pivot <= 0.0);
        assert!((solved[0] - 1.0 / 11.0).abs() < 1e-15 && (solved[1] - 7.0 / 11.0).abs() < 1e-15);
        assert_eq!(solve_symmetric(&matrix, &right, |i, _| i == 1), [0.25, 0.0]);
    }

    #[test]
    fn the_strain_is_logarithmic() {
        let strain = strain_between(&[[0.9]], &[[0.8]], (0.8_f64 / 0.9).ln());
        assert!((strain[0][0] - (0.8_f64 / 0.9).ln()).abs() < 1e-15);
        // In the plane all of it is in the direction that strains, and shears beside it are those of the matrix logarithm.
        for step in [0.5_f64, 0.9, 0.99] {
            let log = step.ln();
            let strain = strain_between(&[[1.0, 0.0], [0.0, 0.8]], &[[1.0, 0.0], [0.0, 0.8 * step]], log);
            let off = (strain[0][0].abs() + (strain[1][1] - log).abs()) / log.abs();
            assert!(off < (0.55 * log.abs()).powi(10) + 1e-13, "{step}: {strain:?}");
            let sheared = strain_between(&identity(), &[[1.0, 0.1 * (step - 1.0)], [0.0, step]], log);
            assert!((sheared[0][1] - 0.1 * log).abs() < 1e-4 * log.abs().powi(8), "{step}: {sheared:?}");
        }
        // A rotation strains nothing.
        let (sine, cosine) = 0.01_f64.sin_cos();
        let turned = strain_between(&identity(), &[[cosine, -sine], [sine, cosine]], 0.0);
        assert!(turned[0][0].abs() < 1e-15 && (turned[0][1] + turned[1][0]).abs() < 1e-15);
    }
}
