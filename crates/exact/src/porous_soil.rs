//! Parameters of a soil in Biot's full equations: its moduli, a Biot coefficient and grains of finite stiffness.

use crate::exact_error::{ExactError, normal, positive};
use crate::parameters::ColumnParameters;
use oedometer_soil::material::Material;

/// Name in messages.
const GRAINS: &str = "bulk modulus of the grains";

/// Parameters of a soil in Biot's equations (Biot 1941; Detournay & Cheng 1993, section 3).
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
    /// The soil of a column with its textbook parameters.
    ///
    /// # Errors
    /// When `α` lies outside `[n, 1]` or `K_s` is not positive.
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let ColumnParameters { soil, textbook, .. } = *parameters;
        let Material { youngs_modulus, poissons_ratio, porosity, .. } = soil;
        let shear = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
        let bulk = youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio));
        let (alpha, compliance) = match (textbook.biot_coefficient, textbook.grain_bulk_modulus) {
            (None, None) => (1.0, 0.0),
            (Some(alpha), None) => (alpha, (1.0 - alpha) / bulk),
            (None, Some(grains)) => (1.0 - bulk / grains, 1.0 / positive(GRAINS, grains)?),
            (Some(alpha), Some(grains)) => (alpha, 1.0 / positive(GRAINS, grains)?),
        };
        if let Some(grains) = textbook.grain_bulk_modulus.filter(|grains| *grains < bulk) {
            return Err(ExactError::SoftGrains { grains, bulk });
        }
        if !(porosity..=1.0).contains(&alpha) {
            return Err(ExactError::BiotCoefficient { alpha, porosity });
        }
        let modulus = parameters.soil.oedometric_modulus();
        let fixed_storage = porosity / parameters.soil.water_bulk_modulus + (alpha - porosity) * compliance;
        let storage = normal("storage", fixed_storage + alpha * alpha / modulus)?;
        Ok(Self { modulus, shear, bulk, alpha, fixed_storage, storage })
    }

    /// Diffusivity `c = k/(γ_w S)` over the drained coefficient of consolidation `c_v`.
    pub fn diffusivity_ratio(&self) -> f64 {
        1.0 / (self.modulus * self.storage)
    }
}
