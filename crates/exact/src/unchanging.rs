//! Columns that do not change with time: a column at rest and a sealed one.

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{LAW_KEY, WATER_KEYS, WEIGHT_KEY};
use crate::parameters::ColumnParameters;
use crate::row::{Changes, Row};
use crate::solution::{Accuracy, FieldValues, Solution};

/// The row of the column at rest.
pub(crate) static AT_REST: Row = Row {
    name: "at-rest",
    words: "hydrostatic equilibrium",
    inputs: &[LAW_KEY, WEIGHT_KEY],
    changes: Changes::Still,
    ..Row::COLUMN
};
/// The row of the sealed column.
pub(crate) static SEALED_ELEMENT: Row = Row {
    name: "sealed-element",
    words: "the exact sealed column",
    inputs: &[&["height", "load", "youngs_modulus", "poissons_ratio"], WATER_KEYS, LAW_KEY],
    changes: Changes::Still,
    ..Row::COLUMN
};

/// A column with constant fields: a uniform pressure and effective stress, Pa, and a uniform compression relative to its
/// height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unchanging {
    pressure: f64,
    effective_stress: f64,
    strain: f64,
    height: f64,
}

impl Unchanging {
    /// A column at rest, with or without self-weight: no excess pressure, no stress beyond that of the weight and no
    /// displacement.
    ///
    /// # Errors
    /// When a parameter is impossible.
    pub fn at_rest(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        Ok(Self { pressure: 0.0, effective_stress: 0.0, strain: 0.0, height: parameters.height })
    }

    /// A column that no water leaves: `p = q/(1 + n E_oed/K_w)` at all times.
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

    /// 1 from the start: nothing is left to settle.
    fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        checked_time_factor(time_factor).map(|_| 1.0)
    }

    fn has_degree(&self) -> bool {
        false
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let terms = usize::from(self.strain != 0.0);
        checked_time_factor(time_factor).map(|_| Accuracy::new(terms, 0.0))
    }
}
