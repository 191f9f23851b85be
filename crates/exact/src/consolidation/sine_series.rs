//! The sums over the column's modes, for large time factors.

use core::f64::consts::PI;

use crate::consolidation::series_value::SeriesValue;
use oedometer_soil::elementary;

/// Terms below this share of the first are left out: a quarter of `f64`'s round-off.
const RELATIVE_TAIL: f64 = 2.8e-17;

/// Eigenvalue `M_j = (j + ½)π` of the column drained at one end.
pub fn eigenvalue(mode: usize) -> f64 {
    (mode as f64 + 0.5) * PI
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
        |mode, m| {
            let sign = if mode % 2 == 0 { 1.0 } else { -1.0 };
            2.0 / (m * m) * sign * elementary::sin(m * (1.0 - zeta))
        },
    )
}

/// `dU/dT = Σ 2 exp(−M_j² T)` for `T > 0`.
pub fn consolidation_rate(time_factor: f64) -> f64 {
    sum_modes(time_factor, |_| 2.0, |_, _| 2.0).value
}
