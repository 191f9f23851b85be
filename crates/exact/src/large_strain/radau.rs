//! The implicit Runge–Kutta method of Radau IIA with five stages: order nine, stiffly accurate.

use crate::quadrature::integrate;

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

#[cfg(test)]
mod tests {
    use super::*;

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
