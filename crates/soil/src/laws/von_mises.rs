//! `von-mises`: linear elasticity, perfect plasticity of von Mises by radial return (Wilkins 1964), and constant conductivity.
//!
//! In plane strain isochoric flow ends with `s_zz = 0`, where the condition `|s| = √2 k` becomes that of Tresca,
//! `σ_1 − σ_3 = 2 k`, so the shear strength `k` is the undrained shear strength `c_u`.

use crate::law_data::{Conductivity, LawData, Stress};
use crate::plasticity::{Components, PointLaw, PointState, Tangent, UNIT, contraction, deviator, mean};
use crate::stiffness::Stiffness;

/// The law `von-mises`.
pub static VON_MISES: LawData =
    LawData { stress: Stress::Yields(update), conductivity: Conductivity::Constant, uniaxial: None };

fn update(
    stiffness: &Stiffness,
    strength: f64,
    state: &PointState,
    strain: &Components,
) -> (PointState, Tangent) {
    VonMises { stiffness: *stiffness, strength }.update(state, strain)
}

/// The law with the parameters of a soil.
#[derive(Clone, Copy, Debug, PartialEq)]
struct VonMises {
    /// Elastic stiffness.
    stiffness: Stiffness,
    /// Shear strength `k`, Pa.
    strength: f64,
}

impl PointLaw for VonMises {
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent) {
        let (trial, elastic) = self.stiffness.update(state, strain);
        let shear = deviator(&trial.stress);
        let (size, most) = (contraction(&shear, &shear).sqrt(), std::f64::consts::SQRT_2 * self.strength);
        if size <= most {
            return (trial, elastic);
        }
        let (share, mean) = (most / size, mean(&trial.stress));
        let stress = std::array::from_fn(|i| share * shear[i] + mean * UNIT[i]);
        let flow = (size - most) / (2.0 * self.stiffness.shear);
        let plastic_strain = trial.plastic_strain + (2.0_f64 / 3.0).sqrt() * flow;
        let direction = shear.map(|component| component / size);
        let tangent = self.stiffness.tangent(share, share, &direction);
        (PointState { stress, plastic_strain, ..trial }, tangent)
    }
}

#[cfg(test)]
mod tests;
