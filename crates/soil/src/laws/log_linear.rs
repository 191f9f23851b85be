//! `log-linear`: constant modulus against logarithmic strain, `σ' = E_oed ln J` (docs/theory.md, Eq. 6), and `k = k_0 J²`:
//! the material of Xie & Leo (2004).

use crate::law_data::{Conductivity, LawData, Modulus, Stress, Uniaxial, exponential, logarithm};

/// The law `log-linear`.
pub static LOG_LINEAR: LawData = LawData {
    stress: Stress::Rate(Modulus::Constant),
    conductivity: Conductivity::SquareOfVolume,
    uniaxial: Some(Uniaxial {
        stress_ratio: logarithm,
        strain_under: exponential,
        // κ = J, dσ' = dJ/J
        flow_potential: |strain| strain,
    }),
};
