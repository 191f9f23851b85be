//! A column at rest: no excess pressure and no motion, whatever it weighs.

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::field_values::{Accuracy, FieldValues};

/// Nothing happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtRest;

#[expect(clippy::unused_self, clippy::trivially_copy_pass_by_ref, reason = "asked like every other solution")]
impl AtRest {
    /// No pressure, no stress beyond that of the weight and no displacement.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        checked_time_factor(time_factor)?;
        checked_depth(zeta)?;
        Ok(FieldValues { pressure: 0.0, effective_stress: 0.0, displacement: 0.0 })
    }

    /// None.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| 0.0)
    }

    /// All there is to come has come.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| 1.0)
    }

    /// Exact.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        checked_time_factor(time_factor).map(|_| Accuracy::of(0, 0.0))
    }
}
