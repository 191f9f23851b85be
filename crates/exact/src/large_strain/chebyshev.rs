//! Chebyshev polynomials on [−1, 1]: collocation, coefficients, integrals.

use core::f64::consts::PI;

use nalgebra::DMatrix;

use oedometer_soil::elementary;

/// Lobatto points `cos(jπ/N)`, from 1 down to −1.
pub fn points(order: usize) -> Vec<f64> {
    // As sines, which are exactly odd about the middle.
    (0..=order)
        .map(|j| elementary::sin(PI * (order as f64 - 2.0 * j as f64) / (2.0 * order as f64)))
        .collect()
}

/// Matrix of the first derivative at the Lobatto points (Trefethen 2000, program `cheb`).
pub fn derivative(order: usize) -> DMatrix<f64> {
    let x = points(order);
    let weight = |j: usize| {
        let end = if j == 0 || j == order { 2.0 } else { 1.0 };
        if j.is_multiple_of(2) { end } else { -end }
    };
    let mut matrix = DMatrix::from_fn(order + 1, order + 1, |i, j| {
        if i == j { 0.0 } else { weight(i) / weight(j) / (x[i] - x[j]) }
    });
    // The derivative of a constant vanishes to round-off only with this diagonal.
    for i in 0..=order {
        matrix[(i, i)] = -matrix.row(i).sum();
    }
    matrix
}

/// Coefficients of the polynomial through values at the Lobatto points.
pub fn coefficients(values: &[f64]) -> Vec<f64> {
    let order = values.len() - 1;
    let halved = |j: usize| if j == 0 || j == order { 0.5 } else { 1.0 };
    let cosines: Vec<f64> = (0..2 * order).map(|m| elementary::cos(PI * m as f64 / order as f64)).collect();
    (0..=order)
        .map(|k| {
            let term = |(j, value): (usize, &f64)| halved(j) * value * cosines[(k * j) % (2 * order)];
            let sum: f64 = values.iter().enumerate().map(term).sum();
            2.0 / order as f64 * halved(k) * sum
        })
        .collect()
}

/// Value at `x` of a series (Clenshaw 1955).
pub fn evaluate(coefficients: &[f64], x: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for &coefficient in coefficients.iter().skip(1).rev() {
        (one, two) = (coefficient + 2.0 * x * one - two, one);
    }
    coefficients.first().copied().unwrap_or(0.0) + x * one - two
}

/// Integral of a series from `x` to 1.
pub fn integral_to_one(coefficients: &[f64], x: f64) -> f64 {
    let angle = elementary::acos(x.clamp(-1.0, 1.0));
    // ∫ T_n = T_{n+1}/(2(n+1)) − T_{n−1}/(2(n−1)), written as the departure from its value at 1.
    let fall = |n: f64| {
        if n == 0.0 { 0.0 } else { (1.0 - elementary::cos(n * angle)) / (2.0 * n) }
    };
    coefficients
        .iter()
        .enumerate()
        .rev()
        .map(|(n, coefficient)| {
            let n = n as f64;
            coefficient
                * match n {
                    0.0 => 1.0 - x,
                    1.0 => fall(2.0),
                    _ => fall(n + 1.0) - fall(n - 1.0),
                }
        })
        .sum()
}

/// Integral from 0 to `x` of `Σ a_k T_k(2x² − 1) = Σ a_k T_{2k}(x)`, an even function of `x`.
pub fn even_integral_from_zero(coefficients: &[f64], x: f64) -> f64 {
    // T_n(x) = ± sin(n asin x) for odd n, exact at 0.
    let angle = elementary::asin(x.clamp(-1.0, 1.0));
    let size = |k: usize| elementary::sin((2.0 * k as f64 + 1.0) * angle) / (2.0 * k as f64 + 1.0);
    // T_{2k+1}/(2k+1), from the last down: what stands above a coefficient stood below the one before.
    let mut above = size(coefficients.len().saturating_sub(1));
    coefficients
        .iter()
        .enumerate()
        .rev()
        .map(|(k, coefficient)| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            if k == 0 {
                return coefficient * x;
            }
            let below = size(k - 1);
            let integral = 0.5 * (sign * above - -sign * below);
            above = below;
            coefficient * integral
        })
        .sum()
}

/// Matrices of the derivatives in depth of functions that are even about the base.
///
/// With `x = 1 − ζ` and `s = 2x² − 1`, `∂²/∂ζ² = 8(1+s) ∂²/∂s² + 4 ∂/∂s` and
/// `(∂/∂ζ)² = 8(1+s) (∂/∂s)²`: the base needs no condition.
#[derive(Clone, Debug)]
pub struct EvenGrid {
    /// `8(1 + s)` at the points below the surface.
    pub metric: Vec<f64>,
    /// `∂/∂s` there.
    pub first: DMatrix<f64>,
    /// `∂²/∂ζ²` there.
    pub second: DMatrix<f64>,
    /// `x = 1 − ζ` at all points.
    pub heights: Vec<f64>,
}

impl EvenGrid {
    /// The grid of `order` points below the surface, at which the pressure is zero.
    pub fn new(order: usize) -> Self {
        let points = points(order);
        let derivative = derivative(order);
        let twice = &derivative * &derivative;
        let metric: Vec<f64> = points[1..].iter().map(|s| 8.0 * (1.0 + s)).collect();
        let first = derivative.view((1, 1), (order, order)).into_owned();
        let second =
            DMatrix::from_fn(order, order, |i, j| metric[i] * twice[(i + 1, j + 1)] + 4.0 * first[(i, j)]);
        let heights = points.iter().map(|s| (0.5 * (1.0 + s)).max(0.0).sqrt()).collect();
        Self { metric, first, second, heights }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn derivative_coefficients_and_integrals_agree_on_an_exponential() {
        let order = 20;
        let x = points(order);
        let values: Vec<f64> = x.iter().map(|x| x.exp()).collect();
        let slopes = derivative(order) * DVector::from_vec(values.clone());
        let series = coefficients(&values);
        for (j, &x) in x.iter().enumerate() {
            assert!((slopes[j] - x.exp()).abs() < 1e-12);
        }
        for x in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            assert!((evaluate(&series, x) - x.exp()).abs() < 1e-14);
            let integral = core::f64::consts::E - x.exp();
            assert!((integral_to_one(&series, x) - integral).abs() < 1e-14);
        }
    }

    #[test]
    fn even_integral_of_a_cosine() {
        let values: Vec<f64> = points(16).iter().map(|s| ((1.0 + s) / 2.0).sqrt().cos()).collect();
        let series = coefficients(&values);
        for x in [0.0_f64, 0.1, 0.6, 1.0] {
            assert!((even_integral_from_zero(&series, x) - x.sin()).abs() < 1e-15);
        }
    }
}
