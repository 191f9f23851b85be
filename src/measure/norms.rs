//! Volume-weighted norms of the error of a sampled field, absolute and relative.
//!
//! The same pointwise error reads as order 2.5, 2.0 or 1.5 by what is called "the L2 norm", so
//! every norm here carries its formula, and all are means over the volume: a pointwise `h²` error
//! has norm `h²` times a constant, whatever the number of samples.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::case::norm::Norm;
use crate::elementary;

/// Why a norm has no value.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum UndefinedNorm {
    /// There are no samples.
    #[error("the field has no samples")]
    Empty,
    /// The three lists are of different lengths.
    #[error("{computed} computed values, {exact} exact values and {volumes} volumes do not match")]
    LengthMismatch {
        /// Number of computed values.
        computed: usize,
        /// Number of exact values.
        exact: usize,
        /// Number of volumes.
        volumes: usize,
    },
    /// A value is NaN or infinite.
    #[error("the {which} value of sample {index} is not finite")]
    NotFinite {
        /// `computed` or `exact`.
        which: String,
        /// Place in the list, from 0.
        index: usize,
    },
    /// A volume is NaN, infinite or negative.
    #[error("the volume of sample {index} is negative or not finite")]
    BadVolume {
        /// Place in the list, from 0.
        index: usize,
    },
    /// The volumes add up to nothing.
    #[error("the volumes add up to zero")]
    NoVolume,
    /// A relative norm was asked for, and the exact field is zero.
    #[error("the exact field is zero: an error relative to it means nothing")]
    ZeroExact,
    /// [`Norm::Relative`] was asked of more than one number.
    #[error("a relative error is of one number, not of {samples} samples")]
    NotScalar {
        /// Number of samples given.
        samples: usize,
    },
    /// The result is beyond the range of a double.
    #[error("the norm overflows")]
    Overflow,
}

/// Norm of `computed − exact`, in the unit of the field ([`Norm::absolute_formula`]).
///
/// Samples of zero volume count in no norm.
///
/// # Errors
/// [`UndefinedNorm`] when the lists are empty, do not match, or hold what is not a number.
pub fn absolute_error(
    norm: Norm,
    computed: &[f64],
    exact: &[f64],
    volumes: &[f64],
) -> Result<f64, UndefinedNorm> {
    check(norm, computed, exact, volumes)?;
    let difference = differences(computed, exact);
    finite(mean_norm(norm, &difference, volumes))
}

/// Norm of `computed − exact` over the same norm of `exact` ([`Norm::formula`]).
///
/// # Errors
/// [`UndefinedNorm`] as for [`absolute_error`], and when the exact field is zero.
pub fn relative_error(
    norm: Norm,
    computed: &[f64],
    exact: &[f64],
    volumes: &[f64],
) -> Result<f64, UndefinedNorm> {
    check(norm, computed, exact, volumes)?;
    let size = finite(mean_norm(norm, exact, volumes))?;
    if size == 0.0 {
        return Err(UndefinedNorm::ZeroExact);
    }
    let difference = differences(computed, exact);
    finite(finite(mean_norm(norm, &difference, volumes))? / size)
}

fn differences(computed: &[f64], exact: &[f64]) -> Vec<f64> {
    computed.iter().zip(exact).map(|(computed, exact)| computed - exact).collect()
}

/// The norm as a mean over the volume, scaled by the largest entry so that squares of very small
/// or very large fields neither vanish nor overflow.
fn mean_norm(norm: Norm, field: &[f64], volumes: &[f64]) -> f64 {
    let counted = || field.iter().zip(volumes).filter(|(_, volume)| **volume > 0.0);
    let largest = counted().map(|(value, _)| value.abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let largest_volume = volumes.iter().copied().fold(0.0, f64::max);
    let mean = |power: i32| {
        let total: f64 = counted().map(|(_, volume)| volume / largest_volume).sum();
        let sum: f64 = counted()
            .map(|(value, volume)| volume / largest_volume * elementary::powi((value / largest).abs(), power))
            .sum();
        sum / total
    };
    match norm {
        Norm::L1 => largest * mean(1),
        Norm::L2 => largest * mean(2).sqrt(),
        Norm::Linf | Norm::Relative => largest,
    }
}

fn finite(value: f64) -> Result<f64, UndefinedNorm> {
    if value.is_finite() { Ok(value) } else { Err(UndefinedNorm::Overflow) }
}

fn check(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Result<(), UndefinedNorm> {
    if computed.len() != exact.len() || computed.len() != volumes.len() {
        return Err(UndefinedNorm::LengthMismatch {
            computed: computed.len(),
            exact: exact.len(),
            volumes: volumes.len(),
        });
    }
    if computed.is_empty() {
        return Err(UndefinedNorm::Empty);
    }
    if norm == Norm::Relative && computed.len() > 1 {
        return Err(UndefinedNorm::NotScalar { samples: computed.len() });
    }
    for (which, values) in [("computed", computed), ("exact", exact)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(UndefinedNorm::NotFinite { which: which.to_owned(), index });
        }
    }
    if let Some(index) = volumes.iter().position(|volume| !volume.is_finite() || *volume < 0.0) {
        return Err(UndefinedNorm::BadVolume { index });
    }
    if !volumes.iter().any(|volume| *volume > 0.0) {
        return Err(UndefinedNorm::NoVolume);
    }
    Ok(())
}

#[cfg(test)]
#[path = "../../tests/unit/measure_norms.rs"]
mod tests;
