//! Integrals of the isochrones over the time that has gone by: what a growing load leaves behind.
//!
//! ```text
//! ∫_0^T W dT = T − 4T Σ (−1)^m [i²erfc((2m+ζ)/2√T) + i²erfc((2m+2−ζ)/2√T)]
//!            = ζ(2−ζ)/2 − Σ (2/M_j³) sin(M_j ζ) exp(−M_j² T)
//! ```
//!
//! and the same once more integrated from the depth to the base. No sum cancels: early values are as
//! accurate relative to `T` as `f64` allows.

use core::f64::consts::FRAC_2_SQRT_PI;

use oedometer_soil::elementary;

use crate::consolidation::SWITCH;
use crate::consolidation::sine_series::eigenvalue;

/// Exponents of `exp` beyond which nothing is left of 1.
const NOTHING_LEFT: f64 = 42.0;

/// `∫_0^T W(ζ, T) dT`.
pub fn isochrone(zeta: f64, time_factor: f64) -> f64 {
    if time_factor < SWITCH {
        let width = 2.0 * time_factor.sqrt();
        let images = sum_images(width, |m| {
            repeated_integrals((2.0 * m + zeta) / width)[0]
                + repeated_integrals((2.0 * m + 2.0 - zeta) / width)[0]
        });
        time_factor * (1.0 - 4.0 * images)
    } else {
        let modes = sum_modes(time_factor, |_, m| 2.0 / (m * m * m) * elementary::sin(m * zeta));
        0.5 * zeta * (2.0 - zeta) - modes
    }
}

/// `∫_0^T I(ζ, T) dT` with `I = ∫_ζ^1 W dζ`.
pub fn isochrone_integral(zeta: f64, time_factor: f64) -> f64 {
    let height = 1.0 - zeta;
    if time_factor < SWITCH {
        let width = 2.0 * time_factor.sqrt();
        let images = sum_images(width, |m| {
            repeated_integrals((2.0 * m + zeta) / width)[1]
                - repeated_integrals((2.0 * m + 2.0 - zeta) / width)[1]
        });
        time_factor * (height - 4.0 * width * images)
    } else {
        let modes =
            sum_modes(time_factor, |sign, m| 2.0 / (m * m * m * m) * sign * elementary::sin(m * height));
        height * (0.5 - height * height / 6.0) - modes
    }
}

/// `i²erfc` and `i³erfc`, with absolute accuracy (Abramowitz & Stegun 7.2.5).
fn repeated_integrals(x: f64) -> [f64; 2] {
    if x * x > NOTHING_LEFT {
        return [0.0; 2];
    }
    let zeroth = elementary::erfc(x);
    let first = 0.5 * FRAC_2_SQRT_PI * elementary::exp(-x * x) - x * zeroth;
    let second = 0.25 * (zeroth - 2.0 * x * first);
    [second, (first - 2.0 * x * second) / 6.0]
}

/// `Σ (−1)^m term(m)` over the images that are within reach.
fn sum_images(width: f64, term: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    let mut m = 0.0;
    while m == 0.0 || 2.0 * m < NOTHING_LEFT.sqrt() * width {
        sum = term(m) - sum;
        m += 1.0;
    }
    // Signs were turned with every term: the last one counts as positive.
    if m % 2.0 == 0.0 { -sum } else { sum }
}

/// `Σ term(±1, M_j) exp(−M_j² T)` over the modes that are left.
fn sum_modes(time_factor: f64, term: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    let mut sign = 1.0;
    for mode in 0.. {
        let m = eigenvalue(mode);
        let exponent = m * m * time_factor;
        if exponent > NOTHING_LEFT {
            break;
        }
        sum += term(sign, m) * elementary::exp(-exponent);
        sign = -sign;
    }
    sum
}
