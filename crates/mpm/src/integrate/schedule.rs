//! The schedule of a run: step rule, outputs, and what to keep.

use oedometer_problem::time_step::TimeStep;

use crate::time_limit::TimeLimit;
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::settings::ExplicitSettings;

/// Kernel of the explicit step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// One banded map where the problem allows it, the point-wise step elsewhere.
    #[default]
    Fastest,
    /// The point-wise step always.
    PointWise,
}

/// When to step and what to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// Times of the snapshots, s, ascending; 0 is the start.
    pub outputs: Vec<f64>,
    /// Times at which the settlement is noted, s, ascending.
    pub history: Vec<f64>,
    /// Whether the energy is noted with it.
    pub notes_energy: bool,
    /// Step size.
    pub time_step: TimeStep,
    /// Choices of the explicit integrator.
    pub settings: ExplicitSettings,
    /// Kernel of the explicit step.
    pub kernel: Kernel,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Critical step, s, where it is known already.
    pub critical_step: Option<f64>,
    /// Accelerations that an implicit integrator keeps.
    pub formulation: Formulation,
    /// Threads that large systems may be solved by. Results do not depend on it.
    pub threads: usize,
    /// The end of the time that the run has, asked where a step takes long.
    pub time_limit: TimeLimit,
}

/// Called every few steps with the steps done and those expected; returns `false` to stop the run.
pub type Observer<'a> = &'a dyn Fn(u64, u64) -> bool;
