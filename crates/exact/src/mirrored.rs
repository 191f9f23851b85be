//! Columns drained at both ends: two of half the height about a middle that no water passes.

use crate::exact_error::{ExactError, checked_depth};
use crate::parameters::{ColumnParameters, Drainage};
use crate::solution::{Accuracy, FieldValues, Solution};

/// A column of one soil that is drained at its top and at its base, under a load that acts on all of it alike.
///
/// Its pressures are symmetric about the middle, so that each half is a column on an impermeable base, with the same time
/// factor `T_v = c_v t/(H/2)²`. Displacements are not: the base rests, the middle settles by the half below it.
#[derive(Clone, Debug)]
pub struct Mirrored<S> {
    half: S,
}

impl<S: Solution> Mirrored<S> {
    /// The column whose half a function solves, on an impermeable base.
    ///
    /// # Errors
    /// Those of the half.
    pub fn new(
        parameters: &ColumnParameters,
        solve: impl FnOnce(&ColumnParameters) -> Result<S, ExactError>,
    ) -> Result<Self, ExactError> {
        let half =
            ColumnParameters { height: 0.5 * parameters.height, drainage: Drainage::Top, ..*parameters };
        Ok(Self { half: solve(&half)? })
    }
}

impl<S: Solution> Solution for Mirrored<S> {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let zeta = checked_depth(zeta)?;
        let fields = self.half.fields(time_factor, 2.0 * zeta.min(1.0 - zeta))?;
        let of_half = self.half.settlement(time_factor)?;
        let displacement =
            if zeta <= 0.5 { fields.displacement - of_half } else { -of_half - fields.displacement };
        Ok(FieldValues { displacement, ..fields })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(2.0 * self.half.settlement(time_factor)?)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(2.0 * self.half.final_settlement()?)
    }

    fn least_porosity(&self) -> Option<f64> {
        self.half.least_porosity()
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.half.accuracy(time_factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layered::LayeredColumn;
    use crate::terzaghi::Terzaghi;
    use crate::xie_leo::XieLeo;
    use oedometer_soil::material::Material;

    #[test]
    fn xie_and_leos_column_has_the_degrees_of_another_program() {
        // Python package geotecha 0.2.2, its test of Xie & Leo (2004).
        let modulus = 1e3 / 4e-3;
        let soil = Material {
            youngs_modulus: modulus,
            poissons_ratio: 0.0,
            porosity: 0.5,
            hydraulic_conductivity: 1e-9,
            gravity: 10.0,
            ..Material::default()
        };
        let column = ColumnParameters {
            height: 10.0,
            load: 1e5,
            drainage: Drainage::Both,
            soil,
            ..ColumnParameters::default()
        };
        let solution = Mirrored::new(&column, XieLeo::new).unwrap();
        for (seconds, degree) in
            [(4e6, 0.071_364_96), (5.039_684_20e7, 0.253_312_56), (6.349_604_21e8, 0.830_807_79)]
        {
            let found = solution.degree_of_consolidation(column.time_factor(seconds)).unwrap();
            assert!((found - degree).abs() < 1e-8, "{found} for {degree}");
        }
    }

    #[test]
    fn layers_of_one_soil_are_the_mirrored_column_early_and_late_and_the_base_rests() {
        let seed = ColumnParameters { load: 3e3, drainage: Drainage::Both, ..ColumnParameters::default() };
        let mirrored = Mirrored::new(&seed, Terzaghi::compressible).unwrap();
        let soil = Material::default();
        let layers = [(0.2, soil), (0.5, soil), (0.3, soil)];
        let column = LayeredColumn::new(3e3, &layers, Drainage::Both).unwrap();
        for time_factor in [0.0, 1e-9, 1e-6, 1e-4, 0.01, 0.3, 2.0, 30.0] {
            let seconds = seed.time(time_factor);
            for y in [0.0, 0.001, 0.1, 0.2, 0.5, 0.69, 0.9, 1.0] {
                let expected = mirrored.fields(time_factor, 1.0 - y).unwrap();
                let computed = column.fields_after(seconds, y).unwrap();
                let difference = (computed.pressure - expected.pressure) / 3e3;
                assert!(difference.abs() < 1e-12, "{time_factor} {y}: {difference:e}");
                let difference = (computed.displacement - expected.displacement) / seed.final_settlement();
                assert!(difference.abs() < 1e-12, "{time_factor} {y}: {difference:e}");
            }
            assert!(mirrored.fields(time_factor, 1.0).unwrap().displacement.abs() < 1e-18);
            let settled = mirrored.settlement(time_factor).unwrap();
            assert!((mirrored.fields(time_factor, 0.0).unwrap().displacement + settled).abs() < 1e-18);
        }
    }
}
