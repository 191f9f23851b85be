//! Terzaghi's column under a suddenly applied load, with and without the water's compressibility.

use crate::consolidation::{consolidated_below, isochrone};
use crate::exact_error::ExactError;
use crate::inputs::{COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WATER_KEYS, WEIGHT_KEY};
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};

/// Its row with compressible water.
pub(crate) static TERZAGHI: Row = Row {
    name: "terzaghi",
    words: "Terzaghi's solution with compressible water",
    inputs: &[COLUMN_KEYS, DRAINAGE_KEY, WATER_KEYS, LAW_KEY, WEIGHT_KEY],
    adds_up: true,
    ..Row::COLUMN
};
/// Its row with incompressible water.
pub(crate) static TERZAGHI_INCOMPRESSIBLE: Row = Row {
    name: "terzaghi-incompressible",
    words: "Terzaghi's solution",
    inputs: &[COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WEIGHT_KEY],
    adds_up: true,
    ..Row::COLUMN
};

/// Small-strain consolidation of a column that drains at its top alone (Terzaghi 1943).
///
/// With the storage ratio `B = Q/(Q + E_oed)`,
///
/// ```text
/// p = q B W(ζ, B T_v)        s = m_v q H [1 − B + B U(B T_v)]
/// ```
///
/// and `B = 1` for incompressible water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terzaghi {
    parameters: ColumnParameters,
    /// `B`.
    storage_ratio: f64,
    /// `1 − B`.
    immediate_ratio: f64,
}

impl Terzaghi {
    /// The column with compressible water: part of the settlement is immediate.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn compressible(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        Ok(Self {
            parameters: *parameters,
            storage_ratio: parameters.storage_ratio(),
            immediate_ratio: parameters.immediate_ratio(),
        })
    }

    /// The column as in the textbooks: the water's bulk modulus is taken as infinite.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn incompressible(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        Ok(Self { parameters: *parameters, storage_ratio: 1.0, immediate_ratio: 0.0 })
    }
}

impl Solution for Terzaghi {
    /// Pressure, effective stress and displacement at a relative depth.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let load = self.parameters.load;
        let slowed = self.storage_ratio * time_factor;
        let pressure = load * self.storage_ratio * isochrone(zeta, slowed)?.value;
        let compressed = self.immediate_ratio * (1.0 - zeta)
            + self.storage_ratio * consolidated_below(zeta, slowed)?.value;
        Ok(FieldValues {
            pressure,
            effective_stress: pressure - load,
            displacement: -self.parameters.final_settlement() * compressed,
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let consolidated = consolidated_below(0.0, self.storage_ratio * time_factor)?.value;
        let degree = self.immediate_ratio + self.storage_ratio * consolidated;
        Ok(self.parameters.final_settlement() * degree)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.parameters.final_settlement())
    }

    /// Terms and tail of the pressure, the worst over the depth.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        // The images' tail grows with the depth, the modes' does not depend on it.
        let base = isochrone(1.0, self.storage_ratio * time_factor)?;
        Ok(Accuracy::new(base.terms, self.storage_ratio * base.tail_bound))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undrained_start_settles_by_the_waters_compression() {
        let seed = ColumnParameters::default();
        let column = Terzaghi::compressible(&seed).unwrap();
        let start = column.fields(0.0, 0.5).unwrap();
        assert_eq!(start.pressure, seed.storage_ratio());
        assert!((start.displacement + 0.5 * seed.immediate_ratio() / 1.2e6).abs() < 1e-25);
        assert_eq!(column.fields(0.0, 0.0).unwrap().pressure, 0.0);
        // Effective stress that the undrained skeleton carries is its strain times its modulus.
        let strain = column.settlement(0.0).unwrap() / seed.height;
        assert!((strain * seed.soil.oedometric_modulus() + start.effective_stress).abs() < 1e-15);
    }

    #[test]
    fn end_of_consolidation_is_drained() {
        let seed = ColumnParameters { load: 2.0e3, height: 3.0, ..ColumnParameters::default() };
        for column in [Terzaghi::compressible(&seed).unwrap(), Terzaghi::incompressible(&seed).unwrap()] {
            let end = column.fields(100.0, 0.0).unwrap();
            assert!(end.pressure.abs() < 1e-12);
            assert!((end.effective_stress + 2.0e3).abs() < 1e-9);
            assert!((end.displacement + 5.0e-3).abs() < 1e-15);
            assert!((column.settlement(100.0).unwrap() - 5.0e-3).abs() < 1e-15);
        }
    }

    #[test]
    fn storage_of_the_seed_case_shows_at_the_fourth_digit() {
        let seed = ColumnParameters::default();
        let with = Terzaghi::compressible(&seed).unwrap();
        let without = Terzaghi::incompressible(&seed).unwrap();
        let (mut difference, mut norm) = (0.0, 0.0);
        for i in 0..200 {
            let zeta = (f64::from(i) + 0.5) / 200.0;
            let a = with.fields(0.05, zeta).unwrap().pressure;
            let b = without.fields(0.05, zeta).unwrap().pressure;
            difference += (a - b) * (a - b);
            norm += b * b;
        }
        let relative = (difference / norm).sqrt();
        assert!((1.3e-4..1.7e-4).contains(&relative), "{relative:e}");
    }
}
