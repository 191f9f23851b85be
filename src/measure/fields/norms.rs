//! Volume-weighted norms of the error of a sampled field, absolute and relative.
//!
//! The same pointwise error reads as order 2.5, 2.0 or 1.5 by what is called "the L2 norm", so
//! every norm here carries its formula, and all are means over the volume: a pointwise `h²` error
//! has norm `h²` times a constant, whatever the number of samples.

use crate::case::norm::Norm;

/// A field with its weights, ready for means over the volume.
struct WeightedField<'a> {
    values: &'a [f64],
    volumes: &'a [f64],
    /// Largest size of a value that counts.
    largest: f64,
    largest_volume: f64,
    /// Sum of the volumes over the largest of them.
    total: f64,
}

/// The error of a field beside the exact one, for as many norms as are asked for.
pub struct FieldDifference<'a> {
    difference: Vec<f64>,
    exact: &'a [f64],
    volumes: &'a [f64],
}

impl<'a> FieldDifference<'a> {
    /// `computed − exact`. None where the lists are empty, do not match, hold what is not a number or no volume at all.
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

    /// Absolute and relative error in some norms, as [`absolute_error`] and [`relative_error`] give them one by one.
    pub fn in_norms<const N: usize>(&self, norms: [Norm; N]) -> [(Option<f64>, Option<f64>); N] {
        let difference = WeightedField::of(&self.difference, self.volumes);
        let exact = WeightedField::of(self.exact, self.volumes);
        norms.map(|norm| {
            if norm == Norm::Relative && self.exact.len() != 1 {
                return (None, None);
            }
            let error = finite(difference.mean_norm(norm));
            let size = finite(exact.mean_norm(norm)).filter(|size| *size > 0.0);
            (error, error.zip(size).and_then(|(error, size)| finite(error / size)))
        })
    }
}

/// Norm of `computed − exact` as a mean over the volume, in the unit of the field.
///
/// Samples of zero volume count in no norm. None where the lists are empty, do not match, hold what is not a
/// number or no volume at all, or where the norm is beyond the range of a double.
#[cfg(test)]
fn absolute_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    FieldDifference::of(computed, exact, volumes)?.in_norms([norm])[0].0
}

/// Norm of `computed − exact` over the same norm of `exact` ([`Norm::formula`]); none as for
/// an absolute one, and where the exact field is zero. A relative error is of one number.
pub fn relative_error(norm: Norm, computed: &[f64], exact: &[f64], volumes: &[f64]) -> Option<f64> {
    FieldDifference::of(computed, exact, volumes)?.in_norms([norm])[0].1
}

impl<'a> WeightedField<'a> {
    fn of(values: &'a [f64], volumes: &'a [f64]) -> Self {
        let counted = values.iter().zip(volumes).filter(|(_, volume)| **volume > 0.0);
        let largest = counted.map(|(value, _)| value.abs()).fold(0.0, f64::max);
        let largest_volume = volumes.iter().copied().fold(0.0, f64::max);
        let counted = volumes.iter().take(values.len()).filter(|volume| **volume > 0.0);
        let total = counted.map(|volume| volume / largest_volume).sum();
        Self { values, volumes, largest, largest_volume, total }
    }

    /// The norm as a mean over the volume, scaled by the largest entry so that squares of very small
    /// or very large fields neither vanish nor overflow.
    fn mean_norm(&self, norm: Norm) -> f64 {
        let largest = self.largest;
        if largest == 0.0 || !largest.is_finite() {
            return largest;
        }
        match norm {
            Norm::L1 => largest * self.mean(|share| share),
            Norm::L2 => largest * self.mean(|share| share * share).sqrt(),
            Norm::Linf | Norm::Relative => largest,
        }
    }

    /// Mean over the volume of a power of the values' sizes over the largest one.
    fn mean(&self, power: impl Fn(f64) -> f64) -> f64 {
        let counted = self.values.iter().zip(self.volumes).filter(|(_, volume)| **volume > 0.0);
        let weighted =
            counted.map(|(value, volume)| volume / self.largest_volume * power((value / self.largest).abs()));
        weighted.sum::<f64>() / self.total
    }
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests;
