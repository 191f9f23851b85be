//! Explicit time stepping: point by point with one or two point sets, or assembled where nothing moves.

use crate::integrate::assembled::step::AssembledStep;
use crate::integrate::double_point::DoublePoint;
use crate::integrate::lost_point::lost_point;
use crate::integrate::run_plan::Plan;
use crate::integrate::schedule::Kernel;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper};
use crate::kernel::body::Body;
use crate::kernel::energy::Energy;
use crate::kernel::loaded_body::GrowingLoad;
use crate::kernel::rhythm::Rhythm;
use crate::state::points::Points;
use oedometer_problem::method::Configuration;
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::snapshot::Snapshot;
use oedometer_problem::time_step::TimeStep;
use oedometer_problem::wave_speeds;

/// Steps between two looks.
const WATCH_INTERVAL: u64 = 64;

/// A body advanced by explicit steps.
pub struct ExplicitStepper<const D: usize> {
    points: PointSets<D>,
    frozen: Option<AssembledStep<D>>,
    /// Assembled copy of a frozen body whose step is point-wise, for its energy: the criterion does not depend on the kernel.
    account: Option<Box<AssembledStep<D>>>,
    start: Points<D>,
    initial_height: f64,
    initial_settlement: f64,
    settings: ExplicitSettings,
    /// Whether the step follows the deformation of the body.
    step_follows: bool,
    rhythm: Rhythm,
    /// Kick that the assembled step is made for, s.
    kick: f64,
    load: GrowingLoad,
}

/// Points of skeleton and water.
pub(crate) enum PointSets<const D: usize> {
    /// A body; at its start where the step is assembled.
    One(Box<Body<D>>),
    /// A skeleton with its water in points of its own.
    Two(Box<DoublePoint<D>>),
}

impl<const D: usize> PointSets<D> {
    /// The body, of two sets that of the skeleton.
    fn body(&self) -> &Body<D> {
        match self {
            Self::One(body) => body,
            Self::Two(double) => &double.body,
        }
    }

    fn body_mut(&mut self) -> &mut Body<D> {
        match self {
            Self::One(body) => body,
            Self::Two(double) => &mut double.body,
        }
    }
}

/// Share of the first step that is stable still: it shrinks as the pores close and waves get faster, and as cells
/// shrink that go with the points.
fn step_reduction<const D: usize>(body: &Body<D>, follows: bool) -> Option<f64> {
    if !body.configuration.deforms() {
        return None;
    }
    if !follows {
        return Some(1.0);
    }
    let soil = &body.material;
    let least_ratio = body.points.volume_ratio.iter().copied().fold(1.0, f64::min);
    let porosity = soil.porosity_at(least_ratio).max(1e-3);
    let shrunk = if body.configuration.moves_points() { 1.0 } else { least_ratio };
    Some(
        shrunk * wave_speeds::fastest_wave_speed(soil, soil.porosity)
            / wave_speeds::fastest_wave_speed(soil, porosity),
    )
}

impl<const D: usize> ExplicitStepper<D> {
    /// A body at its start.
    pub fn new(mut points: PointSets<D>, plan: &Plan<'_>) -> Self {
        let schedule = plan.schedule;
        let (mut frozen, mut account) = (None, None);
        if let PointSets::One(body) = &mut points {
            // A law with a history has no step that is one matrix.
            if body.configuration == Configuration::Frozen && !body.has_history() {
                let assembled = AssembledStep::new(body);
                if schedule.kernel == Kernel::Fastest {
                    frozen = Some(assembled);
                } else {
                    account = Some(Box::new(assembled));
                }
            }
            if schedule.settings.affine {
                body.use_apic();
            }
            if schedule.settings.stress_slopes {
                body.slope_stresses();
            }
        }
        let body = points.body();
        let mut stepper = Self {
            frozen,
            account,
            start: body.points.clone(),
            initial_height: plan.initial_height,
            initial_settlement: body.settlement(plan.initial_height),
            settings: schedule.settings,
            step_follows: !matches!(schedule.time_step, TimeStep::Seconds(_)),
            rhythm: Rhythm::default(),
            kick: f64::NAN,
            load: GrowingLoad::new(body, plan.loading_time),
            points,
        };
        if plan.loading_time > 0.0 {
            stepper.set_load_at(0.0);
        }
        stepper
    }

    /// Sets the load on the surface to that of the time, where it grows.
    fn set_load_at(&mut self, time: f64) {
        self.load.act_at(self.points.body_mut(), time);
        for step in self.frozen.iter_mut().chain(self.account.as_deref_mut()) {
            step.set_load_share(self.load.share());
        }
    }
}

impl<const D: usize> Stepper for ExplicitStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, _most_error: f64) -> Result<f64, StepFailure> {
        let (settings, dt) = (self.settings, steps.dt);
        for step in 0..steps.count {
            if self.load.grows() {
                self.set_load_at(steps.time_after(step));
            }
            self.points.body_mut().begin_forced_step(steps.time_after(step));
            let kick = self.rhythm.kick(dt, &settings);
            match (&mut self.frozen, &mut self.points) {
                (Some(frozen), _) => {
                    if kick != self.kick {
                        frozen.set_step(kick, &settings);
                        self.kick = kick;
                    }
                    frozen.kick_and_drift(kick, dt, &settings);
                }
                (None, PointSets::One(body)) => body.kick_and_drift(kick, dt, &settings),
                (None, PointSets::Two(double)) => double.kick_and_drift(kick, dt, &settings),
            }
            if let Some(account) = &mut self.account {
                account.follow(&self.points.body().nodes, dt);
            }
        }
        if let PointSets::Two(double) = &mut self.points {
            double.note_largest_pressure();
        }
        Ok(0.0)
    }

    fn steps_unwatched(&self) -> u64 {
        WATCH_INTERVAL
    }

    fn step_reduction(&self) -> Option<f64> {
        step_reduction(self.points.body(), self.step_follows)
    }

    fn settlement(&self) -> f64 {
        match &self.frozen {
            Some(frozen) => self.initial_settlement - frozen.surface_displacement(),
            None => self.points.body().settlement(self.initial_height),
        }
    }

    fn largest_velocity(&self) -> Option<f64> {
        Some(match &self.frozen {
            Some(frozen) => frozen.largest_velocity(),
            None => self.points.body().largest_velocity(),
        })
    }

    fn energy(&mut self, dt: f64) -> Option<(Energy, bool)> {
        let body = self.points.body();
        if body.actions.weight.is_some() || self.load.grows() {
            return None;
        }
        if let Some(step) = self.frozen.as_mut().or(self.account.as_deref_mut()) {
            return Some((step.energy(dt, self.settings.mapping_back), false));
        }
        let settlement = self.settlement() - self.initial_settlement;
        let energy = match &self.points {
            PointSets::One(body) => body.energy(settlement, body.water_of_points()),
            PointSets::Two(double) => body.energy(settlement, double.water.volumes_and_pressures()),
        };
        Some((energy?, body.configuration.deforms()))
    }

    fn energy_now(&self) -> Option<oedometer_problem::outcome::Energy> {
        match (&self.frozen, &self.points) {
            (Some(frozen), points) => {
                let body = frozen.body_now(points.body());
                body.energy_now(body.water_of_points())
            }
            (None, PointSets::One(body)) => body.energy_now(body.water_of_points()),
            (None, PointSets::Two(double)) => double.body.energy_now(double.water.volumes_and_pressures()),
        }
    }

    fn unbalanced_force(&self) -> Option<f64> {
        let largest = || match &self.frozen {
            Some(frozen) => frozen.largest_accelerating_force(),
            None => self.points.body().largest_accelerating_force(),
        };
        (self.settings.flip >= 1.0).then(largest)
    }

    fn lost_point(&self) -> Option<StepFailure> {
        let body = self.points.body();
        if body.configuration.deforms() { lost_point(body) } else { None }
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        let settlement = self.settlement();
        match (&self.frozen, &self.points) {
            (Some(frozen), points) => frozen.body_now(points.body()).snapshot(time, settlement, &self.start),
            (None, PointSets::One(body)) => body.snapshot(time, settlement, &self.start),
            (None, PointSets::Two(double)) => double.snapshot(time, settlement, &self.start),
        }
    }
}
