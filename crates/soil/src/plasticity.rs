//! Laws with a memory at a point, in all components that a plane problem strains: elastic-plastic soil, small strain.
//!
//! Components stand in the order `xx, yy, zz, xy`, and `xy` is that of the tensor, half the engineering shear strain.
//! Stresses are tension positive. A law is one type that implements [`PointLaw`].

use crate::law::Stiffness;
use std::fmt::Debug;

/// Components `xx, yy, zz, xy` of a symmetric tensor.
pub type Components = [f64; 4];

/// Derivatives of the stress components by the strain components, Pa.
pub type Tangent = [Components; 4];

/// The unit tensor.
const UNIT: Components = [1.0, 1.0, 1.0, 0.0];
/// Times that each component stands in a tensor.
const MULTIPLICITY: Components = [1.0, 1.0, 1.0, 2.0];

/// What a soil remembers at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointState {
    /// Effective stress, Pa.
    pub stress: Components,
    /// Stress at which the soil yields now, Pa, where that changes.
    pub yield_stress: f64,
    /// Equivalent plastic strain so far.
    pub plastic_strain: f64,
}

/// A stress–strain law at a point.
///
/// A law of one's own is one type; docs/laws.md has a whole one, Drucker & Prager's.
pub trait PointLaw: Debug + Send + Sync {
    /// Takes an accepted state through a strain increment; the new state, and the derivative of its stress by the
    /// increment (the consistent tangent of Simo & Taylor 1985), with which Newton's iteration converges quadratically.
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent);
}

/// The page on laws, whose example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/laws.md")]
struct LawsOfOnesOwn;

/// `a : b`.
#[inline]
pub fn contraction(a: &Components, b: &Components) -> f64 {
    (0..4).map(|i| MULTIPLICITY[i] * a[i] * b[i]).sum()
}

/// Mean of the normal components.
#[inline]
pub fn mean(tensor: &Components) -> f64 {
    (tensor[0] + tensor[1] + tensor[2]) / 3.0
}

/// What is left of a tensor without its mean.
#[inline]
pub fn deviator(tensor: &Components) -> Components {
    let mean = mean(tensor);
    std::array::from_fn(|i| tensor[i] - mean * UNIT[i])
}

impl Stiffness {
    /// Bulk modulus, Pa.
    #[inline]
    pub fn bulk(&self) -> f64 {
        self.lame + 2.0 / 3.0 * self.shear
    }

    /// Stress of an elastic strain, Pa.
    #[inline]
    pub fn stress_of(&self, strain: &Components) -> Components {
        let volumetric = 3.0 * self.lame * mean(strain);
        std::array::from_fn(|i| 2.0 * self.shear * strain[i] + volumetric * UNIT[i])
    }

    /// `K 1 ⊗ 1 + 2 G (shear_share I_dev − direction_share n ⊗ n)` for a unit deviator `n`: the tangent of every isotropic
    /// law whose plastic strain keeps the volume; the elastic one with the shares 1 and 0.
    #[inline]
    pub fn tangent(&self, shear_share: f64, direction_share: f64, direction: &Components) -> Tangent {
        let (bulk, twice_shear) = (self.bulk(), 2.0 * self.shear);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let kept = if i == j { 1.0 } else { 0.0 };
                let deviatoric = kept - UNIT[i] * UNIT[j] / 3.0;
                let along = direction[i] * direction[j] * MULTIPLICITY[j];
                bulk * UNIT[i] * UNIT[j] + twice_shear * (shear_share * deviatoric - direction_share * along)
            })
        })
    }
}

/// An elastic soil without a memory.
impl PointLaw for Stiffness {
    #[inline]
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent) {
        let change = self.stress_of(strain);
        let stress = std::array::from_fn(|i| state.stress[i] + change[i]);
        (PointState { stress, ..*state }, self.tangent(1.0, 0.0, &[0.0; 4]))
    }
}

/// Linear elasticity, and perfect plasticity of von Mises by radial return (Wilkins 1964).
///
/// In plane strain a flow that keeps the volume ends with `s_zz = 0`, where the condition `|s| = √2 k` is that of Tresca,
/// `σ_1 − σ_3 = 2 k`: `k` is the undrained shear strength `c_u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMises {
    /// Elastic stiffness.
    pub stiffness: Stiffness,
    /// Shear strength `k`, Pa.
    pub strength: f64,
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
