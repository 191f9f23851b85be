//! Legendre polynomials on [−1, 1]: Lobatto's points with their weights and derivatives, series and their integrals.

use nalgebra::DMatrix;

use oedometer_soil::elementary;
use std::f64::consts::PI;

/// Lobatto's points: their quadrature is exact up to the degree `2N − 1`, which makes a weak form at them equal to the
/// strong one inside.
#[derive(Clone, Debug)]
pub struct Element {
    /// Points from 1 down to −1.
    pub points: Vec<f64>,
    /// Their weights in an integral over [−1, 1].
    pub weights: Vec<f64>,
}

/// `P_0` to `P_order` at a place.
fn polynomials(order: usize, x: f64) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for n in 1..order {
        let degree = n as f64;
        values.push(((2.0 * degree + 1.0) * x * values[n] - degree * values[n - 1]) / (degree + 1.0));
    }
    values.truncate(order + 1);
    values
}

impl Element {
    /// `order + 1` points: the ends and the zeros of `P'_order`, by Newton's iteration from Chebyshev's.
    pub fn new(order: usize) -> Self {
        let degree = order as f64;
        let point = |j: usize| {
            let mut x = elementary::cos(PI * j as f64 / degree);
            for _ in 0..50 {
                let values = polynomials(order, x);
                let change = (x * values[order] - values[order - 1]) / ((degree + 1.0) * values[order]);
                x -= change;
                if change.abs() < f64::EPSILON {
                    break;
                }
            }
            x
        };
        let points: Vec<f64> = (0..=order)
            .map(|j| {
                if j == 0 {
                    1.0
                } else if j == order {
                    -1.0
                } else {
                    point(j)
                }
            })
            .collect();
        let weight =
            |x: &f64| 2.0 / (degree * (degree + 1.0) * elementary::powi(polynomials(order, *x)[order], 2));
        Self { weights: points.iter().map(weight).collect(), points }
    }

    /// Matrix of the first derivative at the points.
    pub fn derivative(&self) -> DMatrix<f64> {
        let (x, order) = (&self.points, self.points.len() - 1);
        let last: Vec<f64> = x.iter().map(|x| polynomials(order, *x)[order]).collect();
        let mut matrix = DMatrix::from_fn(order + 1, order + 1, |i, j| {
            if i == j { 0.0 } else { last[i] / last[j] / (x[i] - x[j]) }
        });
        // The derivative of a constant vanishes to round-off only with this diagonal.
        for i in 0..=order {
            matrix[(i, i)] = -matrix.row(i).sum();
        }
        matrix
    }

    /// Weights and derivatives of functions that are even, at the points from 1 down to 0; of an even order.
    pub fn upper_half(&self) -> (Vec<f64>, DMatrix<f64>) {
        let (middle, last) = (self.points.len() / 2, self.points.len() - 1);
        let mut weights = self.weights[..=middle].to_vec();
        weights[middle] *= 0.5;
        let full = self.derivative();
        let mut half = full.view((0, 0), (middle + 1, middle + 1)).into_owned();
        for j in 0..middle {
            let image = full.view((0, last - j), (middle + 1, 1));
            half.column_mut(j).zip_apply(&image, |entry, image| *entry += image);
        }
        (weights, half)
    }

    /// Coefficients of the polynomial through values at the points.
    pub fn coefficients(&self, values: &[f64]) -> Vec<f64> {
        let order = self.points.len() - 1;
        let mut coefficients = vec![0.0; order + 1];
        for ((x, weight), value) in self.points.iter().zip(&self.weights).zip(values) {
            for (k, polynomial) in polynomials(order, *x).iter().enumerate() {
                // The last one's square is not integrated exactly.
                let norm = if k == order { order as f64 } else { 2.0 * k as f64 + 1.0 };
                coefficients[k] += 0.5 * norm * weight * polynomial * value;
            }
        }
        coefficients
    }
}

/// Value at `x` of a series.
pub fn evaluate(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().zip(polynomials(coefficients.len() - 1, x)).map(|(a, b)| a * b).sum()
}

/// Integral of a series from `x` to 1: `∫ P_k = (P_{k−1} − P_{k+1})/(2k + 1)`.
pub fn integral_to_one(coefficients: &[f64], x: f64) -> f64 {
    let values = polynomials(coefficients.len(), x);
    let term = |(k, coefficient): (usize, &f64)| {
        let below = if k == 0 { 1.0 } else { values[k - 1] };
        coefficient * (below - values[k + 1]) / (2.0 * k as f64 + 1.0)
    };
    coefficients.iter().enumerate().map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn weights_derivative_and_series_agree_on_an_exponential() {
        let element = Element::new(20);
        let values: Vec<f64> = element.points.iter().map(|x| x.exp()).collect();
        let slopes = element.derivative() * DVector::from_vec(values.clone());
        let series = element.coefficients(&values);
        for (value, slope) in values.iter().zip(&slopes) {
            assert!((value - slope).abs() < 1e-11);
        }
        let sum: f64 = values.iter().zip(&element.weights).map(|(value, weight)| value * weight).sum();
        assert!((sum - 2.0 * 1.0_f64.sinh()).abs() < 1e-13);
        for x in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            assert!((evaluate(&series, x) - x.exp()).abs() < 1e-13);
            assert!((integral_to_one(&series, x) - (core::f64::consts::E - x.exp())).abs() < 1e-13);
        }
    }
}
