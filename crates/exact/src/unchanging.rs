//! Columns in which nothing changes with time: one at rest, and one that no water leaves.

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{LAW, OF_WATER, WEIGHT};
use crate::parameters::ColumnParameters;
use crate::solution::{Accuracy, FieldValues, Solution};

/// Keys that it reads at rest.
pub(crate) const INPUTS_AT_REST: &[&[&str]] = &[LAW, WEIGHT];
/// Keys that it reads where no water leaves.
pub(crate) const INPUTS: &[&[&str]] =
    &[&["height", "load", "youngs_modulus", "poissons_ratio"], OF_WATER, LAW];

/// A column whose fields stay as they are from the start on: a pressure and an effective stress, Pa, that are uniform, and
/// the share of its height that it has got shorter by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unchanging {
    pressure: f64,
    effective_stress: f64,
    strain: f64,
    height: f64,
}

impl Unchanging {
    /// A column at rest, whatever it weighs: no pressure, no stress beyond that of the weight and no displacement.
    ///
    /// # Errors
    /// When a parameter is impossible.
    pub fn at_rest(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        Ok(Self { pressure: 0.0, effective_stress: 0.0, strain: 0.0, height: parameters.height })
    }

    /// A column that no water leaves: `p = q/(1 + n E_oed/K_w)` for ever.
    ///
    /// # Errors
    /// When a parameter is impossible.
    pub fn sealed(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let carried = parameters.load * parameters.immediate_ratio();
        Ok(Self {
            pressure: parameters.load * parameters.storage_ratio(),
            effective_stress: -carried,
            strain: carried / parameters.soil.oedometric_modulus(),
            height: parameters.height,
        })
    }
}

impl Solution for Unchanging {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        checked_time_factor(time_factor)?;
        let displacement = -self.strain * (1.0 - checked_depth(zeta)?) * self.height;
        Ok(FieldValues { pressure: self.pressure, effective_stress: self.effective_stress, displacement })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| self.strain * self.height)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        self.settlement(0.0)
    }

    /// All there is to come has come.
    fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| 1.0)
    }

    fn has_degree(&self) -> bool {
        false
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let terms = usize::from(self.strain != 0.0);
        checked_time_factor(time_factor).map(|_| Accuracy::of(terms, 0.0))
    }
}
