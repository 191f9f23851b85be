//! The explicit step of double-point MPM as the driver takes it.

use crate::body::Body;
use crate::double_point::DoublePoint;
use crate::double_point::samples::DoublePointStart;
use crate::explicit::ExplicitSettings;
use crate::explicit::scheme::Rhythm;
use crate::run::energy::Energy;
use crate::run::explicit_stepper::{GrowingLoad, WATCH_INTERVAL, step_reduction};
use crate::run::results::snapshot::Snapshot;
use crate::run::run_plan::Plan;
use crate::run::schedule::TimeStepRule;
use crate::run::stepper::{EqualSteps, StepFailure, Stepper};
use crate::run::watch::lost_point;
use crate::state::points::Points;
use oedometer_soil::tensor::Tensor;

/// Two sets of points that go by explicit steps.
pub struct DoublePointStepper<const D: usize> {
    double: DoublePoint<D>,
    start: DoublePointStart<D>,
    initial_height: f64,
    /// Settlement of the start, m.
    initial_settlement: f64,
    settings: ExplicitSettings,
    /// Whether the step follows the deformation of the body.
    step_follows: bool,
    rhythm: Rhythm,
    load: GrowingLoad,
    /// Largest size of the pressure of any water point so far, Pa.
    largest_pressure: f64,
}

impl<const D: usize> DoublePointStepper<D> {
    /// A body at its start, undrained or not, with its water on a lattice.
    pub fn new(
        body: Body<D>,
        lattice: &Points<D>,
        gradient: &Tensor<D>,
        is_settled: bool,
        plan: &Plan<'_>,
    ) -> Self {
        let displacement = is_settled.then(|| body.nodes.displacement.clone());
        let load = GrowingLoad::of(&body, plan.loading_time);
        let mut double = DoublePoint::new(body, lattice, gradient);
        if let Some(displacement) = displacement {
            double.compress_by(&displacement);
        }
        let mut stepper = Self {
            start: DoublePointStart::of(&double),
            initial_settlement: double.body.settlement(plan.initial_height),
            double,
            initial_height: plan.initial_height,
            settings: plan.schedule.settings,
            step_follows: !matches!(plan.schedule.rule, TimeStepRule::Seconds(_)),
            rhythm: Rhythm::default(),
            load,
            largest_pressure: 0.0,
        };
        stepper.load.act_at(&mut stepper.double.body, 0.0);
        stepper
    }
}

impl<const D: usize> Stepper for DoublePointStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, _most_error: f64) -> Result<f64, StepFailure> {
        for step in 0..steps.count {
            if self.load.grows() {
                self.load.act_at(&mut self.double.body, steps.time_after(step));
            }
            let kick = self.rhythm.kick(steps.dt, &self.settings);
            self.double.kick_and_drift(kick, steps.dt, &self.settings);
        }
        // A burst may ring down again before the next output.
        self.largest_pressure =
            self.double.water.pressure.iter().fold(self.largest_pressure, |largest, pressure| {
                if largest > pressure.abs() || largest.is_nan() { largest } else { pressure.abs() }
            });
        Ok(0.0)
    }

    fn steps_unwatched(&self) -> u64 {
        WATCH_INTERVAL
    }

    fn step_reduction(&self) -> Option<f64> {
        step_reduction(&self.double.body, self.step_follows)
    }

    fn settlement(&self) -> f64 {
        self.double.body.settlement(self.initial_height)
    }

    fn largest_velocity(&self) -> Option<f64> {
        Some(self.double.body.largest_velocity())
    }

    fn energy(&mut self, _dt: f64) -> Option<(Energy, bool)> {
        let double = &self.double;
        if self.load.grows() {
            return None;
        }
        let water = &double.water;
        let water = (0..water.pressure.len())
            .map(|point| (water.porosity[point] * water.volume_inside(point), water.pressure[point]));
        let settlement = self.settlement() - self.initial_settlement;
        Some((double.body.energy(settlement, water)?, double.body.configuration.deforms()))
    }

    fn unbalanced_force(&self) -> Option<f64> {
        (self.settings.flip >= 1.0).then(|| self.double.body.largest_accelerating_force())
    }

    fn lost_point(&self) -> Option<StepFailure> {
        let body = &self.double.body;
        if body.configuration.deforms() { lost_point(body) } else { None }
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        let mut snapshot = self.double.snapshot(time, self.settlement(), &self.start);
        if let Some(double) = &mut snapshot.totals.double_point {
            double.largest_pressure = self.largest_pressure;
        }
        snapshot
    }
}
