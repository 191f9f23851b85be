//! Saturated soil: its parameters, the stiffness of the skeleton and the drag of the water.

use crate::elementary;
use crate::soil::tensor::Tensor;
use serde::{Deserialize, Serialize};

/// Stress–strain law of the skeleton and the conductivity that goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Constant modulus and conductivity.
    Linear,
    /// Constant modulus against logarithmic strain, `σ' = E_oed ln J`, and `k = k_0 J²`: the
    /// material of Xie & Leo (2004).
    LogLinear,
    /// The modulus `E = E_0/J` in the rate form, `dσ' = (E_oed/J) dJ/J`, so `σ' = E_oed (1 − 1/J)`,
    /// and `k = k_0 J²`: Zheng et al. (2021), Eqs 7 and 8, taken as rates.
    PorosityDependent,
    /// The same modulus `E = E_0/J` with the engineering strain that it belongs to,
    /// `dσ' = (E_oed/J) dJ`, and `k = k_0 J²`: the material of Xie & Leo by another way.
    Engineering,
}

impl Law {
    /// Every law, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Linear, Self::LogLinear, Self::PorosityDependent, Self::Engineering];

    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::LogLinear => "log-linear",
            Self::PorosityDependent => "porosity-dependent",
            Self::Engineering => "engineering",
        }
    }

    /// Modulus over the initial one against the logarithmic strain `dJ/J` of the rate form, over
    /// a step from one volume ratio to another: at their geometric mean, of second order.
    #[inline]
    pub fn modulus_ratio(self, before: f64, after: f64) -> f64 {
        match self {
            // The engineering law has E_0/J against dJ, and that is E_0 against dJ/J.
            Self::Linear | Self::LogLinear | Self::Engineering => 1.0,
            Self::PorosityDependent => 1.0 / (before * after).sqrt(),
        }
    }

    /// Vertical effective stress over the oedometric modulus of a uniaxial compression to the
    /// engineering strain `J − 1`, which may be tiny: the integral of the rate form.
    pub fn uniaxial_stress_ratio(self, strain: f64) -> f64 {
        match self {
            Self::Linear | Self::LogLinear | Self::Engineering => elementary::ln_1p(strain),
            Self::PorosityDependent => strain / (1.0 + strain),
        }
    }
}

/// Continuity equation of the mixture (theory: (4) and (4')).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Continuity {
    /// `dp/dt = −(K_w/n)[∇·v_s + ∇·(n(v_w − v_s))]`: conserves water.
    Conservative,
    /// `dp/dt = −(K_w/n)[(1−n)∇·v_s + n∇·v_w]`: Zheng et al. (2021), Eq. 6, drops `(v_w − v_s)·∇n`.
    ConstantPorosityGradient,
}

impl Continuity {
    /// Both, the one that conserves water first.
    pub const ALL: [Self; 2] = [Self::Conservative, Self::ConstantPorosityGradient];

    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Conservative => "conservative",
            Self::ConstantPorosityGradient => "constant-porosity-gradient",
        }
    }
}

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
            Law::LogLinear | Law::PorosityDependent | Law::Engineering => {
                self.hydraulic_conductivity * volume_ratio * volume_ratio
            }
        }
    }

    /// Pore pressure, Pa, of the undrained water at the engineering strain `J − 1`:
    /// `ṗ = −(K_w/n) J̇/J` with `nJ = J − (1 − n_0)` integrates to `−K_w ln(nJ/n_0)`.
    pub fn undrained_pressure_at(&self, strain: f64) -> f64 {
        -self.water_bulk_modulus * elementary::ln_1p(strain / self.porosity)
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

    /// Normal stress that the gradient `(b/D) I` of B-bar lacks: the volume `b` that B-bar adds to a
    /// strain is shared by three directions, `b/3` each (Hughes 1980, Eq. 12), in whatever dimension
    /// the problem is solved.
    #[inline]
    pub fn shared_dilation_stress<const D: usize>(&self, dilation: f64) -> f64 {
        2.0 * self.shear * dilation * (1.0 / 3.0 - 1.0 / D as f64)
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
    fn conductivity_falls_with_the_square_of_the_volume_but_for_the_linear_law() {
        for law in Law::ALL {
            let soil = Material { law, ..Material::default() };
            let expected = if law == Law::Linear { 1e-4 } else { 0.64e-4 };
            assert!((soil.hydraulic_conductivity_at(0.8) / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_published_modulus_belongs_to_engineering_strain() {
        // Under q/E_oed = 1/6 the two readings of Eq. 8 end apart (theory, section 3).
        let end = |law: Law| {
            let (mut low, mut high): (f64, f64) = (0.5, 1.0);
            while high - low > 1e-15 {
                let middle = 0.5 * (low + high);
                if law.uniaxial_stress_ratio(middle - 1.0) < -1.0 / 6.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            1.0 - low
        };
        assert!((end(Law::Engineering) - 0.153_518_275_1).abs() < 1e-9);
        assert!((end(Law::PorosityDependent) - 1.0 / 7.0).abs() < 1e-9);
    }

    proptest::proptest! {
        #[test]
        fn the_rate_form_integrates_to_the_closed_form(end in 0.6..1.4_f64) {
            let steps = 20_000;
            let strain = end.ln() / f64::from(steps);
            for law in Law::ALL {
                let (mut ratio, mut stress) = (1.0, 0.0);
                for _ in 0..steps {
                    let before = ratio;
                    ratio *= strain.exp();
                    stress += law.modulus_ratio(before, ratio) * strain;
                }
                let closed = law.uniaxial_stress_ratio(end - 1.0);
                proptest::prop_assert!((stress - closed).abs() < 1e-9, "{law:?}: {stress} for {closed}");
            }
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
