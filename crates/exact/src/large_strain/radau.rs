//! The implicit Runge–Kutta method of Radau IIA with five stages: order nine, stiffly accurate (Hairer & Wanner 1996,
//! section IV.5).
//!
//! A simplified Newton iteration on all stages solves `(1 − Δt A ⊗ J) x = b` with the weights `A` of the method. Along
//! the eigenvectors of `A` the stages part: one system of the size of `J` for each eigenvalue `μ`, `1 − Δt μ J`
//! (Butcher 1976; Hairer & Wanner 1996, section IV.8). Of a pair of conjugate ones the second adds the conjugate of
//! the first. With five stages that is a tenth of the work; what round-off leaves of a correction the next one takes.

use crate::numerics::integrate;
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU, SMatrix, SVector};

/// Number of stages.
pub const STAGES: usize = 5;

/// Right Radau points on [0, 1]: zeros of `P_5 − P_4` (Hairer & Wanner 1996, section IV.5).
pub const POINTS: [f64; STAGES] = [
    0.057_104_196_114_517_68,
    0.276_843_013_638_123_8,
    0.583_590_432_368_916_8,
    0.860_240_135_656_219_4,
    1.0,
];

/// Weights `a_ij = ∫_0^{c_i} ℓ_j`, row by row.
pub fn weights() -> [[f64; STAGES]; STAGES] {
    let lagrange = |j: usize, x: f64| -> f64 {
        (0..STAGES).filter(|&k| k != j).map(|k| (x - POINTS[k]) / (POINTS[j] - POINTS[k])).product()
    };
    POINTS.map(|to| core::array::from_fn(|j| integrate(|x| lagrange(j, x), 0.0, to, 1)))
}

/// Eigenvalues of the weights, of each pair the upper one: inverse roots of the denominator of the Padé approximation
/// (4, 5) of the exponential.
const EIGENVALUES: [(f64, f64); 3] = [
    (0.159_065_844_427_468_9, 0.0),
    (0.133_179_077_018_299_7, 0.074_994_511_835_818_65),
    (0.065_065_778_545_743_6, 0.116_468_527_740_317_03),
];
/// Relative shift from the eigenvalue in the inverse iteration, which keeps the system regular.
const MISSED: f64 = 1e-8;
/// Inverse iterations to a vector.
const ITERATIONS: usize = 3;

/// A vector over the stages.
type StageVector = SVector<Complex<f64>, STAGES>;
/// A matrix over the stages.
type StageMatrix = SMatrix<Complex<f64>, STAGES, STAGES>;

/// An eigenvalue with its vectors.
#[derive(Clone, Copy, Debug)]
struct Mode {
    value: Complex<f64>,
    right: StageVector,
    /// Left eigenvector, scaled so that its product with the right one is 1, or 2 for a conjugate pair.
    left: StageVector,
}

/// The modes of the weights of a method.
#[derive(Clone, Debug)]
pub struct StageModes([Mode; EIGENVALUES.len()]);

impl StageModes {
    /// The modes of the weights of a method, row by row.
    ///
    /// # Panics
    /// Never for the weights of Radau IIA with five stages.
    pub fn new(weights: &[[f64; STAGES]; STAGES]) -> Self {
        let matrix = StageMatrix::from_fn(|i, j| Complex::from(weights[i][j]));
        Self(EIGENVALUES.map(|(real, imaginary)| {
            let value = Complex::new(real, imaginary);
            let right = eigenvector(&matrix, value);
            let left = eigenvector(&matrix.transpose(), value);
            let count = if imaginary == 0.0 { 1.0 } else { 2.0 };
            Mode { value, right, left: left * (Complex::from(count) / left.dot(&right)) }
        }))
    }
}

/// The right eigenvector of a matrix by inverse iteration.
fn eigenvector(matrix: &StageMatrix, value: Complex<f64>) -> StageVector {
    let factors = (matrix - StageMatrix::identity() * (value * (1.0 + MISSED))).lu();
    let mut vector = StageVector::from_element(Complex::from(1.0));
    for _ in 0..ITERATIONS {
        if factors.solve_mut(&mut vector) {
            let largest = vector.iter().map(|entry| entry.re.abs() + entry.im.abs()).fold(0.0, f64::max);
            vector /= Complex::from(largest);
        }
    }
    vector
}

/// The factors of the systems of a step.
#[derive(Clone, Debug)]
pub struct StageFactors<'a> {
    modes: &'a StageModes,
    factors: [LU<Complex<f64>, Dyn, Dyn>; EIGENVALUES.len()],
}

impl<'a> StageFactors<'a> {
    /// The factors for a Jacobian and a step.
    pub fn new(modes: &'a StageModes, jacobian: &DMatrix<f64>, step: f64) -> Self {
        let factors = modes.0.each_ref().map(|mode| {
            let mut system = jacobian.map(|entry| -(mode.value * (step * entry)));
            for i in 0..system.nrows() {
                system[(i, i)] += 1.0;
            }
            system.lu()
        });
        Self { modes, factors }
    }

    /// Solution for a right-hand side, stage after stage; `None` where a system is singular.
    pub fn solve(&self, right_side: &DVector<f64>) -> Option<DVector<f64>> {
        let order = right_side.len() / STAGES;
        let mut solution = DVector::zeros(right_side.len());
        for (mode, factors) in self.modes.0.iter().zip(&self.factors) {
            let mut part = DVector::from_fn(order, |i, _| {
                (0..STAGES)
                    .map(|stage| mode.left[stage] * right_side[stage * order + i])
                    .sum::<Complex<f64>>()
            });
            if !factors.solve_mut(&mut part) {
                return None;
            }
            for stage in 0..STAGES {
                for (value, part) in solution.rows_mut(stage * order, order).iter_mut().zip(part.iter()) {
                    *value += (mode.right[stage] * part).re;
                }
            }
        }
        Some(solution)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoupled_stages_give_the_coupled_solution() {
        let (weights, order, step) = (weights(), 7, 0.3);
        let jacobian = DMatrix::from_fn(order, order, |i, j| {
            let wave = ((3 * i + 5 * j) as f64).sin();
            if i == j { -20.0 * (1.0 + i as f64) } else { 3.0 * wave }
        });
        let mut coupled = DMatrix::identity(STAGES * order, STAGES * order);
        for (i, row) in weights.iter().enumerate() {
            for (j, weight) in row.iter().enumerate() {
                let mut block = coupled.view_mut((i * order, j * order), (order, order));
                block -= &jacobian * (step * weight);
            }
        }
        let right_side = DVector::from_fn(STAGES * order, |i, _| (1.7 * i as f64).cos());
        let together = coupled.lu().solve(&right_side).expect("a solution");
        let modes = StageModes::new(&weights);
        let apart = StageFactors::new(&modes, &jacobian, step).solve(&right_side).expect("a solution");
        assert!((&apart - &together).amax() < 1e-13 * together.amax(), "{}", (&apart - &together).amax());
    }

    #[test]
    fn stages_and_step_have_their_orders() {
        let weights = weights();
        for power in 1..=5 {
            for (row, point) in weights.iter().zip(POINTS) {
                let sum: f64 = (0..STAGES).map(|j| row[j] * POINTS[j].powi(power - 1)).sum();
                assert!((sum - point.powi(power) / f64::from(power)).abs() < 1e-15);
            }
        }
        // The last row integrates polynomials of degree 8: order 9.
        for power in 1..=9 {
            let sum: f64 = (0..STAGES).map(|j| weights[STAGES - 1][j] * POINTS[j].powi(power - 1)).sum();
            assert!((sum - 1.0 / f64::from(power)).abs() < 1e-15);
        }
    }
}
