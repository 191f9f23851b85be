//! Implicit integrators on the operators of the explicit step.
//!
//! - `unknowns`: displacements of the nodes and pressures of the sites, numbered along the body;
//! - `linear_system`: the frozen body as `C ẋ + K x = g`; `linear`: SDIRK2 on it, one factorisation per step size;
//! - `trial`: a moving or inertial body at a trial state, strained by `straining`, which `point_strain` has the memory of;
//!   `residual`: what its balances leave; `tangent`: the residual's differences; `secants`: rank-one corrections of an old
//!   tangent; `guess`: where the iteration of a stage begins; `newton`: SDIRK2 with Newton's iteration;
//! - `driven`: a plate that is pushed into a frozen body which yields, by the consistent tangent of its points.
//!
//! SDIRK2 (Alexander 1977) has two stages with one matrix, and is L-stable and stiffly accurate. With `γ = 1 − 1/√2` the
//! stages start at `x̂_1 = x_n` and `x̂_2 = x_n + (1−γ)/γ z_1`, last `γ Δt` each and end at `x_i = x̂_i + z_i`; the step
//! ends at `x_2`. Linear systems are solved by `direct_solver`.

pub(crate) mod driven;
mod guess;
pub mod linear;
pub(crate) mod linear_system;
pub(crate) mod newton;
mod point_strain;
mod residual;
mod secants;
mod straining;
mod tangent;
mod trial;
pub(crate) mod unknowns;

use crate::direct_solver::Singular;
use crate::integrate::implicit::unknowns::{Scales, Unknowns};
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::StepFailure;
use crate::time_limit::TimeLimit;
use oedometer_problem::outcome::FailureKind;

/// `γ = 1 − 1/√2`: both stages have the same matrix and the method is L-stable.
pub const SDIRK_GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// `(1 − γ)/γ`: share of the first stage's increment in the start of the second.
pub const SECOND_STAGE: f64 = (1.0 - SDIRK_GAMMA) / SDIRK_GAMMA;
/// Error of a step from the increments of its two stages: the difference from the first-order solution with the weights
/// ½ and ½, `(½ − γ)/γ (z_1 − z_2)`.
///
/// The estimate is one order lower than the local error of the step, and so of the order of the accumulated error.
pub const ERROR_SHARE: f64 = (0.5 - SDIRK_GAMMA) / SDIRK_GAMMA;

/// Scales of the errors of the scaled unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorScales {
    /// Settlement under a uniform load: the mean settlement vanishes under a cosine load.
    pub displacement: f64,
    /// The load.
    pub pressure: f64,
}

impl ErrorScales {
    /// The scales of a problem.
    pub fn new(scales: &Scales, plan: &Plan<'_>) -> Self {
        let pressure = plan.pressure_scale / scales.pressure;
        Self { displacement: plan.bounds.settlement_scale / scales.length, pressure }
    }

    /// Largest relative error over all unknowns.
    pub fn largest<const D: usize>(&self, unknowns: &Unknowns<D>, error: impl Fn(usize) -> f64) -> f64 {
        let nodal = unknowns.displacement.iter().flatten().flatten();
        let largest = |most: f64, number: &usize| most.max(error(*number).abs());
        let displacement = nodal.fold(0.0, largest) / self.displacement;
        displacement.max(unknowns.pressure.iter().fold(0.0, largest) / self.pressure)
    }
}

/// The end of a step whose matrix was not factored: it is singular, or the time was over.
fn no_pivot(matrix: &str, singular: Singular, time_limit: TimeLimit) -> StepFailure {
    if time_limit.is_over() {
        return StepFailure::out_of_time();
    }
    let reason = format!("{matrix} has no pivot in row {}", singular.row);
    StepFailure { kind: FailureKind::Singular, reason }
}

#[cfg(test)]
mod tests;
