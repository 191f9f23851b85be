//! Biot's full equations: a soil with a Biot coefficient and grains of finite stiffness, and Terzaghi's column of it.

use crate::consolidation::{consolidated_below, isochrone};
use crate::exact_error::{ExactError, normal, positive};
use crate::parameters::ColumnParameters;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::material::Material;

/// Name in messages.
const GRAINS: &str = "bulk modulus of the grains";

/// What Biot's equations take of a soil (Biot 1941; Detournay & Cheng 1993, section 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PorousSoil {
    /// Oedometric modulus `E_oed`, drained, Pa.
    pub modulus: f64,
    /// Shear modulus `G`, Pa.
    pub shear: f64,
    /// Bulk modulus `K`, drained, Pa.
    pub bulk: f64,
    /// Biot coefficient `α`.
    pub alpha: f64,
    /// `1/M = n/K_w + (α − n)/K_s`, 1/Pa.
    pub fixed_storage: f64,
    /// `S = 1/M + α²/E_oed`, 1/Pa.
    pub storage: f64,
}

impl PorousSoil {
    /// The soil of a column with what the shelf adds.
    ///
    /// # Errors
    /// When `α` lies outside `[n, 1]` or `K_s` is not positive.
    pub fn of(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let ColumnParameters { soil, shelf, .. } = *parameters;
        let Material { youngs_modulus, poissons_ratio, porosity, .. } = soil;
        let shear = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
        let bulk = youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio));
        let (alpha, compliance) = match (shelf.biot_coefficient, shelf.grain_bulk_modulus) {
            (None, None) => (1.0, 0.0),
            (Some(alpha), None) => (alpha, (1.0 - alpha) / bulk),
            (None, Some(grains)) => (1.0 - bulk / grains, 1.0 / positive(GRAINS, grains)?),
            (Some(alpha), Some(grains)) => (alpha, 1.0 / positive(GRAINS, grains)?),
        };
        if !(porosity..=1.0).contains(&alpha) {
            return Err(ExactError::BiotCoefficient { alpha, porosity });
        }
        let modulus = parameters.soil.oedometric_modulus();
        let fixed_storage = porosity / parameters.soil.water_bulk_modulus + (alpha - porosity) * compliance;
        let storage = normal("storage", fixed_storage + alpha * alpha / modulus)?;
        Ok(Self { modulus, shear, bulk, alpha, fixed_storage, storage })
    }

    /// Diffusivity `c = k/(γ_w S)` over the drained coefficient of consolidation `c_v`.
    pub fn slowed(&self) -> f64 {
        1.0 / (self.modulus * self.storage)
    }
}

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
        let soil = PorousSoil::of(parameters)?;
        Ok(Self {
            load: parameters.load,
            final_settlement: parameters.final_settlement(),
            soil,
            start: soil.alpha * soil.slowed(),
            immediate: soil.fixed_storage / soil.storage,
        })
    }

    /// Settlement of the part below a depth, over the final one of the whole.
    fn compressed(&self, time_factor: f64, zeta: f64) -> Result<f64, ExactError> {
        let consolidated = consolidated_below(zeta, self.soil.slowed() * time_factor)?.value;
        Ok(self.immediate * (1.0 - zeta) + (1.0 - self.immediate) * consolidated)
    }
}

impl Solution for BiotColumn {
    /// The effective stress is Biot's, `σ + α p`.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let pressure = self.load * self.start * isochrone(zeta, self.soil.slowed() * time_factor)?.value;
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
        let base = isochrone(1.0, self.soil.slowed() * time_factor)?;
        Ok(Accuracy::of(base.terms, self.start * base.tail_bound))
    }
}
