//! Laws with history variables at a point, in all four components of plane strain: elastic-plastic soil, small strain.
//!
//! Components are ordered `xx, yy, zz, xy`; `xy` is that of the tensor, half the engineering shear strain.
//! Stresses are tension positive. A law is a type that implements [`PointLaw`].

use std::fmt::Debug;

/// Components `xx, yy, zz, xy` of a symmetric tensor.
pub type Components = [f64; 4];

/// Derivatives of the stress components by the strain components, Pa.
pub type Tangent = [Components; 4];

/// The unit tensor.
pub(crate) const UNIT: Components = [1.0, 1.0, 1.0, 0.0];
/// Number of times that each component occurs in the full tensor.
pub(crate) const MULTIPLICITY: Components = [1.0, 1.0, 1.0, 2.0];

/// Stress and history variables of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointState {
    /// Effective stress, Pa.
    pub stress: Components,
    /// Present yield stress, Pa, for laws that harden or soften.
    pub yield_stress: f64,
    /// Equivalent plastic strain so far.
    pub plastic_strain: f64,
}

/// A stress–strain law at a point.
///
/// docs/dev/laws.md has a complete example, Drucker & Prager's law.
pub trait PointLaw: Debug + Send + Sync {
    /// The state after a strain increment from an accepted state, and the derivative of its stress by the increment (the
    /// consistent tangent of Simo & Taylor 1985), with which Newton's iteration converges quadratically.
    fn update(&self, state: &PointState, strain: &Components) -> (PointState, Tangent);
}

/// The page on laws, whose example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/dev/laws.md")]
struct CustomLaws;

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

/// Deviatoric part of a tensor.
#[inline]
pub fn deviator(tensor: &Components) -> Components {
    let mean = mean(tensor);
    std::array::from_fn(|i| tensor[i] - mean * UNIT[i])
}
