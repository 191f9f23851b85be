//! Volume-weighted norms of the error of a sampled field, absolute and relative.
//!
//! The same pointwise error reads as order 2.5, 2.0 or 1.5 by what is called "the L2 norm", so
//! every norm here carries its formula, and all are means over the volume: a pointwise `h²` error
//! has norm `h²` times a constant, whatever the number of samples.

use crate::case::norm::Norm;
use crate::elementary;

/// Norm of `computed − exact` as a mean over the volume, in the unit of the field.
///
/// Samples of zero volume count in no norm. None where the lists are empty, do not match, hold what is not a
/// number or no volume at all, or where the norm is beyond the range of a double.
pub fn absolute_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    let difference = differences(norm, computed, exact, volumes)?;
    finite(mean_norm(norm, &difference, volumes))
}

/// Norm of `computed − exact` over the same norm of `exact` ([`Norm::formula`]); none as for
/// [`absolute_error`], and where the exact field is zero.
pub fn relative_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    let difference = differences(norm, computed, exact, volumes)?;
    let size = finite(mean_norm(norm, exact, volumes))?;
    finite(finite(mean_norm(norm, &difference, volumes))? / size).filter(|_| size > 0.0)
}

/// The differences of fields that can be measured: a relative error is of one number.
fn differences(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<Vec<f64>> {
    let is_measurable = computed.len() == exact.len()
        && computed.len() == volumes.len()
        && (norm != Norm::Relative || computed.len() == 1)
        && computed.iter().chain(exact).all(|value| value.is_finite())
        && volumes.iter().all(|volume| volume.is_finite() && *volume >= 0.0)
        && volumes.iter().any(|volume| *volume > 0.0);
    is_measurable.then(|| computed.iter().zip(exact).map(|(computed, exact)| computed - exact).collect())
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

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

#[cfg(test)]
#[path = "../../tests/unit/measure_norms.rs"]
mod tests;
