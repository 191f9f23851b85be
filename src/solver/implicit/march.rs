//! What every implicit integrator is to the run that drives it.

use crate::solver::body::{Body, ShapeFunction};
use crate::solver::outcome::FailureKind;

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
    /// Steps that had to be halved.
    pub halved_steps: u64,
}

/// A body on its way through time.
pub trait March<const D: usize, const W: usize, S: ShapeFunction<W>> {
    /// Goes on by `dt` seconds.
    ///
    /// # Errors
    /// [`StepFailure`] when the step's equations could not be solved.
    fn step(&mut self, dt: f64) -> Result<(), StepFailure>;

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
