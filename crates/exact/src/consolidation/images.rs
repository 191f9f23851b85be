//! The sums over mirror images of the drained surface, for small time factors.
//!
//! Heat kernel with an absorbing end at `ζ = 0` and a reflecting end at `ζ = 1`
//! (Carslaw & Jaeger 1959, section 12.5). All sums alternate in sign with falling terms, so the
//! first omitted term bounds the tail.

use core::f64::consts::FRAC_2_SQRT_PI;

use crate::consolidation::series_value::SeriesValue;
use oedometer_soil::elementary;

/// Terms below this are left out: a tenth of the round-off of 1.
const ABSOLUTE_TAIL: f64 = 2.2e-17;

/// `ierfc(x) = ∫_x^∞ erfc = exp(−x²)/√π − x erfc(x)`, absolute accuracy.
fn integral_of_erfc(x: f64) -> f64 {
    if x > 30.0 {
        // Below 1e-390; keeps infinite arguments from giving NaN.
        return 0.0;
    }
    0.5 * FRAC_2_SQRT_PI * elementary::exp(-x * x) - x * elementary::erfc(x)
}

/// Sum of `(−1)^m term(m)`, smallest first, where `bound(m) ≥ |term(m)|` bounds the tail from `m` on.
fn sum_images(term: impl Fn(f64) -> f64, bound: impl Fn(f64) -> f64) -> SeriesValue {
    let mut terms: usize = 0;
    while bound(terms as f64) > ABSOLUTE_TAIL {
        terms += 1;
    }
    let value = (0..terms).rev().map(|m| if m % 2 == 0 { term(m as f64) } else { -term(m as f64) }).sum();
    SeriesValue { value, terms, tail_bound: bound(terms as f64) }
}

/// `W(ζ, T)` for `T > 0`, as `erf(ζ/2√T)` less the images, so that it vanishes with `ζ` exactly:
///
/// ```text
/// W = erf(ζ/2√T) − Σ_{m≥0} (−1)^m [erfc((2m+2−ζ)/2√T) − erfc((2m+2+ζ)/2√T)]
/// ```
pub fn isochrone(zeta: f64, time_factor: f64) -> SeriesValue {
    let width = 2.0 * time_factor.sqrt();
    let images = sum_images(
        |m| {
            let place = 2.0 * m + 2.0;
            elementary::erfc((place - zeta) / width) - elementary::erfc((place + zeta) / width)
        },
        |m| elementary::erfc((2.0 * m + 2.0 - zeta) / width),
    );
    SeriesValue { value: elementary::erf(zeta / width) - images.value, terms: images.terms + 1, ..images }
}

/// `∫_ζ^1 (1 − W) dζ` for `T ≥ 0`; `U(T)` at `ζ = 0`:
///
/// ```text
/// 2√T Σ_{m≥0} (−1)^m [ierfc((2m+ζ)/2√T) − ierfc((2m+2−ζ)/2√T)]
/// ```
pub fn consolidated_below(zeta: f64, time_factor: f64) -> SeriesValue {
    if time_factor == 0.0 {
        return SeriesValue::closed_form(0.0);
    }
    let width = 2.0 * time_factor.sqrt();
    // Scaled by the width only at the end: early sums are as accurate relative to their size.
    let images = sum_images(
        |m| integral_of_erfc((2.0 * m + zeta) / width) - integral_of_erfc((2.0 * m + 2.0 - zeta) / width),
        |m| integral_of_erfc((2.0 * m + zeta) / width),
    );
    SeriesValue { value: width * images.value, tail_bound: width * images.tail_bound, ..images }
}

/// `dU/dT = [1 + 2 Σ_{m≥1} (−1)^m exp(−m²/T)]/√(πT)` for `T > 0`.
pub fn consolidation_rate(time_factor: f64) -> f64 {
    let image = |m: f64| 2.0 * elementary::exp(-(m + 1.0) * (m + 1.0) / time_factor);
    let images = sum_images(image, image);
    (1.0 - images.value) * 0.5 * FRAC_2_SQRT_PI / time_factor.sqrt()
}
