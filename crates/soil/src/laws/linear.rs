//! `linear`: constant modulus and conductivity.

use crate::law_data::{Conductivity, LawData, Modulus, Stress, Uniaxial, exponential, logarithm};

/// The law `linear`.
pub static LINEAR: LawData = LawData {
    stress: Stress::Rate(Modulus::Constant),
    conductivity: Conductivity::Constant,
    uniaxial: Some(Uniaxial {
        stress_ratio: logarithm,
        strain_under: exponential,
        // κ = 1/J, dσ' = dJ/J
        flow_potential: |strain| strain / (1.0 + strain),
    }),
};
