//! Inversion of Laplace transforms whose singularities lie on the negative real axis.

use core::f64::consts::PI;

use nalgebra::Complex;

use oedometer_soil::elementary;

/// Nodes at which truncation, `exp(−1.36 N)`, has fallen below round-off.
pub const NODES: usize = 26;

/// Upper half of Talbot's contour: `f(t) ≈ Re Σ w F(z/t)/t`.
///
/// The midpoint rule on the optimal cotangent contour of Weideman (2006) and Trefethen, Weideman
/// & Schmelzer (2006, Eq. 4.1). The weights hold `exp(z)` and leave out the factor `1/t`.
pub fn contour(nodes: usize) -> impl Iterator<Item = (Complex<f64>, Complex<f64>)> {
    let count = nodes as f64;
    (0..nodes / 2).map(move |k| {
        let angle = (2.0 * k as f64 + 1.0) * PI / count;
        let scaled = 0.6407 * angle;
        let cotangent = 1.0 / elementary::tan(scaled);
        let z = count * Complex::new(0.5017 * angle * cotangent - 0.6122, 0.2645 * angle);
        let slope =
            count * Complex::new(0.5017 * (cotangent - scaled * (1.0 + cotangent * cotangent)), 0.2645);
        (z, elementary::exp_complex(z) * slope * Complex::new(0.0, -2.0 / count))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn invert(f: impl Fn(Complex<f64>) -> Complex<f64>, time: f64) -> f64 {
        contour(NODES).map(|(z, weight)| (weight * f(z / time)).re / time).sum()
    }

    #[test]
    fn known_transforms_are_inverted() {
        for time in [1e-3, 0.7, 40.0] {
            assert!((invert(|s| s.inv(), time) - 1.0).abs() < 2e-14);
            let decay = invert(|s| (s + 3.0).inv(), time);
            assert!((decay - (-3.0 * time).exp()).abs() < 2e-14);
            let root = invert(|s| elementary::exp_complex(-elementary::sqrt_complex(s)) / s, time);
            assert!((root - libm::erfc(0.5 / time.sqrt())).abs() < 2e-14);
        }
    }
}
