//! Roots of real quartics whose magnitudes may differ by twenty orders.

use core::f64::consts::TAU;

use nalgebra::Complex;

use oedometer_soil::elementary;
use oedometer_soil::elementary::modulus;

/// Aberth's iteration converges cubically; tens of steps are a generous bound.
const MOST_STEPS: usize = 200;

/// `a_0 + a_1 s + … + a_4 s⁴` and its derivative at `s`.
pub fn evaluate(coefficients: &[f64; 5], s: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    let mut value = Complex::new(coefficients[4], 0.0);
    let mut slope = Complex::new(0.0, 0.0);
    for &coefficient in coefficients[..4].iter().rev() {
        slope = slope * s + value;
        value = value * s + coefficient;
    }
    (value, slope)
}

/// Starting points on circles whose radii the Newton polygon of `ln |a_i|` gives (Bini 1996).
fn starts(coefficients: &[f64; 5]) -> [Complex<f64>; 4] {
    let height = coefficients.map(|a| elementary::ln(a.abs()));
    let mut points = [Complex::new(0.0, 0.0); 4];
    let mut from = 0;
    while from < 4 {
        let slope = |to: usize| (height[to] - height[from]) / (to - from) as f64;
        let to = (from + 1..=4).fold(from + 1, |best, to| if slope(to) >= slope(best) { to } else { best });
        let radius = elementary::exp(-slope(to));
        for k in from..to {
            // Off the axes, or conjugate roots would be approached from a line of symmetry.
            let angle = TAU * (k - from) as f64 / (to - from) as f64 + 0.7 + 0.3 * from as f64;
            points[k] = elementary::polar(radius, angle);
        }
        from = to;
    }
    points
}

/// The four roots of a quartic with non-zero coefficients, by Aberth's simultaneous iteration.
///
/// Well separated roots have nearly all of `f64`'s digits *relative to their own size*, whatever
/// the others' are; a double root has half of them, as it must.
pub fn roots(coefficients: &[f64; 5]) -> [Complex<f64>; 4] {
    let mut roots = starts(coefficients);
    for _ in 0..MOST_STEPS {
        let mut settled = true;
        for k in 0..4 {
            let (value, slope) = evaluate(coefficients, roots[k]);
            if value.norm_sqr() == 0.0 {
                continue;
            }
            let repulsion: Complex<f64> = (0..4)
                .filter(|&other| other != k && roots[other] != roots[k])
                .map(|other| (roots[k] - roots[other]).inv())
                .sum();
            let step = (slope / value - repulsion).inv();
            if !step.is_finite() {
                continue;
            }
            roots[k] -= step;
            settled &= modulus(step) <= 4.0 * f64::EPSILON * modulus(roots[k]);
        }
        if settled {
            break;
        }
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn product(pairs: [[f64; 2]; 2]) -> [f64; 5] {
        let [[b, a], [d, c]] = pairs;
        [b * d, a * d + b * c, b + d + a * c, a + c, 1.0]
    }

    #[test]
    fn roots_of_many_magnitudes_keep_their_digits() {
        // (s + 1e-8)(s + 1e9) and a lightly damped wave of 1e3 rad/s.
        let coefficients = product([[10.0, 1e9 + 1e-8], [1e6, 20.0]]);
        let mut computed = roots(&coefficients);
        computed.sort_by(|a, b| modulus(*a).total_cmp(&modulus(*b)));
        assert!((computed[0].re / -1e-8 - 1.0).abs() < 1e-14);
        assert!((computed[3].re / -1e9 - 1.0).abs() < 1e-14);
        assert!((computed[1].re / -10.0 - 1.0).abs() < 1e-12);
        assert!((modulus(computed[1]) / 1e3 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn double_roots_have_half_the_digits() {
        let computed = roots(&product([[1.0, 2.0], [100.0, 1.0]]));
        let near = computed.iter().filter(|s| modulus(*s + 1.0) < 1e-7).count();
        assert_eq!(near, 2);
    }

    proptest! {
        #[test]
        fn polynomial_vanishes_at_its_roots(
            a in -6.0..6.0_f64, b in -6.0..6.0_f64, c in -6.0..6.0_f64, d in -6.0..6.0_f64,
        ) {
            let coefficients =
                product([[10.0_f64.powf(a), 10.0_f64.powf(b)], [10.0_f64.powf(c), 10.0_f64.powf(d)]]);
            for root in roots(&coefficients) {
                let magnitude: f64 = (0..5_i32)
                    .map(|i| coefficients[i.unsigned_abs() as usize] * modulus(root).powi(i))
                    .sum();
                let value = modulus(evaluate(&coefficients, root).0);
                prop_assert!(value <= 1e-14 * magnitude, "{value:e} of {magnitude:e}");
            }
        }
    }
}
