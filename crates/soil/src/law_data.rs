//! What a law is: the stress that a strain makes, the conductivity that goes with it, and the column that it compresses.
//! Each law is a file in `laws/`.

use crate::elementary;
use crate::plasticity::{Components, PointState, Tangent};
use crate::stiffness::Stiffness;

/// A stress–strain law of the skeleton and the conductivity that goes with it.
#[derive(Clone, Copy, Debug)]
pub struct LawData {
    /// How the stress follows the strain.
    pub stress: Stress,
    /// How the conductivity follows the volume.
    pub conductivity: Conductivity,
    /// The uniaxial compression of a column in closed form; laws that have none are not of columns.
    pub uniaxial: Option<Uniaxial>,
}

/// How the stress follows the strain.
#[derive(Clone, Copy, Debug)]
pub enum Stress {
    /// By a rate against the logarithmic strain.
    Rate(Modulus),
    /// By the deformation gradient, as a neo-Hookean solid: no rate is integrated.
    NeoHookean,
    /// By a rate with two moduli: that of the initial state up to the largest stress so far, and that of first loading.
    Preconsolidated(SecantShare),
    /// By an update of all components with history variables.
    Yields(PointUpdate),
}

/// Secant modulus of a step over the initial one: of a vertical compression, Pa, its growth at the initial modulus, the modulus
/// of first loading over the initial one, and the yield stress, which it raises.
pub type SecantShare = fn(f64, f64, f64, &mut f64) -> f64;

/// The state after a strain increment, and the consistent tangent, Pa, for a stiffness and a shear strength, Pa.
pub type PointUpdate = fn(&Stiffness, f64, &PointState, &Components) -> (PointState, Tangent);

/// Modulus over the initial one against the logarithmic strain `dJ/J`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modulus {
    /// 1.
    Constant,
    /// `1/J`.
    InverseOfVolume,
}

/// Conductivity over the initial one at a volume ratio `J`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conductivity {
    /// 1.
    Constant,
    /// `J²`.
    SquareOfVolume,
}

/// A uniaxial compression to the engineering strain `J − 1`.
#[derive(Clone, Copy, Debug)]
pub struct Uniaxial {
    /// Vertical effective stress over the oedometric modulus: the integral of the rate form.
    pub stress_ratio: fn(f64) -> f64,
    /// The strain at which a compression `−σ'/E_oed` is reached: the inverse.
    pub strain_under: fn(f64) -> f64,
    /// Kirchhoff's potential `Φ`, `dΦ = κ dσ'` over `k_0 E_oed` with `κ = k/J`, zero in the initial state.
    pub flow_potential: fn(f64) -> f64,
}

/// `σ' = E_oed ln J`, of a constant modulus against the logarithmic strain.
pub(crate) fn logarithm(strain: f64) -> f64 {
    elementary::ln_1p(strain)
}

/// Its inverse.
pub(crate) fn exponential(compression: f64) -> f64 {
    elementary::exp_m1(-compression)
}
