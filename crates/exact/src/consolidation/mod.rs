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

pub(crate) mod elapsed;
pub(crate) mod images;
pub(crate) mod inverse;
pub(crate) mod series_value;
pub(crate) mod sine_series;

pub use crate::consolidation::inverse::time_factor_for_degree;
pub use crate::consolidation::series_value::SeriesValue;
pub use crate::consolidation::sine_series::eigenvalue;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};

/// Time factor below which the images are summed, above which the modes.
pub const SWITCH: f64 = 0.2;

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
        sine_series::isochrone(zeta, time_factor)
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
        sine_series::isochrone_integral(zeta, time_factor)
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
        let integral = sine_series::isochrone_integral(zeta, time_factor);
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

#[cfg(test)]
mod tests;
