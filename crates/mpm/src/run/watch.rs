//! Checks every few steps that a run is still sound, for every integrator.

use crate::integrate::physical_bounds::PhysicalBounds;
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper};
use crate::kernel::energy::EnergyAccount;
use oedometer_problem::integrator::StepBound;
use oedometer_problem::outcome::{FailureKind, StepSizes};
use oedometer_problem::snapshot::Snapshot;
use oedometer_soil::elementary;

/// Velocities beyond this multiple of their scale have left.
const BLOW_UP: f64 = 1e3;

/// Steps between two accounts of energy and forces, each of which costs as much as a few steps.
const STEPS_TO_ACCOUNT: u64 = 1024;

/// Steps after which the energy is accounted: work and motion are taken half a step apart, which is a tenth of all
/// that is in motion while a load has worked for a few steps.
const STEPS_TO_ENERGY: u64 = 32;

/// Checks of a running solution, with the results of the last ones.
#[derive(Clone, Copy, Debug)]
pub struct Watch<'a> {
    plan: &'a Plan<'a>,
    /// Largest velocity at the last look, m/s.
    velocity: f64,
    /// Largest velocity over that of the look before, and the steps between them.
    growth: Option<(f64, u64)>,
    /// Extremes of the energy, and the steps until the next check.
    energy: EnergyAccount,
    steps_to_account: u64,
    /// The steps before the last look, until an output takes account of them.
    seen: Option<EqualSteps>,
    /// Steps so far.
    done: u64,
    /// Physical bounds, widened by the state at the start.
    bounds: PhysicalBounds,
}

impl<'a> Watch<'a> {
    /// A watch over a run that has not begun.
    pub fn new(plan: &'a Plan<'a>) -> Self {
        let energy = EnergyAccount::of_scale(plan.bounds.energy_scale);
        let (steps_to_account, seen, done) = (0, None, 0);
        Self { plan, velocity: 0.0, growth: None, energy, steps_to_account, seen, done, bounds: plan.bounds }
    }

    /// Widens the bounds by the state at the start.
    pub fn begin(&mut self, start: &Snapshot) {
        self.bounds =
            self.plan.bounds.widened_by_start(start.points.pressures().0, start.totals.unbalanced_force);
    }

    /// Steps to the next look of at most `most`, when so many are done: at first it comes after 1, 2, 4
    /// steps and so on, for what grows fast is soon beyond all numbers.
    pub fn steps_to_look(done: u64, most: u64) -> u64 {
        if done >= most { most } else { ((done + 1).next_power_of_two() - done).max(1) }
    }

    /// Growth a step of the largest velocity when it was last finite.
    pub fn growth(&self) -> Option<f64> {
        self.growth.map(|(ratio, steps)| elementary::powf(ratio, 1.0 / steps as f64))
    }

    /// Looks at velocities, settlement and points after some steps.
    ///
    /// # Errors
    /// [`StepFailure`] where the scene cannot reach them.
    pub fn look(
        &mut self,
        stepper: &mut dyn Stepper,
        settlement: f64,
        steps: &EqualSteps,
        sizes: &StepSizes,
    ) -> Result<(), StepFailure> {
        if let Some(velocity) = stepper.largest_velocity() {
            if velocity.is_finite() && self.velocity > 0.0 && velocity > 0.0 {
                self.growth = Some((velocity / self.velocity, steps.count));
            }
            self.velocity = velocity;
            let scale = self.plan.velocity_scale;
            if velocity > BLOW_UP * scale {
                let reason = format!(
                    "a nodal velocity of {velocity:.3e} m/s is more than {BLOW_UP:.0} times its scale of \
                     {scale:.3e} m/s"
                );
                return Err(self.unstable(&reason, sizes));
            }
        }
        if let Some(reason) = self.bounds.left_by_settlement(settlement) {
            return Err(self.unstable(&reason, sizes));
        }
        self.seen = Some(*steps);
        self.done += steps.count;
        self.steps_to_account = self.steps_to_account.saturating_sub(steps.count);
        if self.steps_to_account == 0 {
            self.account(stepper, steps, sizes)?;
        }
        stepper.lost_point().map_or(Ok(()), Err)
    }

    /// Checks forces and energy after some steps.
    fn account(
        &mut self,
        stepper: &mut dyn Stepper,
        steps: &EqualSteps,
        sizes: &StepSizes,
    ) -> Result<(), StepFailure> {
        self.steps_to_account = Self::steps_to_look(self.done, STEPS_TO_ACCOUNT);
        if !self.bounds.are_kept {
            return Ok(());
        }
        let force = stepper.unbalanced_force();
        if let Some(reason) = force.and_then(|force| self.bounds.left_by_force(force, steps.end())) {
            return Err(self.unstable(&reason, sizes));
        }
        if self.done < STEPS_TO_ENERGY {
            return Ok(());
        }
        let Some((energy, moves)) = stepper.energy(steps.dt) else { return Ok(()) };
        let grown = self.energy.note(energy, moves);
        grown.map_or(Ok(()), |reason| Err(self.unstable(&reason, sizes)))
    }

    /// Looks at an output and checks forces and energy anew, so that nothing that has grown since the last check is in a result.
    ///
    /// # Errors
    /// [`StepFailure`] where the scene cannot reach its pressures, forces or energy.
    pub fn look_at_output(
        &mut self,
        stepper: &mut dyn Stepper,
        pressures: &[f64],
        sizes: &StepSizes,
    ) -> Result<(), StepFailure> {
        if let Some(steps) = self.seen.take() {
            self.account(stepper, &steps, sizes)?;
        }
        let left = self.bounds.left_by_pressure(pressures);
        left.map_or(Ok(()), |reason| Err(self.unstable(&reason, sizes)))
    }

    /// The end of a run that has left, with the step that may be to blame: an implicit skeleton has no
    /// critical one.
    fn unstable(&self, reason: &str, sizes: &StepSizes) -> StepFailure {
        let (step, share) = (sizes.largest, sizes.largest / sizes.predicted_critical);
        let blame = match (self.plan.schedule.integrator.step_bound(), &self.plan.slowly_growing) {
            (StepBound::AllWaves, Some(mode)) => format!("; {mode}"),
            (StepBound::AllWaves, None) => {
                let crossing = if self.plan.moves_points && share < 1.0 {
                    ", which is for the initial positions of the points: as they cross cells the critical \
                     step becomes smaller; `oedometer stability` observes it"
                } else {
                    ""
                };
                format!("; the step of {step:.4e} s is {share:.3} of the predicted critical one{crossing}")
            }
            (StepBound::SkeletonWaves, _) => {
                format!("; the largest step is {share:.3} of the predicted critical one")
            }
            (StepBound::Accuracy, _) => String::new(),
        };
        StepFailure { kind: FailureKind::Unstable, reason: format!("{reason}{blame}") }
    }
}
