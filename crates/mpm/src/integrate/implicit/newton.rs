//! SDIRK2 with Newton's iteration for each stage: for finite strain, and for bodies with inertia.

use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::integrate::implicit::guess::StageGuess;
use crate::integrate::implicit::residual::StageStart;
use crate::integrate::implicit::secants::Secants;
use crate::integrate::implicit::tangent::{DIFFERENCE, Pattern};
use crate::integrate::implicit::trial::{Skeleton, Trial};
use crate::integrate::implicit::{ERROR_SHARE, ErrorScales, SDIRK_GAMMA, SECOND_STAGE, no_pivot};
use crate::integrate::lost_point::lost_point;
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper, Work};
use crate::kernel::body::Body;
use crate::kernel::loaded_body::GrowingLoad;
use crate::time_limit::TimeLimit;
use oedometer_problem::integrator::StepBound;
use oedometer_problem::method::PressureIntegration;
use oedometer_problem::outcome::FailureKind;
use oedometer_problem::snapshot::Snapshot;
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::elementary;

/// Most iterations of a stage.
const MOST_ITERATIONS: usize = 16;
/// Times that a step is halved before the run ends.
const MOST_HALVINGS: u32 = 10;
/// Error of an iteration, over the size of the problem's strains.
const TOLERANCE: f64 = 1e-12;
/// Perturbation for the tangent of a body that keeps its shape, over the size of the problem's strains: one that is not small
/// against them averages the stiffnesses on both sides of a yield limit.
const SHARE_OF_STRAIN: f64 = 1e-5;
/// Contraction, the ratio of successive corrections, that is assumed where none is known.
const SLOW: f64 = 0.1;
/// Contraction beyond which the tangent is always renewed.
const TOO_SLOW: f64 = 0.8;
/// Expected iterations with the old tangent that justify a new one, which costs a residual for each of its groups.
const PATIENCE: f64 = 12.0;
/// Corrections of so many times what round-off of the residual asks for are its work, too.
const ROUND_OFF_MARGIN: f64 = 4.0;
/// Changes of a state by round-off from which that of the residual is measured.
const ROUND_OFF_SAMPLES: u32 = 2;
/// Assumed growth of the contraction in a stage that ends after one correction, which does not show it.
const UNSEEN_GROWTH: f64 = 2.0;

/// Duration and end of a stage, in steps, and the share of its increment in the start of the next stage or in the step.
type Stage = (f64, f64, f64);
/// The stages of SDIRK2.
const SDIRK_STAGES: &[Stage] = &[(SDIRK_GAMMA, SDIRK_GAMMA, SECOND_STAGE), (SDIRK_GAMMA, 1.0, 1.0)];
/// The stage of backward Euler, beside an explicit skeleton.
const SINGLE_STAGE: &[Stage] = &[(1.0, 1.0, 1.0)];

/// Stepper of a body by Newton's iteration.
pub struct NewtonStepper<const D: usize> {
    pub(super) trial: Trial<D>,
    pattern: Pattern,
    tangent: SystemMatrix,
    factors: Factors,
    threads: usize,
    time_limit: TimeLimit,
    /// Updates of the factors from the last corrections.
    secants: Secants,
    /// The last correction of the scaled unknowns.
    correction: Vec<f64>,
    /// Stage duration that the factors belong to, s.
    factored: Option<f64>,
    /// Ratio of successive corrections: the last one of a stage, at the start of a stage the first one.
    contraction: f64,
    /// Error that a stage may leave in the scaled unknowns.
    tolerance: f64,
    /// Correction of the scaled unknowns by round-off, which a displacement sums over all cells: that of strains which are
    /// differences of numbers near one, or of those of a body that keeps its shape.
    round_off: f64,
    /// The same as measured where an iteration came to rest, and the duration of that stage, s.
    measured: [f64; 2],
    /// Perturbation of a scaled unknown for the tangent: the problem's strain where the step is linear in it, and a small share
    /// of it where small strains pass a yield limit.
    difference: f64,
    error_scales: ErrorScales,
    stages: &'static [Stage],
    start: StageStart<D>,
    guess: StageGuess,
    /// Rate of the scaled unknowns at the end of the last step, 1/s.
    rate: Vec<f64>,
    state: Vec<f64>,
    residual: Vec<f64>,
    scratch: Vec<f64>,
    initial_height: f64,
    load: GrowingLoad,
    /// Time at the start of the step, s.
    time: f64,
    settlement_rate: f64,
    work: Work,
}

impl<const D: usize> NewtonStepper<D> {
    /// A body at its start.
    pub fn new(body: Body<D>, plan: &Plan<'_>) -> Self {
        let (skeleton, stages) = match plan.schedule.integrator.step_bound() {
            StepBound::SkeletonWaves => (Skeleton::Explicit, SINGLE_STAGE),
            StepBound::AllWaves | StepBound::Accuracy => (Skeleton::Implicit, SDIRK_STAGES),
        };
        let trial = Trial::new(body, plan.schedule.formulation, skeleton);
        let pattern = Pattern::new(&trial.body, &trial.unknowns);
        let tangent = pattern.zeros();
        let scales = trial.unknowns.scales;
        let cells = trial.body.grid.cells.iter().fold(0.0, |most: f64, count| most.max(*count as f64));
        let strain = plan.pressure_scale / scales.pressure;
        let keeps_shape = !trial.body.configuration.deforms();
        let is_linear = keeps_shape && !trial.body.has_history();
        let zero = vec![0.0; trial.unknowns.count];
        Self {
            factors: Factors::of_shape(&tangent, plan.schedule.threads, plan.schedule.time_limit),
            threads: plan.schedule.threads,
            time_limit: plan.schedule.time_limit,
            secants: Secants::default(),
            correction: zero.clone(),
            tangent,
            pattern,
            factored: None,
            contraction: SLOW,
            tolerance: TOLERANCE * strain,
            round_off: f64::EPSILON * cells * cells * if keeps_shape { strain } else { 1.0 },
            measured: [0.0; 2],
            difference: match (is_linear, keeps_shape) {
                (true, _) => strain,
                (false, true) => SHARE_OF_STRAIN * strain,
                (false, false) => DIFFERENCE,
            },
            error_scales: ErrorScales::new(&scales, plan),
            stages,
            start: StageStart::default(),
            guess: StageGuess::new(zero.len()),
            rate: zero.clone(),
            state: zero.clone(),
            residual: zero.clone(),
            scratch: zero,
            initial_height: plan.initial_height,
            load: GrowingLoad::new(&trial.body, plan.loading_time),
            time: 0.0,
            settlement_rate: 0.0,
            work: Work::default(),
            trial,
        }
    }

    /// Takes a step, in halves where the iteration does not converge.
    fn step_within(&mut self, dt: f64, halvings: u32, most_error: f64) -> Result<f64, StepFailure> {
        match self.try_step(dt, most_error) {
            Err(failure) if halvings > 0 && failure.kind != FailureKind::Stopped => {
                self.work.rejected_steps += 1;
                self.step_within(0.5 * dt, halvings - 1, f64::INFINITY)?;
                self.step_within(0.5 * dt, halvings - 1, f64::INFINITY)
            }
            done => done,
        }
    }

    fn try_step(&mut self, dt: f64, most_error: f64) -> Result<f64, StepFailure> {
        let mut flux = 0.0;
        let mut first = true;
        self.trial.begin_step(self.time);
        for (number, (duration, end, share)) in self.stages.iter().enumerate() {
            let stage = duration * dt;
            if first {
                self.start_step(stage);
                first = false;
            }
            self.load.act_at(&mut self.trial.body, self.time + end * dt);
            self.trial.act_later(end * dt);
            self.solve_stage(number)?;
            self.guess.keep(number, &self.rate, &self.start.unknowns, &self.state);
            flux += share * stage * self.trial.outflow();
            if *share != 1.0 {
                self.start_second_stage();
            }
        }
        let error = self.error();
        if error > most_error {
            self.work.rejected_steps += 1;
            return Ok(error);
        }
        let stage = self.start.duration;
        for (rate, (end, start)) in self.rate.iter_mut().zip(self.state.iter().zip(&self.start.unknowns)) {
            *rate = (end - start) / stage;
        }
        self.settlement_rate = self.trial.settlement_rate();
        self.trial.end_step(&self.state, flux);
        self.time += dt;
        self.guess.end_step();
        self.follow_structure();
        Ok(error)
    }

    /// Estimated error of the step that was solved last.
    fn error(&self) -> f64 {
        if self.stages.len() == 1 {
            return 0.0;
        }
        self.error_scales.largest(&self.trial.unknowns, |unknown| {
            let start = self.start.unknowns[unknown];
            ERROR_SHARE * (start / SECOND_STAGE - (self.state[unknown] - start))
        })
    }

    /// Starts the first stage where the last step ended.
    fn start_step(&mut self, stage: f64) {
        self.start.duration = stage;
        self.start.unknowns.clear();
        self.start.unknowns.resize(self.state.len(), 0.0);
        let [solid, water] = &self.trial.velocity;
        self.start.solid_velocity.clone_from(solid);
        self.start.water_velocity.clone_from(water);
        self.guess.begin_step(stage);
    }

    /// Starts the second stage where the rates of the first lead.
    fn start_second_stage(&mut self) {
        let nodes = &self.trial.body.nodes;
        for (start, now) in [
            (&mut self.start.solid_velocity, &nodes.solid_velocity),
            (&mut self.start.water_velocity, &nodes.water_velocity),
        ] {
            for (start, now) in start.iter_mut().flatten().zip(now.iter().flatten()) {
                *start += SECOND_STAGE * (now - *start);
            }
        }
        for (start, state) in self.start.unknowns.iter_mut().zip(&self.state) {
            *start = SECOND_STAGE * state;
        }
    }

    /// Solves a stage from its guess. Where that fails with an extrapolated guess or a tangent of points in other cells, it
    /// tries again with the last rate and a new tangent.
    fn solve_stage(&mut self, number: usize) -> Result<(), StepFailure> {
        self.guess.guess(number, &self.rate, &self.start.unknowns, &mut self.state);
        let is_bold = !self.guess.is_plain(number)
            || (self.factored.is_some() && !self.pattern.matches(&self.trial.body, &self.trial.unknowns));
        match self.iterate() {
            Err(failure) if is_bold && failure.kind != FailureKind::Stopped => {
                self.guess.make_plain(number);
                self.guess.guess(number, &self.rate, &self.start.unknowns, &mut self.state);
                self.factored = None;
                self.iterate()
            }
            done => done,
        }
    }

    /// Newton's iteration with the tangent of an earlier state, as long as it converges well.
    fn iterate(&mut self) -> Result<(), StepFailure> {
        let mut last = f64::INFINITY;
        let mut first = None;
        let mut renew = self.factored != Some(self.start.duration);
        for _ in 0..MOST_ITERATIONS {
            self.ask_for_time()?;
            self.trial.residual(&self.state, &self.start, &mut self.residual)?;
            if renew {
                self.renew_tangent()?;
                self.contraction = SLOW;
            }
            self.scratch.copy_from_slice(&self.residual);
            self.factors.solve(&mut self.scratch);
            self.secants.apply(&mut self.scratch);
            if last.is_finite() && !renew {
                self.secants.learn(&self.correction, &mut self.scratch);
            }
            self.correction.copy_from_slice(&self.scratch);
            let mut size: f64 = 0.0;
            for (state, correction) in self.state.iter_mut().zip(&self.scratch) {
                *state -= correction;
                // NaN stays, and never ends the iteration.
                let next = correction.abs();
                size = if size > next || size.is_nan() { size } else { next };
            }
            self.work.iterations += 1;
            if last.is_finite() && last > 0.0 {
                self.contraction = (size / last).max(1e-3);
                first.get_or_insert(self.contraction);
            }
            if size * self.contraction <= self.tolerance * (1.0 - self.contraction) {
                // The next stage begins without the updates of this one's later corrections.
                self.contraction = first.unwrap_or((UNSEEN_GROWTH * self.contraction).min(SLOW));
                return self.end_iteration(renew);
            }
            if size >= SLOW * last {
                // The tangent is that of the state, and still the corrections do not fall.
                if renew && size > self.allowed_round_off() {
                    self.measure_round_off()?;
                }
                if size <= self.allowed_round_off() {
                    // Neither a new tangent nor smaller steps reduce round-off.
                    self.contraction = SLOW;
                    return self.end_iteration(renew);
                }
            }
            let left = elementary::ln(self.tolerance / size) / elementary::ln(self.contraction);
            renew = last.is_finite() && (self.contraction > TOO_SLOW || left > PATIENCE);
            last = size;
        }
        Err(StepFailure {
            kind: FailureKind::NotConverged,
            reason: format!(
                "{MOST_ITERATIONS} iterations of a stage of {:.3e} s left a correction of {last:.3e} times the cell, and \
                 {:.3e} are allowed",
                self.start.duration,
                self.tolerance.max(self.allowed_round_off())
            ),
        })
    }

    /// Correction, in scaled unknowns, that is put down to round-off in the present stage.
    fn allowed_round_off(&self) -> f64 {
        let [size, duration] = self.measured;
        let is_alike = (0.5..=2.0).contains(&(duration / self.start.duration));
        if is_alike { self.round_off.max(ROUND_OFF_MARGIN * size) } else { self.round_off }
    }

    /// Measures the correction that round-off of the residual asks for: what changes of the state by round-off change of the
    /// correction beyond themselves.
    fn measure_round_off(&mut self) -> Result<(), StepFailure> {
        let (mut base, mut moved, mut change) =
            (self.residual.clone(), self.state.clone(), self.state.clone());
        self.trial.residual(&self.state, &self.start, &mut base)?;
        let mut size: f64 = 0.0;
        let mut seed = 1_u32;
        for _ in 0..ROUND_OFF_SAMPLES {
            for (moved, state) in moved.iter_mut().zip(&self.state) {
                // A fixed sequence without a pattern (Knuth's multiplicative hash).
                seed = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
                *moved = state + 8.0 * f64::EPSILON * (f64::from(seed) / f64::from(u32::MAX) - 0.5);
            }
            self.trial.residual(&moved, &self.start, &mut change)?;
            for (change, base) in change.iter_mut().zip(&base) {
                *change -= base;
            }
            self.factors.solve(&mut change);
            for (change, (moved, state)) in change.iter().zip(moved.iter().zip(&self.state)) {
                size = size.max((change - (moved - state)).abs());
            }
        }
        self.measured = [size, self.start.duration];
        Ok(())
    }

    fn ask_for_time(&self) -> Result<(), StepFailure> {
        if self.time_limit.is_over() { Err(StepFailure::out_of_time()) } else { Ok(()) }
    }

    /// Ends an iteration. Where its tangent is new, the nodes still have the velocities and the flux of the last difference.
    fn end_iteration(&mut self, was_renewed: bool) -> Result<(), StepFailure> {
        if was_renewed {
            self.trial.residual(&self.state, &self.start, &mut self.residual)?;
        }
        Ok(())
    }

    fn renew_tangent(&mut self) -> Result<(), StepFailure> {
        if !self.pattern.matches(&self.trial.body, &self.trial.unknowns) {
            self.renew_pattern();
        }
        let (trial, start, time_limit) = (&mut self.trial, &self.start, self.time_limit);
        self.pattern.differentiate(
            self.difference,
            &mut self.state,
            &self.residual,
            &mut self.scratch,
            &mut self.tangent,
            // Pores that are closed by a perturbation are open at the iterate itself.
            |state, residual| {
                // The run ends right after this.
                if !time_limit.is_over() {
                    let _ = trial.residual(state, start, residual);
                }
            },
        );
        self.ask_for_time()?;
        self.work.factorisations += 1;
        self.factored = Some(start.duration);
        self.secants.clear();
        self.factors.factor(&self.tangent).map_err(|singular| {
            self.factored = None;
            no_pivot("the tangent", singular, self.time_limit)
        })
    }

    /// Adds advice to a failure: to that of a method that is known to fail so, as in the plane pressures of the points' own
    /// leave modes without stiffness once points have moved, and to any iteration that circles.
    fn with_remedy(&self, failure: StepFailure) -> StepFailure {
        let body = &self.trial.body;
        let is_known = D > 1
            && body.configuration.moves_points()
            && body.method.pressure == PressureIntegration::Points
            && !body.method.has_nodal_pressure();
        let StepFailure { kind, reason } = failure;
        let is_chord = body.material.conductivity_mean == ConductivityMean::Chord;
        let remedy = if kind == FailureKind::Stopped {
            return StepFailure { kind, reason };
        } else if is_known {
            "in the plane a pressure at every point leaves modes without stiffness once points have moved: \
             use cell pressures (GIMP-SRI, GIMP-SRI-patch), or shape functions on the initial configuration \
                      (TL-GIMP)"
        } else if kind != FailureKind::NotConverged {
            return StepFailure { kind, reason };
        } else if is_chord {
            "the chord mean jumps where the points around a node determine no slope: use \
             `conductivity_mean = \"points\"`, or points on their lattice"
        } else if self.stages.len() == 1 {
            "an explicit skeleton bounds the step: use a smaller `time_step`, or the integrator `implicit`"
        } else {
            "shorter steps did not help: use cell pressures (GIMP-SRI-patch), shape functions on the initial \
             configuration (TL-), more points per cell, or a smaller load"
        };
        StepFailure { kind, reason: format!("{reason}; {remedy}") }
    }

    /// Points that moved to other cells change which balances depend on which unknowns. The factors are used as long as they
    /// converge well, unless the unknowns themselves have changed.
    fn follow_structure(&mut self) {
        let (body, unknowns) = (&self.trial.body, &self.trial.unknowns);
        if self.pattern.matches(body, unknowns) {
            return;
        }
        self.contraction = self.contraction.max(SLOW);
        if self.pattern.has_unknowns(unknowns) {
            return;
        }
        self.renew_pattern();
        let count = self.trial.unknowns.count;
        self.guess = StageGuess::new(count);
        if count != self.state.len() {
            let scratch = [&mut self.scratch, &mut self.correction];
            for vector in [&mut self.rate, &mut self.state, &mut self.residual].into_iter().chain(scratch) {
                vector.clear();
                vector.resize(count, 0.0);
            }
        }
    }

    /// Makes a new pattern, with room for its factors.
    fn renew_pattern(&mut self) {
        self.trial.unknowns.take_rows(&self.trial.body);
        self.pattern = Pattern::new(&self.trial.body, &self.trial.unknowns);
        self.tangent = self.pattern.zeros();
        self.factors = Factors::of_shape(&self.tangent, self.threads, self.time_limit);
        self.factored = None;
    }
}

impl<const D: usize> Stepper for NewtonStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, most_error: f64) -> Result<f64, StepFailure> {
        // Smaller steps would hide that an explicit skeleton exceeds its limit.
        let halvings = if self.stages.len() == 1 { 0 } else { MOST_HALVINGS };
        (0..steps.count)
            .try_fold(0.0, |_, _| self.step_within(steps.dt, halvings, most_error))
            .map_err(|failure| self.with_remedy(failure))
    }

    fn settlement(&self) -> f64 {
        self.trial.body.settlement(self.initial_height)
    }

    fn settlement_rate(&self) -> Option<f64> {
        Some(self.settlement_rate)
    }

    fn lost_point(&self) -> Option<StepFailure> {
        lost_point(&self.trial.body).map(|failure| self.with_remedy(failure))
    }

    fn energy_now(&self) -> Option<oedometer_problem::outcome::Energy> {
        let body = &self.trial.body;
        body.energy_now(body.water_of_points())
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        self.trial.body.snapshot(time, self.settlement(), &self.trial.start)
    }

    fn work(&self) -> Work {
        self.work
    }
}
