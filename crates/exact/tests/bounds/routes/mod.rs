//! Second routes to the problems, in numbers of 31 digits.

pub mod bodies;
pub mod columns;
pub mod layer;
pub mod waves;

use crate::double::{Double, ONE, d};
use oedometer_exact::{ColumnParameters, TextbookParameters};

/// A soil of Biot's equations.
#[derive(Clone, Copy)]
pub struct Biot {
    /// `E_oed`, `G`, `K` and Lamé's `λ`, Pa.
    pub modulus: Double,
    pub shear: Double,
    pub bulk: Double,
    pub lame: Double,
    pub alpha: Double,
    /// `1/M` and `S`, 1/Pa.
    pub fixed: Double,
    pub storage: Double,
}

impl Biot {
    pub fn new(column: &ColumnParameters) -> Self {
        let soil = &column.soil;
        let (young, nu, n) = (d(soil.youngs_modulus), d(soil.poissons_ratio), d(soil.porosity));
        let two = d(2.0);
        let modulus = young * (ONE - nu) / ((ONE + nu) * (ONE - two * nu));
        let (shear, bulk) = (young / (two * (ONE + nu)), young / (d(3.0) * (ONE - two * nu)));
        let (alpha, compliance) = match (column.textbook.biot_coefficient, column.textbook.grain_bulk_modulus)
        {
            (None, None) => (ONE, d(0.0)),
            (Some(alpha), None) => (d(alpha), (ONE - d(alpha)) / bulk),
            (None, Some(grains)) => (ONE - bulk / d(grains), ONE / d(grains)),
            (Some(alpha), Some(grains)) => (d(alpha), ONE / d(grains)),
        };
        let fixed = n / d(soil.water_bulk_modulus) + (alpha - n) * compliance;
        let storage = fixed + alpha * alpha / modulus;
        Self { modulus, shear, bulk, lame: modulus - two * shear, alpha, fixed, storage }
    }

    /// Incompressible water and grains.
    pub fn incompressible(column: &ColumnParameters) -> Self {
        let soil = Self::new(&ColumnParameters { textbook: TextbookParameters::default(), ..*column });
        Self { fixed: d(0.0), alpha: ONE, storage: ONE / soil.modulus, ..soil }
    }

    /// `c/c_v`.
    pub fn diffusivity_ratio(&self) -> Double {
        ONE / (self.modulus * self.storage)
    }
}

/// `k/γ_w`.
pub fn mobility(column: &ColumnParameters) -> Double {
    let soil = &column.soil;
    d(soil.hydraulic_conductivity) / (d(soil.water_density) * d(soil.gravity))
}

/// Seconds of a time factor.
pub fn seconds(column: &ColumnParameters, time_factor: f64) -> Double {
    let height = d(column.height);
    d(time_factor) * height * height / (mobility(column) * Biot::new(column).modulus)
}
