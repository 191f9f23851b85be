//! Saturated soil: its parameters, the stiffness of the skeleton and the drag of the water.

use super::grid::Tensor;
use serde::{Deserialize, Serialize};

/// Stress–strain law of the skeleton and the conductivity that goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Constant modulus and conductivity.
    Linear,
    /// Constant modulus against logarithmic strain, `k = k_0 J²`: the material of Xie & Leo (2004).
    LogLinear,
}

/// Continuity equation of the mixture (theory: (4) and (4')).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Continuity {
    /// `dp/dt = −(K_w/n)[∇·v_s + ∇·(n(v_w − v_s))]`: conserves water.
    Conservative,
    /// `dp/dt = −(K_w/n)[(1−n)∇·v_s + n∇·v_w]`: Zheng et al. (2021), Eq. 6, drops `(v_w − v_s)·∇n`.
    ConstantPorosityGradient,
}

/// Parameters of the saturated soil in its initial state, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
}

impl Default for Material {
    /// The seed column of Zheng et al. (2021).
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
        }
    }
}

impl Material {
    /// `E_oed = E(1−ν)/((1+ν)(1−2ν))`, Pa.
    pub fn oedometric_modulus(&self) -> f64 {
        let nu = self.poissons_ratio;
        self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Coupling modulus `Q = K_w/n_0`, Pa.
    pub fn coupling_modulus(&self) -> f64 {
        self.water_bulk_modulus / self.porosity
    }

    /// Unit weight of water `γ_w`, N/m³.
    pub fn unit_weight_of_water(&self) -> f64 {
        self.water_density * self.gravity
    }

    /// `c_v = k_0 E_oed/γ_w`, m²/s.
    pub fn coefficient_of_consolidation(&self) -> f64 {
        self.hydraulic_conductivity * self.oedometric_modulus() / self.unit_weight_of_water()
    }

    /// Porosity at volume ratio `J`: the grains are incompressible, `1 − n = (1 − n_0)/J`.
    #[inline]
    pub fn porosity_at(&self, volume_ratio: f64) -> f64 {
        1.0 - (1.0 - self.porosity) / volume_ratio
    }

    /// Hydraulic conductivity at volume ratio `J`, m/s.
    #[inline]
    pub fn hydraulic_conductivity_at(&self, volume_ratio: f64) -> f64 {
        match self.law {
            Law::Linear => self.hydraulic_conductivity,
            Law::LogLinear => self.hydraulic_conductivity * volume_ratio * volume_ratio,
        }
    }

    /// The skeleton's stiffness as the stress update uses it.
    pub fn stiffness(&self) -> Stiffness {
        let shear = self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio));
        Stiffness { lame: self.oedometric_modulus() - 2.0 * shear, shear }
    }
}

/// Isotropic elastic stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Lamé's first parameter `λ`, Pa.
    pub lame: f64,
    /// Shear modulus `G`, Pa.
    pub shear: f64,
}

impl Stiffness {
    /// Stress of a small strain whose lateral parts vanish in the directions left out:
    /// `λ tr(ε) I + 2 G ε` with `ε = sym` of the given displacement gradient.
    #[inline]
    pub fn stress<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D> {
        let volumetric: f64 = (0..D).map(|d| gradient[d][d]).sum();
        let mut stress = [[0.0; D]; D];
        for i in 0..D {
            for j in 0..D {
                stress[i][j] = self.shear * (gradient[i][j] + gradient[j][i]);
            }
            stress[i][i] += self.lame * volumetric;
        }
        stress
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
    fn a_uniaxial_strain_meets_the_oedometric_modulus() {
        let soil = Material { poissons_ratio: 0.31, ..Material::default() };
        let expected = soil.oedometric_modulus() * 1e-3;
        assert!((soil.stiffness().stress(&[[1e-3]])[0][0] / expected - 1.0).abs() < 1e-14);
        let plane = soil.stiffness().stress(&[[0.0, 0.0], [0.0, 1e-3]]);
        assert!((plane[1][1] / expected - 1.0).abs() < 1e-14);
        let lateral = plane[0][0] / plane[1][1];
        assert!((lateral - 0.31 / 0.69).abs() < 1e-14, "earth pressure at rest ν/(1−ν)");
    }

    #[test]
    fn porosity_follows_the_volume_ratio() {
        let soil = Material::default();
        assert!((soil.porosity_at(1.0) - 0.3).abs() < 1e-15);
        // Half the pores gone: J = 1 − n_0/2.
        assert!((soil.porosity_at(0.85) - 0.15 / 0.85).abs() < 1e-15);
    }
}
