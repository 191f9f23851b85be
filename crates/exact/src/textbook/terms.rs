//! How many terms of a series over roots are enough.

use crate::exact_error::ExactError;
use crate::solution::Accuracy;

/// Bound on the contribution of omitted terms to the pressure over the load.
const NEGLIGIBLE: f64 = 1e-17;

/// The least number of terms, up to `most`, whose bound on the rest is negligible, with that bound.
///
/// # Errors
/// When there are too few terms for the time.
pub(crate) fn terms_for(
    most: usize,
    time_factor: f64,
    tail: impl Fn(usize) -> f64,
) -> Result<Accuracy, ExactError> {
    if tail(most) > NEGLIGIBLE {
        return Err(ExactError::TooEarly { time_factor, terms: most });
    }
    // The bound falls with the number of terms.
    let (mut few, mut enough) = (0, most);
    while enough - few > 1 {
        let middle = usize::midpoint(few, enough);
        if tail(middle) > NEGLIGIBLE { few = middle } else { enough = middle }
    }
    Ok(Accuracy { phase_bound: ROUND_OFF * enough as f64, ..Accuracy::new(enough, tail(enough)) })
}

/// Bound on the round-off error of a term in the pressure over the load.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
