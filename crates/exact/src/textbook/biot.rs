//! Terzaghi's column of a soil with a Biot coefficient and grains of finite stiffness.

use crate::consolidation::{consolidated_below, isochrone};
use crate::exact_error::ExactError;
use crate::inputs::{BIOT_KEYS, COLUMN_KEYS};
use crate::parameters::ColumnParameters;
use crate::porous_soil::PorousSoil;
use crate::solution::{Accuracy, FieldValues, Solution};

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, BIOT_KEYS];

/// Column on an impermeable base, drained and loaded at its top (Biot 1941; Detournay & Cheng 1993, section 5.2).
///
/// ```text
/// p = p_0 W(ζ, ct/H²)     p_0 = q α/(E_oed S)     s = m_v q H [1/(M S) + (1 − 1/(M S)) U(ct/H²)]
/// ```
///
/// `α = 1` and stiff grains make it [`Terzaghi`](crate::terzaghi::Terzaghi)'s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiotColumn {
    load: f64,
    final_settlement: f64,
    soil: PorousSoil,
    /// `p_0/q`.
    start: f64,
    /// `1/(M S)`: the share of the settlement that is there at once.
    immediate: f64,
}

impl BiotColumn {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let soil = PorousSoil::new(parameters)?;
        Ok(Self {
            load: parameters.load,
            final_settlement: parameters.final_settlement(),
            soil,
            start: soil.alpha * soil.diffusivity_ratio(),
            immediate: soil.fixed_storage / soil.storage,
        })
    }

    /// Settlement of the part below a depth, over the final one of the whole.
    fn compressed(&self, time_factor: f64, zeta: f64) -> Result<f64, ExactError> {
        let consolidated = consolidated_below(zeta, self.soil.diffusivity_ratio() * time_factor)?.value;
        Ok(self.immediate * (1.0 - zeta) + (1.0 - self.immediate) * consolidated)
    }
}

impl Solution for BiotColumn {
    /// The effective stress is Biot's, `σ + α p`.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let pressure =
            self.load * self.start * isochrone(zeta, self.soil.diffusivity_ratio() * time_factor)?.value;
        Ok(FieldValues {
            pressure,
            effective_stress: self.soil.alpha * pressure - self.load,
            displacement: -self.final_settlement * self.compressed(time_factor, zeta)?,
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.final_settlement * self.compressed(time_factor, 0.0)?)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.final_settlement)
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let base = isochrone(1.0, self.soil.diffusivity_ratio() * time_factor)?;
        Ok(Accuracy::new(base.terms, self.start * base.tail_bound))
    }
}
