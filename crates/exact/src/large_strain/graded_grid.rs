//! Collocation in depth.

use nalgebra::DMatrix;

use crate::large_strain::chebyshev;

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
        let points = chebyshev::points(order);
        let derivative = chebyshev::derivative(order);
        let twice = &derivative * &derivative;
        let metric: Vec<f64> = points[1..].iter().map(|s| 8.0 * (1.0 + s)).collect();
        let first = derivative.view((1, 1), (order, order)).into_owned();
        let second =
            DMatrix::from_fn(order, order, |i, j| metric[i] * twice[(i + 1, j + 1)] + 4.0 * first[(i, j)]);
        let heights = points.iter().map(|s| (0.5 * (1.0 + s)).max(0.0).sqrt()).collect();
        Self { metric, first, second, heights }
    }
}
