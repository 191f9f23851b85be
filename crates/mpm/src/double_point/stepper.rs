//! The explicit step of two layers on its way through time.

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

/// Two layers that go by explicit steps.
pub struct DoublePointStepper<const D: usize> {
    layers: DoublePoint<D>,
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
        let mut layers = DoublePoint::new(body, lattice, gradient);
        if let Some(displacement) = displacement {
            layers.compress_by(&displacement);
        }
        let mut stepper = Self {
            start: DoublePointStart::of(&layers),
            initial_settlement: layers.body.settlement(plan.initial_height),
            layers,
            initial_height: plan.initial_height,
            settings: plan.schedule.settings,
            step_follows: !matches!(plan.schedule.rule, TimeStepRule::Seconds(_)),
            rhythm: Rhythm::default(),
            load,
            largest_pressure: 0.0,
        };
        stepper.load.act_at(&mut stepper.layers.body, 0.0);
        stepper
    }
}

impl<const D: usize> Stepper for DoublePointStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, _most_error: f64) -> Result<f64, StepFailure> {
        for step in 0..steps.count {
            if self.load.grows() {
                self.load.act_at(&mut self.layers.body, steps.time_after(step));
            }
            let kick = self.rhythm.kick(steps.dt, &self.settings);
            self.layers.kick_and_drift(kick, steps.dt, &self.settings);
        }
        // A burst may ring down again before the next output.
        self.largest_pressure =
            self.layers.water.pressure.iter().fold(self.largest_pressure, |largest, pressure| {
                if largest > pressure.abs() || largest.is_nan() { largest } else { pressure.abs() }
            });
        Ok(0.0)
    }

    fn steps_unwatched(&self) -> u64 {
        WATCH_INTERVAL
    }

    fn step_reduction(&self) -> Option<f64> {
        step_reduction(&self.layers.body, self.step_follows)
    }

    fn settlement(&self) -> f64 {
        self.layers.body.settlement(self.initial_height)
    }

    fn largest_velocity(&self) -> Option<f64> {
        Some(self.layers.body.largest_velocity())
    }

    fn energy(&mut self, _dt: f64) -> Option<(Energy, bool)> {
        let layers = &self.layers;
        if self.load.grows() {
            return None;
        }
        let water = &layers.water;
        let water = (0..water.pressure.len())
            .map(|point| (water.porosity[point] * water.volume_inside(point), water.pressure[point]));
        let settlement = self.settlement() - self.initial_settlement;
        Some((layers.body.energy(settlement, water)?, layers.body.configuration.deforms()))
    }

    fn unbalanced_force(&self) -> Option<f64> {
        (self.settings.flip >= 1.0).then(|| self.layers.body.largest_accelerating_force())
    }

    fn lost_point(&self) -> Option<StepFailure> {
        let body = &self.layers.body;
        if body.configuration.deforms() { lost_point(body) } else { None }
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        let mut snapshot = self.layers.snapshot(time, self.settlement(), &self.start);
        if let Some(layers) = &mut snapshot.totals.double_point {
            layers.largest_pressure = self.largest_pressure;
        }
        snapshot
    }
}
