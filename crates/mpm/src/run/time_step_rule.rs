//! How the time step is chosen.

use crate::body::Problem;
use crate::critical_step::formula;
use crate::run::step_limit::StepLimit;
use serde::{Deserialize, Serialize};

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TimeStepRule {
    /// Share of the predicted critical step.
    Stable(f64),
    /// Share of `h/c`, the fastest wave's way through a cell.
    Courant(f64),
    /// Seconds.
    Seconds(f64),
    /// Grows with time, `max(Δt₀, α t)`; the number is `α`.
    Growth(f64),
    /// As large as an estimate of the error in time allows: the number bounds it, relative to the
    /// load and to the settlement it makes.
    Tolerance(f64),
}

impl TimeStepRule {
    /// The rule of the same kind with another number.
    #[must_use]
    pub fn with_number(self, number: f64) -> Self {
        match self {
            Self::Stable(_) => Self::Stable(number),
            Self::Courant(_) => Self::Courant(number),
            Self::Seconds(_) => Self::Seconds(number),
            Self::Growth(_) => Self::Growth(number),
            Self::Tolerance(_) => Self::Tolerance(number),
        }
    }

    /// Step, s, on a problem with a predicted critical step.
    pub fn step<const D: usize>(&self, problem: &Problem<D>, critical: f64) -> f64 {
        match self {
            Self::Stable(share) => share * critical,
            Self::Courant(share) => {
                let soil = &problem.material;
                share * problem.grid.cell_size / formula::fastest_wave_speed(soil, soil.porosity)
            }
            Self::Seconds(seconds) => *seconds,
            Self::Growth(growth) => growth * diffusion_time(problem),
            Self::Tolerance(tolerance) => tolerance.sqrt().min(0.1) * diffusion_time(problem),
        }
    }

    /// Limit of a run's steps whose rule asks for steps of `target` seconds at first:
    /// where they grow, the first ones resolve the first output as the later ones theirs.
    pub fn limit<const D: usize>(
        &self,
        problem: &Problem<D>,
        target: f64,
        most: f64,
        outputs: &[f64],
    ) -> StepLimit {
        match self {
            Self::Stable(_) | Self::Courant(_) | Self::Seconds(_) => StepLimit::Constant(target),
            Self::Growth(growth) => {
                let first = outputs.iter().copied().find(|output| *output > 0.0);
                let start = first.unwrap_or(f64::INFINITY).min(diffusion_time(problem));
                StepLimit::Growing { first: growth * start, growth: *growth, most }
            }
            Self::Tolerance(tolerance) => StepLimit::Tolerance { first: target, tolerance: *tolerance },
        }
    }
}

/// Time, s, in which pressure diffuses through a cell, `h²/c_v`: nothing earlier is resolved.
fn diffusion_time<const D: usize>(problem: &Problem<D>) -> f64 {
    problem.grid.cell_size * problem.grid.cell_size / problem.material.coefficient_of_consolidation()
}
