//! The column and its material, as plain SI numbers.

use crate::exact_error::{ExactError, normal, positive};
pub use oedometer_soil::base::{Base, Drainage};
use oedometer_soil::layers::SoilLayers;
use oedometer_soil::material::Material;
pub use oedometer_soil::motion::MotionParameters;
use std::f64::consts::PI;

/// Whether the water itself can be compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Water {
    /// With the bulk modulus `K_w` of the column.
    Compressible,
    /// `K_w → ∞`.
    Incompressible,
}

/// Parameters beyond those of a column, for problems without a scene and the slab; each reads those in its `INPUTS`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextbookParameters {
    /// Biot coefficient `α`; without it `1 − K/K_s`, and 1 without both.
    pub biot_coefficient: Option<f64>,
    /// Bulk modulus of the grains `K_s`, Pa; without it `K/(1 − α)`, infinite where `α = 1`.
    pub grain_bulk_modulus: Option<f64>,
    /// Radius `r_w` of a drain, m.
    pub drain_radius: f64,
    /// Period of a wave, s.
    pub wave_period: f64,
    /// Vertical effective stress of the start, compression positive, Pa; without it that of the load.
    pub initial_stress: Option<f64>,
}

impl Default for TextbookParameters {
    fn default() -> Self {
        Self {
            biot_coefficient: None,
            grain_bulk_modulus: None,
            drain_radius: 0.05,
            wave_period: 10.0,
            initial_stress: None,
        }
    }
}

/// A saturated column of soil, loaded and drained at its top, on a base that is impermeable unless it is drained too.
///
/// The default is the seed column of Zheng et al. (2021, doi 10.1007/978-3-030-64514-4_88)
/// under a load of 1 Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnParameters {
    /// Initial height `H`, m.
    pub height: f64,
    /// Length `L` along the layer, m; a column has none and ignores it.
    pub length: f64,
    /// How a layer rests on its base; a column ignores it.
    pub base: Base,
    /// Which ends let the water out; only Terzaghi's, Xie & Leo's and layered columns and large strain in general heed it.
    pub drainage: Drainage,
    /// Load `q` on the top, compression positive, Pa.
    pub load: f64,
    /// Its soil; solutions in closed form heed its law and continuity only where they say so.
    pub soil: Material,
    /// Time over which the load grows linearly, s; 0 where it acts at once. The column with inertia
    /// and large strain in general heed it.
    pub loading_time: f64,
    /// Whether skeleton and water have a weight: the stress of the start is that of the buoyant skeleton, and
    /// pressures are those beyond the hydrostatic one.
    pub self_weight: bool,
    /// How a manufactured solution moves; nothing else heeds it.
    pub motion: MotionParameters,
    /// What problems of textbooks and the slab add; nothing else heeds it.
    pub textbook: TextbookParameters,
    /// Layers from the base up; only a layered column heeds them.
    pub soils: SoilLayers,
    /// Effective stress of the start, compression positive, Pa; only a yield front heeds it.
    pub uniform_stress: f64,
    /// Width of a rigid plate on a layer, m; only a footing heeds it.
    pub plate_width: f64,
}

impl Default for ColumnParameters {
    fn default() -> Self {
        Self {
            height: 1.0,
            length: 1.0,
            base: Base::Rough,
            drainage: Drainage::Top,
            load: 1.0,
            soil: Material::default(),
            loading_time: 0.0,
            self_weight: false,
            motion: MotionParameters::default(),
            textbook: TextbookParameters::default(),
            soils: SoilLayers::default(),
            uniform_stress: 0.0,
            plate_width: 0.0,
        }
    }
}

impl ColumnParameters {
    /// Share of an undrained load that the water carries, `B = Q/(Q + E_oed)`.
    pub fn storage_ratio(&self) -> f64 {
        let coupling = self.soil.coupling_modulus();
        coupling / (coupling + self.soil.oedometric_modulus())
    }

    /// `1 − B = E_oed/(Q + E_oed)`, free of cancellation: the immediate part of the settlement.
    pub fn immediate_ratio(&self) -> f64 {
        let modulus = self.soil.oedometric_modulus();
        modulus / (self.soil.coupling_modulus() + modulus)
    }

    /// Length of the water's way out, m: the height, or half of it where the base is drained.
    fn drainage_path(&self) -> f64 {
        match self.drainage {
            Drainage::Top => self.height,
            Drainage::Both => 0.5 * self.height,
        }
    }

    /// Time `t = T_v H²/c_v` of a time factor, s, with half the height where the base is drained; of a motion `ωt/π` is the
    /// factor.
    pub fn time(&self, time_factor: f64) -> f64 {
        if self.motion.frequency > 0.0 {
            return time_factor * (PI / self.motion.frequency);
        }
        let path = self.drainage_path();
        time_factor * path * path / self.soil.coefficient_of_consolidation()
    }

    /// Time factor `T_v = c_v t/H²` of a time in s, with half the height where the base is drained; of a motion `ωt/π`.
    pub fn time_factor(&self, time: f64) -> f64 {
        if self.motion.frequency > 0.0 {
            return time / (PI / self.motion.frequency);
        }
        let path = self.drainage_path();
        time * self.soil.coefficient_of_consolidation() / (path * path)
    }

    /// Settlement at the end of consolidation at small strain, `m_v q H`, m.
    pub fn final_settlement(&self) -> f64 {
        self.load * self.height / self.soil.oedometric_modulus()
    }

    /// Vertical effective stress of the start at a depth `ζ`, Pa, tension positive: of the buoyant weight above,
    /// `−(1 − n_0)(ρ_s − ρ_w) g H ζ`; none without weight.
    pub fn initial_stress(&self, zeta: f64) -> f64 {
        if !self.self_weight {
            return 0.0;
        }
        let soil = &self.soil;
        let buoyant = (1.0 - soil.porosity) * (soil.grain_density - soil.water_density) * soil.gravity;
        -buoyant * self.height * zeta
    }

    /// Checks that the numbers describe a possible column.
    ///
    /// # Errors
    /// When a quantity that must be positive and finite is not, the porosity is outside (0, 1) or
    /// Poisson's ratio outside (−1, ½).
    pub fn validate(&self) -> Result<(), ExactError> {
        let soil = &self.soil;
        positive("height", self.height)?;
        positive("load", self.load)?;
        positive("Young's modulus", soil.youngs_modulus)?;
        if !(soil.poissons_ratio > -1.0 && soil.poissons_ratio < 0.5) {
            return Err(ExactError::PoissonsRatio(soil.poissons_ratio));
        }
        if !(soil.porosity > 0.0 && soil.porosity < 1.0) {
            return Err(ExactError::Porosity(soil.porosity));
        }
        positive("grain density", soil.grain_density)?;
        positive("water density", soil.water_density)?;
        positive("bulk modulus of the water", soil.water_bulk_modulus)?;
        positive("hydraulic conductivity", soil.hydraulic_conductivity)?;
        positive("gravity", soil.gravity)?;
        // Positive factors may still overflow or underflow together.
        positive("oedometric modulus", soil.oedometric_modulus())?;
        positive("Biot modulus", soil.coupling_modulus())?;
        positive("coefficient of consolidation", soil.coefficient_of_consolidation())?;
        normal("time at a time factor of 1", self.time(1.0))?;
        // Numbers with few digits left make fields with few.
        normal("load", self.load)?;
        normal("final settlement", self.final_settlement())?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seed_column_has_the_published_groups() {
        let seed = ColumnParameters::default();
        assert!(seed.validate().is_ok());
        assert!((seed.soil.oedometric_modulus() - 1.2e6).abs() < 1e-9);
        assert!((seed.soil.coefficient_of_consolidation() - 0.012_232).abs() < 5e-7);
        assert!((seed.time(1.0) - 81.75).abs() < 5e-3);
        assert!((seed.time_factor(seed.time(0.3)) - 0.3).abs() < 1e-15);
        assert!((seed.storage_ratio() + seed.immediate_ratio() - 1.0).abs() < 1e-15);
        // One undrained element of the seed case under 1 kPa carries 999.84 Pa.
        assert!((seed.storage_ratio() * 1000.0 - 999.84).abs() < 5e-3);
    }

    #[test]
    fn impossible_columns_are_refused_in_sentences() {
        let refused = |change: fn(&mut ColumnParameters)| {
            let mut parameters = ColumnParameters::default();
            change(&mut parameters);
            parameters.validate().map_or_else(|error| error.to_string(), |()| String::new())
        };
        assert_eq!(refused(|c| c.soil.porosity = 1.2), "the porosity must lie between 0 and 1, got 1.2");
        assert_eq!(
            refused(|c| c.soil.poissons_ratio = 0.5),
            "Poisson's ratio must lie between -1 and 0.5, got 0.5"
        );
        assert_eq!(refused(|c| c.height = -1.0), "the height must be positive and finite, got -1");
        assert_eq!(refused(|c| c.load = f64::NAN), "the load must be positive and finite, got NaN");
        assert!(!refused(|c| c.soil.water_bulk_modulus = f64::INFINITY).is_empty());
        assert!(!refused(|c| c.soil.youngs_modulus = f64::MAX).is_empty());
        assert!(!refused(|c| c.soil.porosity = f64::NAN).is_empty());
    }
}
