//! The interface between the driver and the integrators.

use crate::kernel::energy::Energy;
use oedometer_problem::outcome::FailureKind;
use oedometer_problem::snapshot::Snapshot;
pub use oedometer_problem::time_step::EqualSteps;

/// Why a step could not be taken, or what is wrong with the state that it led to.
#[derive(Clone, Debug, PartialEq)]
pub struct StepFailure {
    /// Name.
    pub kind: FailureKind,
    /// A sentence with the numbers.
    pub reason: String,
}

impl StepFailure {
    /// The end of a run whose time was over within a step.
    pub fn out_of_time() -> Self {
        Self { kind: FailureKind::Stopped, reason: "stopped within a step".to_owned() }
    }
}

/// Work of the solves of an implicit integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Matrices factored.
    pub factorisations: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Steps that had to be taken again in smaller ones.
    pub rejected_steps: u64,
}

/// A body on its way through time.
pub trait Stepper {
    /// Takes steps, unless the error in time of one is estimated to be larger than `most_error`: then
    /// the body stays where that step began. The error of the last step, relative to the scales of the
    /// problem; zero where nothing is estimated.
    ///
    /// # Errors
    /// [`StepFailure`] when a step's equations could not be solved.
    fn advance(&mut self, steps: &EqualSteps, most_error: f64) -> Result<f64, StepFailure>;

    /// Most steps between two looks at the body.
    fn steps_unwatched(&self) -> u64 {
        1
    }

    /// Factor of the step where it follows the deformation of the body; none where it never changes.
    fn step_reduction(&self) -> Option<f64> {
        None
    }

    /// Settlement of the loaded surface, m.
    fn settlement(&self) -> f64;

    /// Rate of the settlement at the end of the last step, m/s; none where the settlement goes
    /// straight from step to step.
    fn settlement_rate(&self) -> Option<f64> {
        None
    }

    /// Force, N, upward positive, of the soil on a plate that is pushed into it; none without one.
    fn plate_force(&self) -> Option<f64> {
        None
    }

    /// Largest nodal velocity, m/s, infinite where one is not finite; none where nobody
    /// looks: the bounds of the scene see an implicit step that grows.
    fn largest_velocity(&self) -> Option<f64> {
        None
    }

    /// Energy after steps of `dt` seconds, and whether it is that of points that move; none where nobody keeps account of
    /// it: implicit steps make none that their solves would not show, and what a motion that was chosen, a weight or a
    /// plate does to moving points is not summed.
    fn energy(&mut self, _dt: f64) -> Option<(Energy, bool)> {
        None
    }

    /// Kinetic and strain energy of the present state; none where nobody needs it, or the law has none.
    fn energy_now(&self) -> Option<oedometer_problem::outcome::Energy> {
        None
    }

    /// Largest force on a free component of a node that accelerates it, N, in the last step; none where nobody looks, or
    /// where a share of PIC holds the points back: it takes `(1 − flip) m (v − v̄)/Δt` of what accelerates a node, by the
    /// velocity `v̄` that the grid smoothed, and the steady motion that it leaves is accelerated by as much.
    fn unbalanced_force(&self) -> Option<f64> {
        None
    }

    /// A point that was lost, and how, where there is one.
    fn lost_point(&self) -> Option<StepFailure> {
        None
    }

    /// State at the present time, s.
    fn snapshot(&self, time: f64) -> Snapshot;

    /// Work of the solves so far.
    fn work(&self) -> Work {
        Work::default()
    }
}
