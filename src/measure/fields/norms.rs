//! Volume-weighted norms of the error of a sampled field, absolute and relative.
//!
//! One pointwise error reads as order 2.5, 2.0 or 1.5 by what is called "the L2 norm", so
//! every norm here carries its formula, and all are means over the volume: a pointwise `h²` error
//! has norm `h²` times a constant, whatever the number of samples.

use crate::case::Norm;
use oedometer_soil::elementary;

/// The error of a field and the exact one, for as many norms as are needed.
pub struct FieldDifference<'a> {
    difference: Vec<f64>,
    exact: &'a [f64],
    volumes: &'a [f64],
}

impl<'a> FieldDifference<'a> {
    /// `computed − exact`. `None` where the lists are empty, differ in length, are not finite, or have no volume.
    pub fn of(computed: &'a [f64], exact: &'a [f64], volumes: &'a [f64]) -> Option<Self> {
        let is_measurable = computed.len() == exact.len()
            && computed.len() == volumes.len()
            && computed.iter().chain(exact).all(|value| value.is_finite())
            && volumes.iter().all(|volume| volume.is_finite() && *volume >= 0.0)
            && volumes.iter().any(|volume| *volume > 0.0);
        is_measurable.then(|| {
            let difference = computed.iter().zip(exact).map(|(computed, exact)| computed - exact).collect();
            Self { difference, exact, volumes }
        })
    }

    /// Absolute and relative error in a norm: that of `computed − exact` as a mean over the volume, in the unit of the
    /// field, and over the same norm of `exact` ([`Norm::formula`]).
    ///
    /// Samples of zero volume count in no norm. `None` beyond the range of a double; no relative error where the exact
    /// field is zero. [`Norm::Relative`] is of one number.
    pub fn in_norm(&self, norm: Norm) -> (Option<f64>, Option<f64>) {
        if norm == Norm::Relative && self.exact.len() != 1 {
            return (None, None);
        }
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        let error = finite(mean_norm(norm, &self.difference, self.volumes));
        let size = finite(mean_norm(norm, self.exact, self.volumes)).filter(|size| *size > 0.0);
        (error, error.zip(size).and_then(|(error, size)| finite(error / size)))
    }
}

/// The relative error of [`FieldDifference::in_norm`].
pub fn relative_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    FieldDifference::of(computed, exact, volumes)?.in_norm(norm).1
}

/// The norm of a field as a mean over the volume, scaled by the largest value and volume so that squares of very small
/// or very large numbers neither vanish nor overflow.
fn mean_norm(norm: Norm, values: &[f64], volumes: &[f64]) -> f64 {
    let counted = || values.iter().zip(volumes).filter(|(_, volume)| **volume > 0.0);
    let largest = counted().map(|(value, _)| value.abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let largest_volume = volumes.iter().copied().fold(0.0, f64::max);
    let total: f64 = counted().map(|(_, volume)| volume / largest_volume).sum();
    let mean = |power: fn(f64) -> f64| {
        let weighted =
            counted().map(|(value, volume)| volume / largest_volume * power((value / largest).abs()));
        weighted.sum::<f64>() / total
    };
    match norm {
        Norm::L1 => largest * mean(|share| share),
        Norm::L2 => largest * mean(|share| share * share).sqrt(),
        Norm::Linf | Norm::Relative => largest,
    }
}

/// One place's contribution to the error of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Place in the list of samples, from 0.
    pub index: usize,
    /// Computed less exact, in the unit of the field.
    pub error: f64,
    /// Share of the squared L2 error, from 0 to 1.
    pub share: f64,
}

/// The largest contribution of all places, the first of equal ones; `None` where the error vanishes or is not finite.
pub fn largest_contribution(computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<Contribution> {
    // Scaled by the largest, so that the squares of tiny errors do not vanish.
    let errors = || computed.iter().zip(exact).map(|(computed, exact)| computed - exact);
    let largest = errors().fold(0.0_f64, |largest, error| largest.max(error.abs()));
    let weights =
        || errors().zip(volumes).map(|(error, volume)| volume * elementary::powi(error / largest, 2));
    let total: f64 = weights().sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let (index, weight) = weights()
        .enumerate()
        .reduce(|most, next| if next.1.total_cmp(&most.1).is_gt() { next } else { most })?;
    Some(Contribution { index, error: computed[index] - exact[index], share: weight / total })
}

#[cfg(test)]
mod tests;
