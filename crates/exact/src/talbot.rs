//! Talbot's contour, on which Laplace transforms are inverted.

use core::f64::consts::PI;

use nalgebra::Complex;
use oedometer_soil::elementary;

/// Nodes of Talbot's contour at which truncation, `exp(−1.36 N)`, has fallen below round-off.
pub(crate) const NODES: usize = 26;

/// Upper half of Talbot's contour: `f(t) ≈ Re Σ w F(z/t)/t`.
///
/// The midpoint rule on the optimal cotangent contour of Weideman (2006) and Trefethen, Weideman
/// & Schmelzer (2006, Eq. 4.1). The weights hold `exp(z)` and leave out the factor `1/t`.
pub(crate) fn talbot_contour(nodes: usize) -> impl Iterator<Item = (Complex<f64>, Complex<f64>)> {
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
