//! `preconsolidated`: oedometric law with a memory: a constant modulus up to the largest effective stress so far, a lower one
//! for first loading beyond it, and constant conductivity (docs/theory.md, section 2).

use crate::law_data::{Conductivity, LawData, Stress};

/// The law `preconsolidated`.
pub static PRECONSOLIDATED: LawData = LawData {
    stress: Stress::Preconsolidated(secant_share),
    conductivity: Conductivity::Constant,
    uniaxial: None,
};

/// Secant modulus of a step over the initial modulus. The step starts at a vertical compression, Pa, that would grow by
/// `elastic` at the initial modulus; the part beyond the yield stress follows the modulus of first loading and raises
/// the yield stress with it. Exact for steps of any size.
#[inline]
fn secant_share(compression: f64, elastic: f64, virgin_share: f64, yield_stress: &mut f64) -> f64 {
    let beyond = elastic.min(compression + elastic - *yield_stress);
    if beyond <= 0.0 {
        return 1.0;
    }
    let gained = elastic - beyond + virgin_share * beyond;
    *yield_stress = compression + gained;
    gained / elastic
}
