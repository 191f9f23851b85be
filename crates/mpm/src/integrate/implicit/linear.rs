//! SDIRK2 on the linear system of a frozen body.
//!
//! With `x_i = x̂_i + z_i` a stage solves `(C + γΔt K) z_i = γΔt (g − K x̂_i)`. What it leaves of
//! `g − K x` is zero in the rows of the mixture and `C z/(γΔt)` in those of the storage, and an
//! extrapolated state has the extrapolated residual: no product with `K` is ever taken.

use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::entries::of_dimension;
use crate::integrate::implicit::linear_system::LinearSystem;
use crate::integrate::implicit::{ERROR_SHARE, ErrorScales, SDIRK_GAMMA, SECOND_STAGE, no_pivot};
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper, Work};
use crate::kernel::body::Body;
use crate::time_limit::TimeLimit;
use oedometer_problem::snapshot::Snapshot;
use oedometer_soil::tensor::Vector;

/// Stepper of a frozen body.
pub struct LinearStepper<const D: usize> {
    /// The body at the start.
    start: Body<D>,
    /// Settlement of the start, m.
    settled: f64,
    system: LinearSystem<D>,
    /// The matrix of a step, and its factors.
    matrix: SystemMatrix,
    factors: Factors,
    time_limit: TimeLimit,
    /// Step size that the factors belong to, s.
    factored: Option<f64>,
    /// State `x`.
    state: Vec<f64>,
    /// `g − K x`.
    residual: Vec<f64>,
    increment: Vec<f64>,
    /// Increment of the first stage.
    first_increment: Vec<f64>,
    /// State, residual and outflow at the start of the step, in case it is rejected.
    before: (Vec<f64>, Vec<f64>, f64),
    error_scales: ErrorScales,
    /// Factor of the last increment that makes it the rate of `x`, 1/s: one over `γΔt`.
    rate_scale: f64,
    /// Relative flux that has passed the surface, `∫ n (v_w − v_s) dt`, m.
    outflow: f64,
    work: Work,
}

/// What other crates call of it.
struct Entries<const D: usize> {
    new: fn(Body<D>, &Plan<'_>) -> LinearStepper<D>,
    advance: fn(&mut LinearStepper<D>, &EqualSteps, f64) -> Result<f64, StepFailure>,
}

static LINE: Entries<1> = Entries::TABLE;
static PLANE: Entries<2> = Entries::TABLE;

impl<const D: usize> Entries<D> {
    const TABLE: Self = Self { new: LinearStepper::of, advance: LinearStepper::take_steps };
}

impl<const D: usize> LinearStepper<D> {
    /// A body at its start.
    pub fn new(start: Body<D>, plan: &Plan<'_>) -> Self {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.new)(start, plan)
    }

    fn of(mut start: Body<D>, plan: &Plan<'_>) -> Self {
        let system = LinearSystem::new(&mut start);
        let zero = vec![0.0; system.unknowns.count];
        Self {
            settled: start.settlement(plan.initial_height),
            matrix: system.fixed.clone(),
            factors: Factors::of_shape(&system.fixed, plan.schedule.threads, plan.schedule.time_limit),
            time_limit: plan.schedule.time_limit,
            factored: None,
            state: zero.clone(),
            residual: system.start_residual.clone(),
            first_increment: zero.clone(),
            before: (zero.clone(), zero.clone(), 0.0),
            error_scales: ErrorScales::new(&system.unknowns.scales, plan),
            increment: zero,
            rate_scale: 0.0,
            outflow: 0.0,
            work: Work::default(),
            system,
            start,
        }
    }

    /// Factors the matrix of steps of `dt` seconds, unless it is that of the last step.
    fn set_step(&mut self, dt: f64) -> Result<(), StepFailure> {
        if self.factored != Some(dt) {
            // A small factorisation does not look at the clock itself.
            if self.time_limit.is_over() {
                return Err(StepFailure::out_of_time());
            }
            let system = &self.system;
            self.matrix.set_combination(&system.fixed, SDIRK_GAMMA * dt, &system.proportional);
            let factored = self.factors.factor(&self.matrix);
            factored.map_err(|singular| no_pivot("the matrix of a step", singular, self.time_limit))?;
            self.factored = Some(dt);
            self.work.factorisations += 1;
        }
        Ok(())
    }

    /// Takes both stages of a step of the size last set; nothing is allocated.
    fn take_stages(&mut self, dt: f64) {
        let stage = SDIRK_GAMMA * dt;
        let system = &self.system;
        let sites = &system.unknowns.pressure;
        // After the first stage the state continues to the start of the second, after that to the end of the step.
        for share in [SECOND_STAGE, 1.0] {
            self.increment.copy_from_slice(&self.residual);
            for unknown in sites {
                self.increment[*unknown] *= stage;
            }
            self.factors.solve(&mut self.increment);
            if share == SECOND_STAGE {
                self.first_increment.copy_from_slice(&self.increment);
            }
            let outflow_rate = system.start_outflow
                + system.surface_outflow.product(0, &self.state)
                + system.surface_outflow.product(0, &self.increment);
            self.outflow += share * stage * outflow_rate;
            for (state, increment) in self.state.iter_mut().zip(&self.increment) {
                *state += share * increment;
            }
            for residual in &mut self.residual {
                *residual *= 1.0 - share;
            }
            for (site, unknown) in sites.iter().enumerate() {
                self.residual[*unknown] += share * system.capacity.product(site, &self.increment) / stage;
            }
        }
        self.rate_scale = 1.0 / stage;
    }

    /// Takes one step, and takes it back where its error is larger than `most_error`; returns the error.
    fn step(&mut self, dt: f64, most_error: f64) -> Result<f64, StepFailure> {
        self.set_step(dt)?;
        if most_error == f64::INFINITY {
            self.take_stages(dt);
            return Ok(0.0);
        }
        self.before.0.copy_from_slice(&self.state);
        self.before.1.copy_from_slice(&self.residual);
        self.before.2 = self.outflow;
        self.take_stages(dt);
        let error = self.error_scales.largest(&self.system.unknowns, |unknown| {
            ERROR_SHARE * (self.first_increment[unknown] - self.increment[unknown])
        });
        if error > most_error {
            self.state.copy_from_slice(&self.before.0);
            self.residual.copy_from_slice(&self.before.1);
            self.outflow = self.before.2;
            self.work.rejected_steps += 1;
        }
        Ok(error)
    }

    fn take_steps(&mut self, steps: &EqualSteps, most_error: f64) -> Result<f64, StepFailure> {
        (0..steps.count).try_fold(0.0, |_, _| self.step(steps.dt, most_error))
    }
}

impl<const D: usize> Stepper for LinearStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, most_error: f64) -> Result<f64, StepFailure> {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.advance)(self, steps, most_error)
    }

    fn settlement(&self) -> f64 {
        self.settled - self.system.surface_displacement.product(0, &self.state)
    }

    fn settlement_rate(&self) -> Option<f64> {
        Some(-self.rate_scale * self.system.surface_displacement.product(0, &self.increment))
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        let (unknowns, scales) = (&self.system.unknowns, &self.system.unknowns.scales);
        let nodal = |values: &[f64], scale: f64| -> Vec<Vector<D>> {
            let component = |unknown: Option<usize>| unknown.map_or(0.0, |unknown| scale * values[unknown]);
            unknowns.displacement.iter().map(|node| node.map(component)).collect()
        };
        let pressure = |unknown: &usize| scales.pressure * self.state[*unknown];
        let pressures: Vec<f64> = unknowns.pressure.iter().map(pressure).collect();
        let displacement = nodal(&self.state, scales.length);
        let mut body = self.start.clone();
        body.change_points(&unknowns.rows, &displacement, &pressures, &displacement);
        body.nodes.solid_velocity = nodal(&self.increment, self.rate_scale * scales.length);
        body.take_darcy_velocities();
        body.surface_flux += self.system.mean_displacement.product(0, &self.state) + self.outflow;
        body.snapshot(time, self.settlement(), &self.start.points)
    }

    fn work(&self) -> Work {
        self.work
    }
}
