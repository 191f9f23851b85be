//! Saturated soil: its parameters and what follows from them.

use crate::conductivity::ConductivityMean;
use crate::continuity::Continuity;
use crate::elementary;
use crate::law::{Law, StressLaw};
use crate::stiffness::Stiffness;
use oedometer_wording::is_default;
use serde::{Deserialize, Serialize};

/// Parameters of the saturated soil in its initial state, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Material {
    /// Stress–strain law.
    pub law: Law,
    /// Young's modulus `E` of the skeleton, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio `ν` of the skeleton.
    pub poissons_ratio: f64,
    /// Initial porosity `n_0`.
    pub porosity: f64,
    /// Density `ρ_s` of the grains, kg/m³.
    pub grain_density: f64,
    /// Density `ρ_w` of the water, kg/m³.
    pub water_density: f64,
    /// Bulk modulus `K_w` of the water, Pa.
    pub water_bulk_modulus: f64,
    /// Initial hydraulic conductivity `k_0`, m/s.
    pub hydraulic_conductivity: f64,
    /// Gravity in the drag's unit weight of water, m/s².
    pub gravity: f64,
    /// Continuity equation.
    pub continuity: Continuity,
    /// Mean of the conductivity at a node. Left out of the identity of a case where it is the paper's.
    #[serde(default, skip_serializing_if = "is_default")]
    pub conductivity_mean: ConductivityMean,
    /// Oedometric modulus of unloading and reloading, Pa, of a preconsolidated soil; zero of others.
    #[serde(default, skip_serializing_if = "is_default")]
    pub reload_modulus: f64,
    /// Largest vertical effective stress so far, Pa, of a preconsolidated soil; zero of others.
    #[serde(default, skip_serializing_if = "is_default")]
    pub preconsolidation: f64,
    /// Undrained shear strength `c_u`, Pa, of a soil that yields by von Mises' condition; zero of others.
    #[serde(default, skip_serializing_if = "is_default")]
    pub undrained_strength: f64,
}

impl Default for Material {
    /// The seed column of Zheng et al. (2021).
    #[inline]
    fn default() -> Self {
        Self {
            law: Law::Linear,
            youngs_modulus: 1e6,
            poissons_ratio: 0.25,
            porosity: 0.3,
            grain_density: 2650.0,
            water_density: 1000.0,
            water_bulk_modulus: 2.2e9,
            hydraulic_conductivity: 1e-4,
            gravity: 9.81,
            continuity: Continuity::Conservative,
            conductivity_mean: ConductivityMean::Points,
            reload_modulus: 0.0,
            preconsolidation: 0.0,
            undrained_strength: 0.0,
        }
    }
}

impl Material {
    /// `E_oed = E(1−ν)/((1+ν)(1−2ν))`, Pa.
    #[inline]
    pub fn oedometric_modulus(&self) -> f64 {
        let nu = self.poissons_ratio;
        self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Coupling modulus `Q = K_w/n_0`, Pa.
    #[inline]
    pub fn coupling_modulus(&self) -> f64 {
        self.water_bulk_modulus / self.porosity
    }

    /// Unit weight of water `γ_w`, N/m³.
    #[inline]
    pub fn unit_weight_of_water(&self) -> f64 {
        self.water_density * self.gravity
    }

    /// Density of the saturated mixture at the initial porosity, `(1 − n)ρ_s + nρ_w`, kg/m³.
    pub fn mixture_density(&self) -> f64 {
        (1.0 - self.porosity) * self.grain_density + self.porosity * self.water_density
    }

    /// `c_v = k_0 E_oed/γ_w`, m²/s.
    #[inline]
    pub fn coefficient_of_consolidation(&self) -> f64 {
        self.hydraulic_conductivity * self.oedometric_modulus() / self.unit_weight_of_water()
    }

    /// Porosity at volume ratio `J`: `n = 1 − (1 − n_0)/J` (docs/theory.md, Eq. 5).
    #[inline]
    pub fn porosity_at(&self, volume_ratio: f64) -> f64 {
        1.0 - (1.0 - self.porosity) / volume_ratio
    }

    /// Pore pressure, Pa, of the undrained water at the engineering strain `J − 1`:
    /// `ṗ = −(K_w/n) J̇/J` with `nJ = J − (1 − n_0)` integrates to `−K_w ln(nJ/n_0)`.
    #[inline]
    pub fn undrained_pressure_at(&self, strain: f64) -> f64 {
        -self.water_bulk_modulus * elementary::ln_1p(strain / self.porosity)
    }

    /// The law with its stiffness, by which stresses are updated.
    #[inline]
    pub fn stress_law(&self) -> StressLaw {
        StressLaw {
            stress: self.law.data().stress,
            stiffness: self.stiffness(),
            virgin_share: 1.0 / self.stiffening(),
            strength: self.undrained_strength,
        }
    }

    /// Oedometric modulus of the initial state over that of first loading: above 1 where the soil is preconsolidated.
    fn stiffening(&self) -> f64 {
        if self.law.is_preconsolidated() { self.reload_modulus / self.oedometric_modulus() } else { 1.0 }
    }

    /// Oedometric modulus of the initial state, Pa, the largest that the soil has: that of reloading if the soil is
    /// preconsolidated.
    #[inline]
    pub fn initial_modulus(&self) -> f64 {
        self.oedometric_modulus() * self.stiffening()
    }

    /// Isotropic stiffness in the initial state.
    #[inline]
    pub fn stiffness(&self) -> Stiffness {
        if self.law.is_preconsolidated() {
            let first_loading = Self { law: Law::Linear, ..*self }.stiffness();
            let stiffening = self.stiffening();
            return Stiffness {
                lame: stiffening * first_loading.lame,
                shear: stiffening * first_loading.shear,
            };
        }
        let shear = self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio));
        Stiffness { lame: self.oedometric_modulus() - 2.0 * shear, shear }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seed_column_has_the_published_groups() {
        let soil = Material::default();
        assert!((soil.oedometric_modulus() - 1.2e6).abs() < 1e-6);
        assert!((1.0 / soil.coefficient_of_consolidation() - 81.75).abs() < 1e-10, "T_v = 1 at 81.75 s");
    }

    #[test]
    fn conductivity_falls_with_the_square_of_the_volume_but_for_laws_of_small_strain() {
        for law in Law::ALL {
            let is_constant = matches!(law, Law::Linear | Law::Preconsolidated | Law::VonMises);
            let expected = if is_constant { 1e-4 } else { 0.64e-4 };
            assert!((law.conductivity(1e-4, 0.8) / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn porosity_follows_the_volume_ratio() {
        let soil = Material::default();
        assert!((soil.porosity_at(1.0) - 0.3).abs() < 1e-15);
        // Half the pores gone: J = 1 − n_0/2.
        assert!((soil.porosity_at(0.85) - 0.15 / 0.85).abs() < 1e-15);
    }
}
