//! A run: from a problem and a schedule to snapshots, history, counters and a named end.

pub mod integrator;
pub mod outcome;
pub mod physical_bounds;
pub mod profile;
pub mod snapshot;

use crate::elementary;
use crate::mpm::assembled::frozen::FrozenStep;
use crate::mpm::body::{Body, Problem};
use crate::mpm::critical_step::formula;
use crate::mpm::critical_step::predicted::predicted_critical_step;
use crate::mpm::explicit::ExplicitSettings;
use crate::mpm::explicit::scheme::Rhythm;
use crate::mpm::implicit::banded::Singular;
use crate::mpm::implicit::drive;
use crate::mpm::implicit::drive::Plan;
use crate::mpm::implicit::steps::{StepLimit, steps_for};
use crate::mpm::method::Configuration;
use crate::mpm::operators::basis::ShapeFunction;
use crate::mpm::operators::surface_load::LoadedSurface;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::mpm::run::outcome::{Counters, Failure, FailureKind, HistoryPoint, Outcome, RunStatus, StepSizes};
use crate::mpm::run::physical_bounds::PhysicalBounds;
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::run::snapshot::Snapshot;
use crate::mpm::state::points::Points;
use crate::with_basis;
use serde::{Deserialize, Serialize};

/// Steps between two looks at whether the run has left, and between two calls of the observer.
const WATCH_INTERVAL: u64 = 64;
/// Velocities beyond this multiple of their scale have left.
const BLOW_UP: f64 = 1e3;
/// Steps after which deforming points are given a new step size: the pores at the drained end
/// close within a hundred.
const STEP_RENEWAL: u64 = 32;
/// Share of a semi-implicit run's critical step that growing steps end at.
const LARGEST_SHARE: f64 = 0.8;

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TimeStepRule {
    /// Share of the predicted critical step.
    Stable(f64),
    /// Share of `h/c`, the fastest wave's way through a cell.
    Courant(f64),
    /// Seconds.
    Seconds(f64),
    /// Grows with time, `max(Δt₀, α t)`; the number is `α`.
    Growth(f64),
    /// As large as an estimate of the error in time allows: the number bounds it, relative to the
    /// load and to the settlement it makes.
    Tolerance(f64),
}

/// Kernel of the explicit step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// One banded map where the problem allows it, the point-wise step elsewhere.
    #[default]
    Fastest,
    /// The point-wise step always.
    PointWise,
}

/// When to step and what to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// Times of the snapshots, s, ascending; 0 is the start.
    pub outputs: Vec<f64>,
    /// Times at which the settlement is noted, s, ascending.
    pub history: Vec<f64>,
    /// Step size.
    pub rule: TimeStepRule,
    /// Choices of the integrator.
    pub settings: ExplicitSettings,
    /// Kernel of the step.
    pub kernel: Kernel,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Critical step, s, where it is known already.
    pub critical_step: Option<f64>,
    /// Accelerations that an implicit integrator keeps.
    pub formulation: Formulation,
}

/// Told now and then how many steps are done, of how many; answers whether to go on.
pub type Observer<'a> = &'a dyn Fn(u64, u64) -> bool;

/// Solves a problem. Never panics and never loops for ever: what goes wrong ends the run with a
/// named status, and what was finished before stays.
pub fn run<const D: usize>(problem: Problem<D>, schedule: &Schedule, observer: Observer<'_>) -> Outcome {
    with_basis!(problem.method.basis, W, S => solve(Body::<D, W, S>::new, problem, schedule, observer))
}

fn solve<const D: usize, const W: usize, S: ShapeFunction<W>>(
    discretise: impl Fn(Problem<D>) -> Body<D, W, S>,
    problem: Problem<D>,
    schedule: &Schedule,
    observer: Observer<'_>,
) -> Outcome {
    match schedule.integrator {
        IntegratorKind::Explicit => Run::new(discretise, problem, schedule).solve(observer),
        IntegratorKind::SemiImplicit | IntegratorKind::Implicit => {
            let sizes = implicit_sizes(&problem, schedule);
            // Steps that grow must not outgrow what an explicit skeleton can stand.
            let most = match schedule.integrator {
                IntegratorKind::SemiImplicit => LARGEST_SHARE * sizes.predicted_critical,
                _ => f64::INFINITY,
            };
            let initial_height = LoadedSurface::of(&problem.points, problem.load)
                .shaped(problem.load_shape, &problem.points)
                .height(&problem.points);
            let plan = Plan {
                schedule,
                limit: schedule.rule.limit(&problem, sizes.target, most, &schedule.outputs),
                sizes,
                pressure_scale: problem.pressure_scale,
                initial_height,
                bounds: PhysicalBounds::of(&problem),
                loading_time: problem.loading_time,
            };
            let undrained_start = problem.undrained_start;
            let mut body = discretise(problem);
            let start_failure = if undrained_start { body.settle_undrained().err() } else { None };
            drive::solve(body, &plan, start_failure.map(no_start), observer)
        }
    }
}

/// The end of a run that has no undrained start.
fn no_start(singular: Singular) -> Failure {
    let reason = format!("the undrained start has no pivot in row {}: nothing holds the body", singular.row);
    Failure { kind: FailureKind::Singular, step: 0, time: 0.0, growth: None, reason }
}

/// Step sizes of an implicit run. What it is measured by is a formula: of its own limit where the
/// skeleton is explicit, of the explicit integrator's where there is none.
fn implicit_sizes<const D: usize>(problem: &Problem<D>, schedule: &Schedule) -> StepSizes {
    let (soil, cell_size) = (&problem.material, problem.grid.cell_size);
    let safe = match schedule.integrator {
        IntegratorKind::SemiImplicit => formula::semi_implicit_limit(soil, cell_size, D),
        _ => formula::combined_limit(soil, cell_size, schedule.settings.drag),
    };
    StepSizes { predicted_critical: safe, target: schedule.rule.step(problem, safe), largest: 0.0 }
}

struct Run<'a, const D: usize, const W: usize, S: ShapeFunction<W>> {
    body: Body<D, W, S>,
    frozen: Option<FrozenStep<D>>,
    schedule: &'a Schedule,
    start: Points<D>,
    initial_height: f64,
    initial_settlement: f64,
    velocity_scale: f64,
    bounds: PhysicalBounds,
    /// Whole load, Pa, and the time over which it grows, s.
    load: f64,
    loading_time: f64,
    load_share: f64,
    rhythm: Rhythm,
    steps: StepSizes,
    counters: Counters,
    snapshots: Vec<Snapshot>,
    history: Vec<HistoryPoint>,
    time: f64,
    /// Largest velocity at the last look, m/s.
    watched_velocity: f64,
    /// Largest velocity over that of the look before, and the steps between them.
    growth: Option<(f64, u64)>,
    failure: Option<Failure>,
}

impl<'a, const D: usize, const W: usize, S: ShapeFunction<W>> Run<'a, D, W, S> {
    fn new(
        discretise: impl Fn(Problem<D>) -> Body<D, W, S>,
        problem: Problem<D>,
        schedule: &'a Schedule,
    ) -> Self {
        let predicted = || predicted_critical_step(&problem, &schedule.settings);
        let critical =
            schedule.critical_step.unwrap_or_else(|| profile::within(Phase::CriticalStep, predicted));
        enter(Phase::Setup);
        let target = schedule.rule.step(&problem, critical);
        let velocity_scale = velocity_scale(&problem);
        let bounds = PhysicalBounds::of(&problem);
        let (load, loading_time) = (problem.load, problem.loading_time);
        let initial_height = LoadedSurface::of(&problem.points, problem.load)
            .shaped(problem.load_shape, &problem.points)
            .height(&problem.points);
        let undrained_start = problem.undrained_start;
        let mut body = discretise(problem);
        let start_failure = if undrained_start { body.settle_undrained().err() } else { None };
        let is_assembled = body.configuration == Configuration::Frozen && schedule.kernel == Kernel::Fastest;
        let frozen = is_assembled.then(|| FrozenStep::new(&body));
        let mut run = Self {
            start: body.points.clone(),
            initial_height,
            initial_settlement: -body.surface.amplitude_of(
                &body.grid,
                &body.points,
                &body.nodes.displacement,
            ),
            velocity_scale,
            bounds,
            load,
            loading_time,
            load_share: 1.0,
            rhythm: Rhythm::default(),
            steps: StepSizes { predicted_critical: critical, target, largest: 0.0 },
            counters: Counters { points: body.points.len(), nodes: body.nodes.len(), ..Counters::default() },
            body,
            frozen,
            schedule,
            snapshots: Vec::new(),
            history: Vec::new(),
            time: 0.0,
            watched_velocity: 0.0,
            growth: None,
            failure: start_failure.map(no_start),
        };
        if loading_time > 0.0 {
            run.set_load_at(0.0);
        }
        run
    }

    fn solve(mut self, observer: Observer<'_>) -> Outcome {
        let schedule = self.schedule;
        let start = self.snapshot();
        let end = schedule.outputs.last().copied().unwrap_or(0.0);
        let expected = steps_for(end, self.steps.target);
        for output in &schedule.outputs {
            if self.failure.is_some() {
                break;
            }
            if !observer(self.counters.steps, expected) {
                self.failure = Some(self.stopped());
                break;
            }
            self.advance_to(*output, &|done| observer(done, expected));
            if self.failure.is_some() {
                break;
            }
            let snapshot = self.snapshot();
            if let Some(reason) = self.bounds.left_by_pressure(&snapshot.points.pressure) {
                self.failure = Some(self.left(&reason));
                break;
            }
            self.snapshots.push(snapshot);
        }
        Outcome {
            start,
            status: self.failure.map_or(RunStatus::Ok, RunStatus::Failed),
            snapshots: self.snapshots,
            history: self.history,
            counters: self.counters,
            step_sizes: self.steps,
        }
    }

    /// Steps of equal size that end exactly at `output`.
    fn advance_to(&mut self, output: f64, go_on: &dyn Fn(u64) -> bool) {
        while self.failure.is_none() && output - self.time > 1e-9 * output {
            let remaining = output - self.time;
            let count = steps_for(remaining, self.steps.target * self.step_reduction());
            let dt = remaining / count as f64;
            let chunk = if self.body.configuration.deforms() { count.min(STEP_RENEWAL) } else { count };
            self.steps.largest = self.steps.largest.max(dt);
            self.take_steps(chunk, dt, go_on);
        }
    }

    /// Ratio by which the step shrinks as the pores close and waves get faster, and as cells shrink
    /// that go with the points.
    fn step_reduction(&self) -> f64 {
        if !self.body.configuration.deforms() || matches!(self.schedule.rule, TimeStepRule::Seconds(_)) {
            return 1.0;
        }
        let soil = &self.body.material;
        let least_ratio = self.body.points.volume_ratio.iter().copied().fold(1.0, f64::min);
        let porosity = soil.porosity_at(least_ratio).max(1e-3);
        let shrunk = if self.body.configuration.moves_points() { 1.0 } else { least_ratio };
        shrunk * formula::fastest_wave_speed(soil, soil.porosity)
            / formula::fastest_wave_speed(soil, porosity)
    }

    fn take_steps(&mut self, count: u64, dt: f64, go_on: &dyn Fn(u64) -> bool) {
        let settings = self.schedule.settings;
        let start = self.time;
        let mut kick = f64::NAN;
        let mut done = 0;
        while done < count && self.failure.is_none() {
            let some = self.steps_to_look().min(count - done).min(self.steps_to_history(dt));
            for step in done..done + some {
                let now = start + step as f64 * dt;
                if self.load_share < 1.0 {
                    self.set_load_at(now);
                }
                let next_kick = self.rhythm.kick(dt, &settings);
                match &mut self.frozen {
                    Some(frozen) => {
                        if next_kick != kick {
                            frozen.set_step(next_kick, &settings);
                        }
                        frozen.kick_and_drift(next_kick, dt, &settings);
                    }
                    None => self.body.kick_and_drift(next_kick, dt, &settings),
                }
                kick = next_kick;
            }
            enter(Phase::Outputs);
            done += some;
            self.time = start + done as f64 * dt;
            self.counters.steps += some;
            self.counters.point_updates += some * self.counters.points as u64;
            self.note_history();
            self.watch(some);
            self.failure = self.find_failure();
            if self.failure.is_none() && !go_on(self.counters.steps) {
                self.failure = Some(self.stopped());
            }
        }
    }

    /// Puts the load of a growing time on the surface.
    fn set_load_at(&mut self, time: f64) {
        self.load_share = (time / self.loading_time).min(1.0);
        let body = &mut self.body;
        body.surface.load = self.load_share * self.load;
        body.surface.apply(&body.grid, &body.points, &mut body.nodes);
        if let Some(frozen) = &mut self.frozen {
            frozen.set_load_share(self.load_share);
        }
    }

    fn steps_to_history(&self, dt: f64) -> u64 {
        let due = self.schedule.history.get(self.history.len());
        due.map_or(u64::MAX, |due| steps_for(due - self.time, dt))
    }

    fn note_history(&mut self) {
        let settlement = self.settlement();
        while self
            .schedule
            .history
            .get(self.history.len())
            .is_some_and(|due| *due <= self.time * (1.0 + 1e-12))
        {
            self.history.push(HistoryPoint { time: self.time, settlement });
        }
    }

    fn settlement(&self) -> f64 {
        match &self.frozen {
            Some(frozen) => self.initial_settlement - frozen.surface_displacement(),
            None if self.body.configuration.moves_points() => {
                self.initial_height - self.body.surface.height(&self.body.points)
            }
            None => {
                let body = &self.body;
                -body.surface.amplitude_of(&body.grid, &body.points, &body.nodes.displacement)
            }
        }
    }

    fn snapshot(&self) -> Snapshot {
        let settlement = self.settlement();
        match &self.frozen {
            Some(frozen) => frozen.body_now(&self.body).snapshot(self.time, settlement, &self.start),
            None => self.body.snapshot(self.time, settlement, &self.start),
        }
    }

    fn failure(&self, kind: FailureKind, reason: String) -> Failure {
        let a_step = |(ratio, steps): (f64, u64)| elementary::powf(ratio, 1.0 / steps as f64);
        Failure { kind, step: self.counters.steps, time: self.time, growth: self.growth.map(a_step), reason }
    }

    fn stopped(&self) -> Failure {
        self.failure(FailureKind::Stopped, "stopped from outside".to_owned())
    }

    /// The end of a run that has left, with the step that may be to blame.
    fn left(&self, reason: &str) -> Failure {
        let step = self.steps.largest;
        let share = step / self.steps.predicted_critical;
        self.failure(
            FailureKind::Unstable,
            format!("{reason}; the step of {step:.4e} s is {share:.3} of the predicted critical one"),
        )
    }

    /// Steps to the next look: at first it comes after 1, 2, 4 steps and so on, for what grows fast
    /// is soon beyond all numbers.
    fn steps_to_look(&self) -> u64 {
        let done = self.counters.steps;
        if done >= WATCH_INTERVAL { WATCH_INTERVAL } else { ((done + 1).next_power_of_two() - done).max(1) }
    }

    /// Looks at the largest velocity after some steps.
    fn watch(&mut self, steps: u64) {
        let velocity = match &self.frozen {
            Some(frozen) => frozen.largest_velocity(),
            None => self.body.largest_velocity(),
        };
        if velocity.is_finite() && self.watched_velocity > 0.0 && velocity > 0.0 {
            self.growth = Some((velocity / self.watched_velocity, steps));
        }
        self.watched_velocity = velocity;
    }

    fn find_failure(&self) -> Option<Failure> {
        let velocity = self.watched_velocity;
        if velocity > BLOW_UP * self.velocity_scale {
            let reason = format!(
                "a nodal velocity of {velocity:.3e} m/s is more than {BLOW_UP:.0} times its scale of {:.3e} m/s",
                self.velocity_scale,
            );
            return Some(self.left(&reason));
        }
        if let Some(reason) = self.bounds.left_by_settlement(self.settlement()) {
            return Some(self.left(&reason));
        }
        if self.body.configuration.deforms() { self.find_lost_point() } else { None }
    }

    fn find_lost_point(&self) -> Option<Failure> {
        lost_point(&self.body).map(|(kind, reason)| self.failure(kind, reason))
    }
}

/// A point whose pores closed or that left the grid: by name, and in a sentence.
pub fn lost_point<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
) -> Option<(FailureKind, String)> {
    let points = &body.points;
    let grains = 1.0 - body.material.porosity;
    if let Some(point) = points.volume_ratio.iter().position(|ratio| *ratio <= grains) {
        let ratio = points.volume_ratio[point];
        let reason = format!("point {point} has J = {ratio:.4}, its grains alone fill {grains:.4}");
        return Some((FailureKind::PoresClosed, reason));
    }
    let outside = points.position.iter().position(|position| !body.grid.holds(position))?;
    Some((FailureKind::LeftGrid, format!("point {outside} is at {:?} m", points.position[outside])))
}

/// Velocity, m/s, of an undrained wave or of Darcy's flow through one cell under the problem's
/// pressure, the larger: what a sound run does not leave a thousandfold.
fn velocity_scale<const D: usize>(problem: &Problem<D>) -> f64 {
    let soil = &problem.material;
    let wave = formula::undrained_wave_speed(soil);
    let density = (1.0 - soil.porosity) * soil.grain_density + soil.porosity * soil.water_density;
    let flow = soil.hydraulic_conductivity / soil.unit_weight_of_water() / problem.grid.cell_size;
    problem.pressure_scale * (1.0 / (density * wave)).max(flow / soil.porosity)
}

impl TimeStepRule {
    /// Step, s, on a problem with a predicted critical step.
    pub fn step<const D: usize>(&self, problem: &Problem<D>, critical: f64) -> f64 {
        match self {
            Self::Stable(share) => share * critical,
            Self::Courant(share) => {
                let soil = &problem.material;
                share * problem.grid.cell_size / formula::fastest_wave_speed(soil, soil.porosity)
            }
            Self::Seconds(seconds) => *seconds,
            Self::Growth(growth) => growth * diffusion_time(problem),
            Self::Tolerance(tolerance) => tolerance.sqrt().min(0.1) * diffusion_time(problem),
        }
    }

    /// Limit of an implicit run's steps whose rule asks for steps of `target` seconds at first:
    /// where they grow, the first ones resolve the first output as the later ones theirs.
    fn limit<const D: usize>(
        &self,
        problem: &Problem<D>,
        target: f64,
        most: f64,
        outputs: &[f64],
    ) -> StepLimit {
        match self {
            Self::Stable(_) | Self::Courant(_) | Self::Seconds(_) => StepLimit::Constant(target),
            Self::Growth(growth) => {
                let first = outputs.iter().copied().find(|output| *output > 0.0);
                let start = first.unwrap_or(f64::INFINITY).min(diffusion_time(problem));
                StepLimit::Growing { first: growth * start, growth: *growth, most }
            }
            Self::Tolerance(tolerance) => StepLimit::Tolerance { first: target, tolerance: *tolerance },
        }
    }
}

/// Time, s, in which pressure diffuses through a cell, `h²/c_v`: nothing earlier is resolved.
fn diffusion_time<const D: usize>(problem: &Problem<D>) -> f64 {
    problem.grid.cell_size * problem.grid.cell_size / problem.material.coefficient_of_consolidation()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::explicit::Drag;
    use crate::mpm::explicit::scheme::Scheme;
    use crate::mpm::method::Method;
    use crate::scene::SceneKind;
    use crate::scene::column::{Column, column_problem};
    use crate::soil::material::Material;

    fn problem(method: &str, cells: usize, per_cell: usize) -> Problem<1> {
        let method = Method::named(method).expect("a known method");
        let (column, soil) = (Column::default(), Material::default());
        column_problem(SceneKind::SingleMode, &column, &soil, method, cells, per_cell)
            .expect("the seed column")
    }

    fn schedule(kernel: Kernel, settings: ExplicitSettings, end: f64) -> Schedule {
        let history = vec![0.25 * end, 0.5 * end];
        Schedule {
            outputs: vec![0.0, 0.4 * end, end],
            history,
            rule: TimeStepRule::Stable(0.6),
            settings,
            kernel,
            integrator: IntegratorKind::Explicit,
            critical_step: None,
            formulation: Formulation::VW,
        }
    }

    #[test]
    fn the_assembled_column_is_the_point_wise_step_to_round_off() {
        for name in ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch"] {
            for (scheme, drag, flip, mapping_back) in [
                (Scheme::ForwardEuler, Drag::Explicit, 1.0, true),
                (Scheme::ForwardEuler, Drag::Implicit, 1.0, false),
                (Scheme::ForwardEuler, Drag::Implicit, 0.99, true),
                (Scheme::Leapfrog, Drag::Centred, 1.0, true),
            ] {
                let settings = ExplicitSettings { scheme, drag, flip, mapping_back };
                let end = 0.02;
                let fast = run(problem(name, 7, 3), &schedule(Kernel::Fastest, settings, end), &|_, _| true);
                let plain =
                    run(problem(name, 7, 3), &schedule(Kernel::PointWise, settings, end), &|_, _| true);
                assert_eq!(fast.counters, plain.counters);
                assert_eq!(fast.status, RunStatus::Ok);
                let (fast, plain) = (fast.snapshots[2].clone(), plain.snapshots[2].clone());
                for (a, b) in [
                    (&fast.points.pressure, &plain.points.pressure),
                    (&fast.points.effective_stress, &plain.points.effective_stress),
                    (&fast.points.displacement, &plain.points.displacement),
                    (&fast.nodes.displacement, &plain.nodes.displacement),
                    (&vec![fast.settlement], &vec![plain.settlement]),
                    (&vec![fast.totals.surface_flux], &vec![plain.totals.surface_flux]),
                ] {
                    let scale = b.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
                    for (x, y) in a.iter().zip(b) {
                        assert!((x - y).abs() <= 1e-10 * scale, "{name} {settings:?}: {x} for {y}");
                    }
                }
            }
        }
    }

    #[test]
    fn outputs_are_hit_and_history_is_noted() {
        let outcome = run(
            problem("GIMP", 5, 2),
            &schedule(Kernel::Fastest, ExplicitSettings::default(), 0.01),
            &|_, _| true,
        );
        let times: Vec<f64> = outcome.snapshots.iter().map(|snapshot| snapshot.time).collect();
        assert_eq!(times[0], 0.0);
        assert!((times[1] - 0.004).abs() < 1e-15 && (times[2] - 0.01).abs() < 1e-15);
        assert_eq!(outcome.history.len(), 2);
        assert!((outcome.history[0].time / 0.0025 - 1.0).abs() < 0.02);
        assert!(outcome.step_sizes.largest <= 0.6 * outcome.step_sizes.predicted_critical * (1.0 + 1e-12));
    }

    #[test]
    fn a_step_beyond_the_limit_ends_with_a_name_and_below_it_runs() {
        for (share, stable) in [(0.97, true), (1.03, false)] {
            for name in ["GIMP", "GIMP-SRI-patch", "GC-SRI-patch"] {
                for mapping_back in [true, false] {
                    let settings = ExplicitSettings { mapping_back, ..ExplicitSettings::default() };
                    let mut schedule = schedule(Kernel::Fastest, settings, 0.3);
                    schedule.rule = TimeStepRule::Stable(share);
                    let outcome = run(problem(name, 8, 2), &schedule, &|_, _| true);
                    match outcome.status {
                        RunStatus::Ok => assert!(stable, "{name} {share} {mapping_back}"),
                        RunStatus::Failed(failure) => {
                            assert!(!stable, "{name} {share} {mapping_back}");
                            assert_eq!(failure.kind, FailureKind::Unstable);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn an_observer_can_stop_a_run() {
        let schedule = schedule(Kernel::Fastest, ExplicitSettings::default(), 0.1);
        let outcome = run(problem("GIMP", 5, 2), &schedule, &|done, _| done < 100);
        let RunStatus::Failed(failure) = outcome.status else { panic!("not stopped") };
        assert_eq!((failure.kind, failure.step), (FailureKind::Stopped, 128));
        assert_eq!(outcome.snapshots.len(), 1, "what was finished stays");
    }
}
