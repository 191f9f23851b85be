//! `porosity-dependent`: the modulus `E = E_0/J` in the rate form, `dσ' = (E_oed/J) dJ/J`, so `σ' = E_oed (1 − 1/J)`
//! (docs/theory.md, Eq. 7), and `k = k_0 J²`: Zheng et al. Eqs 7 and 8, taken as rates.

use crate::elementary;
use crate::law_data::{Conductivity, LawData, Modulus, Stress, Uniaxial};

/// The law `porosity-dependent`.
pub static POROSITY_DEPENDENT: LawData = LawData {
    stress: Stress::Rate(Modulus::InverseOfVolume),
    conductivity: Conductivity::SquareOfVolume,
    uniaxial: Some(Uniaxial {
        stress_ratio: |strain| strain / (1.0 + strain),
        strain_under: |compression| -compression / (1.0 + compression),
        // κ = J, dσ' = dJ/J²
        flow_potential: |strain| elementary::ln_1p(strain),
    }),
};
