//! The sums behind Terzaghi's functions: over mirror images of the drained surface for small time factors ([`images`]),
//! over the modes of the column for large ones ([`modes`]), and their integrals over time ([`elapsed`]).

use core::f64::consts::{FRAC_2_SQRT_PI, PI};
use oedometer_soil::elementary;

/// Time factor below which the images are summed, above which the modes.
pub const SWITCH: f64 = 0.2;
/// Terms of the images below this are left out: a tenth of the round-off of 1.
const ABSOLUTE_TAIL: f64 = 2.2e-17;
/// Modes below this share of the first are left out: a quarter of `f64`'s round-off.
const RELATIVE_TAIL: f64 = 2.8e-17;

/// A truncated sum, with what was left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesValue {
    /// The sum.
    pub value: f64,
    /// Number of terms in it.
    pub terms: usize,
    /// Rigorous bound on the absolute value of the omitted terms' sum.
    pub tail_bound: f64,
}

impl SeriesValue {
    /// A value that needs no sum.
    pub fn closed_form(value: f64) -> Self {
        Self { value, terms: 0, tail_bound: 0.0 }
    }
}

/// Eigenvalue `M_j = (j + ½)π` of the column drained at one end.
pub fn eigenvalue(mode: usize) -> f64 {
    (mode as f64 + 0.5) * PI
}

/// `−1` for odd modes and images.
fn sign(number: usize) -> f64 {
    if number.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Repeated integrals `i¹erfc`, `i²erfc` and `i³erfc`, with absolute accuracy (Abramowitz & Stegun 7.2.5).
fn integrals_of_erfc(x: f64) -> [f64; 3] {
    if x > 30.0 {
        // Below 1e-390; keeps infinite arguments from giving NaN.
        return [0.0; 3];
    }
    let zeroth = elementary::erfc(x);
    let first = 0.5 * FRAC_2_SQRT_PI * elementary::exp(-x * x) - x * zeroth;
    let second = 0.25 * (zeroth - 2.0 * x * first);
    [first, second, (first - 2.0 * x * second) / 6.0]
}

/// Sum of `(−1)^m term(m)`, smallest first, where `bound(m) ≥ |term(m)|` bounds the tail from `m` on.
fn sum_images(term: impl Fn(f64) -> f64, bound: impl Fn(f64) -> f64) -> SeriesValue {
    let mut terms: usize = 0;
    while bound(terms as f64) > ABSOLUTE_TAIL {
        terms += 1;
    }
    let value = (0..terms).rev().map(|m| sign(m) * term(m as f64)).sum();
    SeriesValue { value, terms, tail_bound: bound(terms as f64) }
}

/// Sum of `amplitude(j, M_j) exp(−M_j² T)`, smallest terms first, where `envelope(M_j) ≥ |amplitude(j, M_j)|`
/// falls with `j`.
fn sum_modes(
    time_factor: f64,
    envelope: impl Fn(f64) -> f64,
    amplitude: impl Fn(usize, f64) -> f64,
) -> SeriesValue {
    let bound = |mode: usize| {
        let m = eigenvalue(mode);
        envelope(m) * elementary::exp(-m * m * time_factor)
    };
    // M² grows by at least M_{j+1}² − M_j² a mode, so the tail is below a geometric series.
    let tail = |mode: usize| {
        let (m, next) = (eigenvalue(mode), eigenvalue(mode + 1));
        bound(mode) / -elementary::exp_m1(-(next * next - m * m) * time_factor)
    };
    let allowed = RELATIVE_TAIL * bound(0);
    let mut terms = 1;
    while tail(terms) > allowed {
        terms += 1;
    }
    let value = (0..terms)
        .rev()
        .map(|mode| {
            let m = eigenvalue(mode);
            amplitude(mode, m) * elementary::exp(-m * m * time_factor)
        })
        .sum();
    SeriesValue { value, terms, tail_bound: tail(terms) }
}

/// Sums over mirror images: the heat kernel with an absorbing end at `ζ = 0` and a reflecting end at `ζ = 1`
/// (Carslaw & Jaeger 1959, section 12.5). All alternate in sign with falling terms, so the first omitted term bounds the
/// tail.
pub mod images {
    use super::{FRAC_2_SQRT_PI, SeriesValue, elementary, integrals_of_erfc, sum_images};

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
            |m| {
                integrals_of_erfc((2.0 * m + zeta) / width)[0]
                    - integrals_of_erfc((2.0 * m + 2.0 - zeta) / width)[0]
            },
            |m| integrals_of_erfc((2.0 * m + zeta) / width)[0],
        );
        SeriesValue { value: width * images.value, tail_bound: width * images.tail_bound, ..images }
    }

    /// `dU/dT = [1 + 2 Σ_{m≥1} (−1)^m exp(−m²/T)]/√(πT)` for `T > 0`.
    pub fn consolidation_rate(time_factor: f64) -> f64 {
        let image = |m: f64| 2.0 * elementary::exp(-(m + 1.0) * (m + 1.0) / time_factor);
        let images = sum_images(image, image);
        (1.0 - images.value) * 0.5 * FRAC_2_SQRT_PI / time_factor.sqrt()
    }
}

/// Sums over the modes of the column.
pub mod modes {
    use super::{SeriesValue, elementary, sign, sum_modes};

    /// `W(ζ, T)` for `T > 0`.
    pub fn isochrone(zeta: f64, time_factor: f64) -> SeriesValue {
        sum_modes(time_factor, |m| 2.0 / m, |_, m| 2.0 / m * elementary::sin(m * zeta))
    }

    /// `I(ζ, T) = ∫_ζ^1 W dζ` for `T > 0`; `1 − U(T)` at `ζ = 0`, to full relative accuracy.
    pub fn isochrone_integral(zeta: f64, time_factor: f64) -> SeriesValue {
        sum_modes(
            time_factor,
            |m| 2.0 / (m * m),
            // cos(M_j ζ) = ± sin(M_j (1 − ζ)), which is exact at the base, where it vanishes.
            |mode, m| 2.0 / (m * m) * sign(mode) * elementary::sin(m * (1.0 - zeta)),
        )
    }

    /// `dU/dT = Σ 2 exp(−M_j² T)` for `T > 0`.
    pub fn consolidation_rate(time_factor: f64) -> f64 {
        sum_modes(time_factor, |_| 2.0, |_, _| 2.0).value
    }
}

/// Integrals over time.
pub mod elapsed {
    use super::{SWITCH, elementary, integrals_of_erfc, sign, sum_images, sum_modes};

    /// Integral of the isochrone over the time that has passed, `∫_0^T W(ζ, T) dT`: what a growing load leaves behind.
    ///
    /// ```text
    /// T − 4T Σ (−1)^m [i²erfc((2m+ζ)/2√T) + i²erfc((2m+2−ζ)/2√T)]  =  ζ(2−ζ)/2 − Σ (2/M_j³) sin(M_j ζ) exp(−M_j² T)
    /// ```
    ///
    /// No sum cancels: early values are as accurate relative to `T` as `f64` allows.
    pub fn isochrone(zeta: f64, time_factor: f64) -> f64 {
        if time_factor == 0.0 {
            return 0.0;
        }
        if time_factor < SWITCH {
            let width = 2.0 * time_factor.sqrt();
            let integral = |place: f64| integrals_of_erfc(place / width)[1];
            let images = sum_images(
                |m| integral(2.0 * m + zeta) + integral(2.0 * m + 2.0 - zeta),
                |m| 2.0 * integral(2.0 * m + zeta),
            );
            return time_factor * (1.0 - 4.0 * images.value);
        }
        let amplitude = |m: f64| 2.0 / (m * m * m);
        let modes = sum_modes(time_factor, amplitude, |_, m| amplitude(m) * elementary::sin(m * zeta));
        0.5 * zeta * (2.0 - zeta) - modes.value
    }

    /// The integral of [`isochrone`] from a depth to the base, `∫_0^T I(ζ, T) dT` with `I = ∫_ζ^1 W dζ`.
    pub fn isochrone_integral(zeta: f64, time_factor: f64) -> f64 {
        if time_factor == 0.0 {
            return 0.0;
        }
        let height = 1.0 - zeta;
        if time_factor < SWITCH {
            let width = 2.0 * time_factor.sqrt();
            let integral = |place: f64| integrals_of_erfc(place / width)[2];
            let images = sum_images(
                |m| integral(2.0 * m + zeta) - integral(2.0 * m + 2.0 - zeta),
                |m| integral(2.0 * m + zeta),
            );
            return time_factor * (height - 4.0 * width * images.value);
        }
        let amplitude = |m: f64| 2.0 / (m * m * m * m);
        let modes = sum_modes(time_factor, amplitude, |mode, m| {
            amplitude(m) * sign(mode) * elementary::sin(m * height)
        });
        height * (0.5 - height * height / 6.0) - modes.value
    }
}
