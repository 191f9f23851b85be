//! Which of the balances' accelerations are kept.

use oedometer_wording::words;

/// Which accelerations the balances keep (docs/theory.md, section 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// No acceleration: Biot's consolidation.
    QuasiStatic,
    /// Acceleration of the mixture; the water's relative to the skeleton is neglected, `a_w ≈ a_s`
    /// (Zienkiewicz 1980).
    UP,
    /// Accelerations of both phases.
    VW,
}

words!(Formulation: QuasiStatic "quasi-static", UP "u-p", VW "v-w");
