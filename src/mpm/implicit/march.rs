//! What every implicit integrator is to the run that drives it.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::implicit::assembly::Scales;
use crate::mpm::implicit::drive::Plan;
use crate::mpm::implicit::linear::SDIRK_GAMMA;
use crate::mpm::implicit::unknowns::Unknowns;
use crate::mpm::run::outcome::FailureKind;

/// Why a step could not be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct StepFailure {
    /// Name.
    pub kind: FailureKind,
    /// A sentence with the numbers.
    pub reason: String,
}

/// Work of the solves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Matrices factored.
    pub factorisations: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Steps that had to be taken again in smaller ones.
    pub rejected_steps: u64,
}

/// Error of a step of SDIRK2 from the increments of its two stages: the difference to the solution
/// of first order with the weights ½ and ½, `(½ − γ)/γ (z_1 − z_2)`.
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

/// A body on its way through time.
pub trait March<const D: usize, const W: usize, S: ShapeFunction<W>> {
    /// Goes on by `dt` seconds, unless the error in time that the step is estimated to have is
    /// larger than `most_error`: then it stays. The error, relative to the scales of the problem.
    ///
    /// # Errors
    /// [`StepFailure`] when the step's equations could not be solved.
    fn step(&mut self, dt: f64, most_error: f64) -> Result<f64, StepFailure>;

    /// The body at the present state.
    fn body_now(&self) -> Body<D, W, S>;

    /// Settlement of the loaded surface, m.
    fn settlement(&self) -> f64;

    /// Rate of the settlement at the end of the last step, m/s.
    fn settlement_rate(&self) -> f64;

    /// A point that was lost, and how, where there is one.
    fn lost_point(&self) -> Option<StepFailure>;

    /// Work done.
    fn work(&self) -> Work;
}
