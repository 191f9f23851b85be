//! Terzaghi's functions of depth and time, to `1e-14` absolute.
//!
//! With `M_j = (j + ½)π`,
//!
//! ```text
//! W(ζ, T) = Σ (2/M_j) sin(M_j ζ) exp(−M_j² T)         isochrone: excess pressure over its initial value
//! U(T)    = 1 − Σ (2/M_j²) exp(−M_j² T)               mean degree of consolidation
//! I(ζ, T) = ∫_ζ^1 W dζ = Σ (2/M_j²) cos(M_j ζ) exp(−M_j² T)
//! ```
//!
//! (Terzaghi 1943; Carslaw & Jaeger 1959, sections 3.3 and 12.5). The sums over modes converge fast for large
//! `T`, the sums over mirror images for small `T`; at [`SWITCH`] both need four terms for all of
//! `f64`'s digits.

pub(crate) mod series;

pub use crate::consolidation::series::{SWITCH, SeriesValue, eigenvalue};

use crate::consolidation::series::{images, modes};
use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use core::f64::consts::PI;
use oedometer_soil::elementary;

/// Newton's iteration for a degree of consolidation converges quadratically; this is far more than it takes.
const MOST_STEPS: usize = 60;

/// Isochrone `W(ζ, T)`: 1 at the start, 0 at the drained surface `ζ = 0`.
///
/// # Errors
/// When `zeta` is outside [0, 1] or `time_factor` is negative or not finite.
pub fn isochrone(zeta: f64, time_factor: f64) -> Result<SeriesValue, ExactError> {
    let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
    Ok(if time_factor == 0.0 {
        SeriesValue::closed_form(if zeta > 0.0 { 1.0 } else { 0.0 })
    } else if time_factor < SWITCH {
        images::isochrone(zeta, time_factor)
    } else {
        modes::isochrone(zeta, time_factor)
    })
}

/// Integral of the isochrone from a depth to the base, `I(ζ, T) = ∫_ζ^1 W dζ`.
///
/// # Errors
/// When `zeta` is outside [0, 1] or `time_factor` is negative or not finite.
pub fn isochrone_integral(zeta: f64, time_factor: f64) -> Result<SeriesValue, ExactError> {
    let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
    Ok(if time_factor < SWITCH {
        let consolidated = images::consolidated_below(zeta, time_factor);
        SeriesValue { value: 1.0 - zeta - consolidated.value, ..consolidated }
    } else {
        modes::isochrone_integral(zeta, time_factor)
    })
}

/// Consolidation below a depth, `(1 − ζ) − I(ζ, T) = ∫_ζ^1 (1 − W) dζ`; `U(T)` at `ζ = 0`.
///
/// Early and deep, where it is much smaller than either of the two terms, it keeps its digits.
///
/// # Errors
/// When `zeta` is outside [0, 1] or `time_factor` is negative or not finite.
pub fn consolidated_below(zeta: f64, time_factor: f64) -> Result<SeriesValue, ExactError> {
    let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
    Ok(if time_factor < SWITCH {
        images::consolidated_below(zeta, time_factor)
    } else {
        let integral = modes::isochrone_integral(zeta, time_factor);
        SeriesValue { value: 1.0 - zeta - integral.value, ..integral }
    })
}

/// Mean degree of consolidation `U(T)`.
///
/// # Errors
/// When `time_factor` is negative or not finite.
pub fn degree_of_consolidation(time_factor: f64) -> Result<SeriesValue, ExactError> {
    consolidated_below(0.0, time_factor)
}

/// Time factor `T` with `U(T) = degree`, to about `1e-14` relative.
///
/// Early consolidation starts from `T = π U²/4`, late consolidation from the first mode,
/// `1 − U = (8/π²) exp(−π² T/4)` (Terzaghi 1943).
///
/// # Errors
/// When `degree` is outside [0, 1).
pub fn time_factor_for_degree(degree: f64) -> Result<f64, ExactError> {
    if !(0.0..1.0).contains(&degree) {
        return Err(ExactError::Degree(degree));
    }
    if degree == 0.0 {
        return Ok(0.0);
    }
    if degree < images::consolidated_below(0.0, SWITCH).value {
        Ok(early(degree))
    } else {
        Ok(late(1.0 - degree))
    }
}

/// Newton in `√T`, in which `U` is nearly linear.
fn early(degree: f64) -> f64 {
    let mut root = 0.5 * PI.sqrt() * degree;
    for _ in 0..MOST_STEPS {
        let time_factor = root * root;
        // A degree whose time factor underflows has the limit's closed form.
        if time_factor < f64::MIN_POSITIVE {
            break;
        }
        let misfit = images::consolidated_below(0.0, time_factor).value - degree;
        let step = misfit / (2.0 * root * images::consolidation_rate(time_factor));
        root -= step;
        if step.abs() <= f64::EPSILON * root {
            break;
        }
    }
    root * root
}

/// Newton in `ln(1 − U)`, which is nearly linear in `T`.
fn late(remaining: f64) -> f64 {
    let mut time_factor = (-4.0 / (PI * PI) * elementary::ln(remaining * PI * PI / 8.0)).max(SWITCH / 2.0);
    for _ in 0..MOST_STEPS {
        let value = modes::isochrone_integral(0.0, time_factor).value;
        let step = value * elementary::ln(value / remaining) / modes::consolidation_rate(time_factor);
        time_factor += step;
        if step.abs() <= f64::EPSILON * time_factor {
            break;
        }
    }
    time_factor
}

#[cfg(test)]
mod tests;
