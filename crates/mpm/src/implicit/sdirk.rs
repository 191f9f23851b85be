//! SDIRK2 (Alexander 1977): two stages with one matrix, L-stable and stiffly accurate.
//!
//! With `γ = 1 − 1/√2` the stages start at `x̂_1 = x_n` and `x̂_2 = x_n + (1−γ)/γ z_1`, last `γ Δt`
//! each and end at `x_i = x̂_i + z_i`; the step ends at `x_2`.

use crate::implicit::unknowns::{Scales, Unknowns};
use crate::run::run_plan::Plan;

/// `γ = 1 − 1/√2`: both stages have the same matrix and the method is L-stable.
pub const SDIRK_GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// `(1 − γ)/γ`: share of the first stage's increment in the start of the second.
pub const SECOND_STAGE: f64 = (1.0 - SDIRK_GAMMA) / SDIRK_GAMMA;
/// Error of a step from the increments of its two stages: the difference to the solution of first
/// order with the weights ½ and ½, `(½ − γ)/γ (z_1 − z_2)`.
///
/// It is of one order less than the step's own error, and so of the order of what the errors of
/// steps that grow with time add up to.
pub const ERROR_SHARE: f64 = (0.5 - SDIRK_GAMMA) / SDIRK_GAMMA;

/// Sizes that errors of the scaled unknowns are relative to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorScales {
    /// Settlement that the load makes: the surface's own mean vanishes under a cosine.
    pub displacement: f64,
    /// The load.
    pub pressure: f64,
}

impl ErrorScales {
    /// The scales of a problem.
    pub fn of(scales: &Scales, plan: &Plan<'_>) -> Self {
        let pressure = plan.pressure_scale / scales.pressure;
        Self { displacement: plan.bounds.settlement_scale / scales.length, pressure }
    }

    /// Largest relative error, from one of each unknown.
    pub fn largest<const D: usize>(&self, unknowns: &Unknowns<D>, error: impl Fn(usize) -> f64) -> f64 {
        let nodal = unknowns.displacement.iter().flatten().flatten();
        let largest = |most: f64, number: &usize| most.max(error(*number).abs());
        let displacement = nodal.fold(0.0, largest) / self.displacement;
        displacement.max(unknowns.pressure.iter().fold(0.0, largest) / self.pressure)
    }
}
