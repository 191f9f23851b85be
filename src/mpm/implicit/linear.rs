//! SDIRK2 on the linear system of a frozen body.
//!
//! Two stages with one matrix, L-stable and stiffly accurate (Alexander 1977): with
//! `γ = 1 − 1/√2`, `x_i = x̂_i + z_i`, `(C + γΔt K) z_i = γΔt (g − K x̂_i)` and
//! `x̂_1 = x_n`, `x̂_2 = x_n + (1−γ)/γ z_1`, `x_{n+1} = x_2`.
//!
//! What a stage leaves of `g − K x` is zero in the rows of the mixture and `C z/(γΔt)` in those of
//! the storage, and an extrapolated state has the extrapolated residual: no product with `K` is
//! ever taken.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::implicit::assembly::LinearSystem;
use crate::mpm::implicit::banded::BandedLu;
use crate::mpm::implicit::drive::Plan;
use crate::mpm::implicit::march::{ERROR_SHARE, ErrorScales, March, StepFailure, Work};
use crate::mpm::run::outcome::FailureKind;
use crate::mpm::run::profile::{Phase, enter};
use crate::soil::tensor::Vector;

/// `γ = 1 − 1/√2`: both stages have the same matrix and the method is L-stable.
pub const SDIRK_GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// `(1 − γ)/γ`: share of the first stage's increment in the start of the second.
pub const SECOND_STAGE: f64 = (1.0 - SDIRK_GAMMA) / SDIRK_GAMMA;

/// A frozen body on its way through time.
#[derive(Clone, Debug)]
pub struct LinearMarch<const D: usize, const W: usize, S: ShapeFunction<W>> {
    /// The body at the start.
    start: Body<D, W, S>,
    /// Settlement of the start, m.
    settled: f64,
    system: LinearSystem<D>,
    lu: BandedLu,
    /// Step size that the factors belong to, s.
    factored: Option<f64>,
    /// State `x`.
    state: Vec<f64>,
    /// `g − K x`.
    residual: Vec<f64>,
    increment: Vec<f64>,
    /// Increment of the first stage.
    first_increment: Vec<f64>,
    /// State, residual and outflow at the start of the step, where it may be taken back.
    before: (Vec<f64>, Vec<f64>, f64),
    error_scales: ErrorScales,
    rejected_steps: u64,
    /// Factor of the last increment that makes it the rate of `x`, 1/s: one over `γΔt`.
    rate_scale: f64,
    /// Relative flux that passed the surface, `∫ n (v_w − v_s) dt`, m.
    outflow: f64,
    factorisations: u64,
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> LinearMarch<D, W, S> {
    /// A body at its start.
    pub fn new(start: Body<D, W, S>, plan: &Plan<'_>) -> Self {
        enter(Phase::Assembly);
        let system = LinearSystem::of(&start);
        let zero = vec![0.0; system.unknowns.count];
        Self {
            settled: -start.surface.amplitude_of(&start.grid, &start.points, &start.nodes.displacement),
            lu: BandedLu::of_shape(&system.fixed),
            factored: None,
            state: zero.clone(),
            residual: system.start_residual.clone(),
            first_increment: zero.clone(),
            before: (zero.clone(), zero.clone(), 0.0),
            error_scales: ErrorScales::of(&system.scales, plan),
            rejected_steps: 0,
            increment: zero,
            rate_scale: 0.0,
            outflow: 0.0,
            factorisations: 0,
            system,
            start,
        }
    }

    /// Factors the matrix of steps of `dt` seconds, where it is not that of the last ones.
    fn set_step(&mut self, dt: f64) -> Result<(), StepFailure> {
        if self.factored != Some(dt) {
            enter(Phase::Factors);
            let system = &self.system;
            let factored = self.lu.factor_combination(&system.fixed, SDIRK_GAMMA * dt, &system.proportional);
            factored.map_err(|singular| StepFailure {
                kind: FailureKind::Singular,
                reason: format!("the matrix of a step of {dt:.4e} s has no pivot in row {}", singular.row),
            })?;
            self.factored = Some(dt);
            self.factorisations += 1;
        }
        Ok(())
    }

    /// Both stages of a step of the size last set; nothing is allocated.
    fn take_stages(&mut self, dt: f64) {
        enter(Phase::Solve);
        let stage = SDIRK_GAMMA * dt;
        let system = &self.system;
        let sites = &system.unknowns.pressure;
        // After the first stage the state goes on to the start of the second, then to the end.
        for share in [SECOND_STAGE, 1.0] {
            self.increment.copy_from_slice(&self.residual);
            for unknown in sites {
                self.increment[*unknown] *= stage;
            }
            self.lu.solve(&mut self.increment);
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

    /// Vertical displacement of the loaded surface since the start, m.
    fn surface_displacement(&self) -> f64 {
        self.system.surface_displacement.product(0, &self.state)
    }
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> March<D, W, S> for LinearMarch<D, W, S> {
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
            self.rejected_steps += 1;
        }
        Ok(error)
    }

    fn settlement(&self) -> f64 {
        self.settled - self.surface_displacement()
    }

    fn settlement_rate(&self) -> f64 {
        -self.rate_scale * self.system.surface_displacement.product(0, &self.increment)
    }

    fn lost_point(&self) -> Option<StepFailure> {
        None
    }

    fn work(&self) -> Work {
        Work { factorisations: self.factorisations, rejected_steps: self.rejected_steps, iterations: 0 }
    }

    fn body_now(&self) -> Body<D, W, S> {
        let mut body = self.start.clone();
        let unknowns = &self.system.unknowns;
        let nodal = |values: &[f64], scale: f64| -> Vec<Vector<D>> {
            let component = |unknown: Option<usize>| unknown.map_or(0.0, |unknown| scale * values[unknown]);
            unknowns.displacement.iter().map(|node| node.map(component)).collect()
        };
        let displacement = nodal(&self.state, self.system.scales.length);
        let pressures: Vec<f64> = unknowns
            .pressure
            .iter()
            .map(|unknown| self.system.scales.pressure * self.state[*unknown])
            .collect();
        body.change_points(&unknowns.rows, &displacement, &pressures, &displacement);
        body.nodes.solid_velocity = nodal(&self.increment, self.rate_scale * self.system.scales.length);
        body.surface_flux += self.system.mean_displacement.product(0, &self.state) + self.outflow;
        body
    }
}
