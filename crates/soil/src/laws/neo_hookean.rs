//! `neo-hookean`: hyperelastic, `σ' = [μ (F Fᵀ − I) + λ ln J I]/J` (Simo & Pister 1984; docs/theory.md, Eq. 28), and
//! `k = k_0 J²`: a stress that no path through shear or rotation changes. In a column it depends on Poisson's ratio.

use crate::law_data::{Conductivity, LawData, Stress};

/// The law `neo-hookean`.
pub static NEO_HOOKEAN: LawData =
    LawData { stress: Stress::NeoHookean, conductivity: Conductivity::SquareOfVolume, uniaxial: None };
