//! A run by an implicit integrator: from output to output, with snapshots and history.

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::implicit::linear::LinearMarch;
use crate::mpm::implicit::march::{March, StepFailure};
use crate::mpm::implicit::newton::NewtonMarch;
use crate::mpm::implicit::steps::{StepLimit, steps_for};
use crate::mpm::method::Configuration;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::mpm::run::outcome::{Counters, Failure, FailureKind, HistoryPoint, Outcome, RunStatus, StepSizes};
use crate::mpm::run::physical_bounds::PhysicalBounds;
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::run::snapshot::Snapshot;
use crate::mpm::run::{Observer, Schedule};
use crate::mpm::state::points::Points;

/// What an implicit run needs beside its body.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// When to step and what to keep.
    pub schedule: &'a Schedule,
    /// How large the steps may be.
    pub limit: StepLimit,
    /// Step sizes as far as they are known before.
    pub sizes: StepSizes,
    /// Pressure that the problem is about, Pa.
    pub pressure_scale: f64,
    /// Height of the surface that settlements count from, m.
    pub initial_height: f64,
    /// What a sound result does not leave.
    pub bounds: PhysicalBounds,
    /// Time over which the load grows to its full value, s.
    pub loading_time: f64,
}

/// Solves a body: by one linear system where it is frozen and at rest, by Newton's iteration
/// elsewhere.
pub fn solve<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: Body<D, W, S>,
    plan: &Plan<'_>,
    start_failure: Option<Failure>,
    observer: Observer<'_>,
) -> Outcome {
    let start = body.points.clone();
    let is_linear =
        body.configuration == Configuration::Frozen && plan.schedule.formulation == Formulation::QuasiStatic;
    if is_linear {
        MarchRun::new(LinearMarch::new(body, plan), start, plan).solve(start_failure, observer)
    } else {
        MarchRun::new(NewtonMarch::new(body, plan), start, plan).solve(start_failure, observer)
    }
}

struct MarchRun<'a, const D: usize, M> {
    march: M,
    /// Points at the start.
    start: Points<D>,
    plan: &'a Plan<'a>,
    time: f64,
    sizes: StepSizes,
    counters: Counters,
    history: History<'a>,
    expected: u64,
    /// Steps tried, those that were taken back included.
    tried: u64,
    /// Size that the errors of the steps so far ask for, s.
    adaptive_step: f64,
}

impl<'a, const D: usize, M> MarchRun<'a, D, M> {
    fn new(march: M, start: Points<D>, plan: &'a Plan<'a>) -> Self {
        let end = plan.schedule.outputs.last().copied().unwrap_or(0.0);
        Self {
            march,
            time: 0.0,
            sizes: plan.sizes,
            counters: Counters { points: start.len(), ..Counters::default() },
            history: History::of(&plan.schedule.history),
            expected: plan.limit.expected_steps(end),
            tried: 0,
            adaptive_step: plan.sizes.target,
            plan,
            start,
        }
    }

    fn solve<const W: usize, S: ShapeFunction<W>>(
        mut self,
        start_failure: Option<Failure>,
        observer: Observer<'_>,
    ) -> Outcome
    where
        M: March<D, W, S>,
    {
        let start = self.snapshot();
        self.counters.nodes = self.march.body_now().nodes.len();
        let mut snapshots = Vec::new();
        let mut status = start_failure.map_or(RunStatus::Ok, RunStatus::Failed);
        for output in &self.plan.schedule.outputs {
            if status != RunStatus::Ok {
                break;
            }
            match self.output_at(*output, observer) {
                Ok(snapshot) => snapshots.push(snapshot),
                Err(StepFailure { kind, reason }) => {
                    status = RunStatus::Failed(Failure {
                        kind,
                        step: self.counters.steps,
                        time: self.time,
                        growth: None,
                        reason,
                    });
                }
            }
        }
        let work = self.march.work();
        self.counters.factorisations = work.factorisations;
        self.counters.iterations = work.iterations;
        self.counters.rejected_steps = work.rejected_steps;
        Outcome {
            status,
            start,
            snapshots,
            history: self.history.noted,
            counters: self.counters,
            step_sizes: self.sizes,
        }
    }

    /// The state at an output, where it is one that the scene can reach.
    fn output_at<const W: usize, S: ShapeFunction<W>>(
        &mut self,
        output: f64,
        observer: Observer<'_>,
    ) -> Result<Snapshot, StepFailure>
    where
        M: March<D, W, S>,
    {
        self.ask_to_go_on(observer)?;
        self.advance_to(output, observer)?;
        let snapshot = self.snapshot();
        match self.plan.bounds.left_by_pressure(&snapshot.points.pressure) {
            Some(reason) => Err(self.unstable(&reason)),
            None => Ok(snapshot),
        }
    }

    /// The end of a run whose result its scene cannot reach.
    fn unstable(&self, reason: &str) -> StepFailure {
        let share = self.sizes.largest / self.sizes.predicted_critical;
        // An implicit skeleton has no critical step to blame.
        let step = match self.plan.schedule.integrator {
            IntegratorKind::SemiImplicit => {
                format!("; the largest step is {share:.3} of the predicted critical one")
            }
            _ => String::new(),
        };
        StepFailure { kind: FailureKind::Unstable, reason: format!("{reason}{step}") }
    }

    fn ask_to_go_on(&self, observer: Observer<'_>) -> Result<(), StepFailure> {
        if observer(self.counters.steps, self.expected) {
            return Ok(());
        }
        Err(StepFailure { kind: FailureKind::Stopped, reason: "stopped from outside".to_owned() })
    }

    fn advance_to<const W: usize, S: ShapeFunction<W>>(
        &mut self,
        output: f64,
        observer: Observer<'_>,
    ) -> Result<(), StepFailure>
    where
        M: March<D, W, S>,
    {
        while output - self.time > 1e-9 * output {
            match self.plan.limit {
                StepLimit::Tolerance { tolerance, .. } => self.adapt_step(output, tolerance, observer)?,
                limit => {
                    let segment = limit.segment(self.time, output);
                    let start = self.time;
                    for step in 1..=segment.count {
                        let end = start + step as f64 * segment.dt;
                        self.take_step(segment.dt, end, f64::INFINITY, observer)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// A step whose size follows the errors of those before it, changed only where that is worth
    /// new factors.
    fn adapt_step<const W: usize, S: ShapeFunction<W>>(
        &mut self,
        output: f64,
        tolerance: f64,
        observer: Observer<'_>,
    ) -> Result<(), StepFailure>
    where
        M: March<D, W, S>,
    {
        let rest = output - self.time;
        let left = steps_for(rest, self.adaptive_step);
        let dt = if left <= 2 { rest / left as f64 } else { self.adaptive_step };
        let end = if left == 1 { output } else { self.time + dt };
        let error = self.take_step(dt, end, tolerance, observer)?;
        let factor = SAFETY * (tolerance / error.max(1e-3 * tolerance)).sqrt();
        if error > tolerance || factor < 1.0 {
            self.adaptive_step = self.adaptive_step.min(dt * factor.max(SMALLEST_CHANGE));
        } else if factor > WORTH_A_CHANGE {
            self.adaptive_step = self.adaptive_step.max(dt * factor.min(LARGEST_CHANGE));
        }
        Ok(())
    }

    /// One step to the time `end`, with all that is noted of it; its estimated error.
    fn take_step<const W: usize, S: ShapeFunction<W>>(
        &mut self,
        dt: f64,
        end: f64,
        most_error: f64,
        observer: Observer<'_>,
    ) -> Result<f64, StepFailure>
    where
        M: March<D, W, S>,
    {
        let before = (self.time, self.march.settlement());
        let advances = end > self.time;
        if !advances {
            return Err(StepFailure {
                kind: FailureKind::NotConverged,
                reason: format!("a step of {dt:.3e} s is too small to advance the time"),
            });
        }
        self.tried += 1;
        if self.tried.is_multiple_of(WATCH_INTERVAL) {
            self.ask_to_go_on(observer)?;
        }
        let error = self.march.step(dt, most_error)?;
        enter(Phase::Outputs);
        if error > most_error {
            return Ok(error);
        }
        self.time = end;
        self.sizes.largest = self.sizes.largest.max(dt);
        self.counters.steps += 1;
        self.counters.point_updates += self.counters.points as u64;
        let after = (self.time, self.march.settlement());
        if let Some(reason) = self.plan.bounds.left_by_settlement(after.1) {
            return Err(self.unstable(&reason));
        }
        self.history.note(before, after, self.march.settlement_rate());
        self.march.lost_point().map_or(Ok(()), Err)?;
        Ok(error)
    }

    fn snapshot<const W: usize, S: ShapeFunction<W>>(&self) -> Snapshot
    where
        M: March<D, W, S>,
    {
        self.march.body_now().snapshot(self.time, self.march.settlement(), &self.start)
    }
}

/// Steps between two calls of the observer.
const WATCH_INTERVAL: u64 = 16;
/// Share of the step that the estimate promises to be accurate enough.
const SAFETY: f64 = 0.9;
/// What a step may shrink to at once.
const SMALLEST_CHANGE: f64 = 0.2;
/// What it may grow to at once.
const LARGEST_CHANGE: f64 = 4.0;
/// Growth that is worth new factors.
const WORTH_A_CHANGE: f64 = 1.4;

/// The settlement at the times that are asked for, from within the steps.
#[derive(Clone, Debug)]
pub struct History<'a> {
    due: &'a [f64],
    /// What has been noted.
    pub noted: Vec<HistoryPoint>,
}

impl<'a> History<'a> {
    /// Nothing noted yet of the times due, s, ascending.
    pub fn of(due: &'a [f64]) -> Self {
        Self { due, noted: Vec::with_capacity(due.len()) }
    }

    /// Notes the times within a step, given time and settlement at its two ends and the rate of
    /// the settlement at its end: a parabola through the three.
    pub fn note(&mut self, before: (f64, f64), after: (f64, f64), rate: f64) {
        let (start, first) = before;
        let (end, last) = after;
        let dt = end - start;
        while let Some(time) = self.due.get(self.noted.len()).filter(|due| **due <= end * (1.0 + 1e-12)) {
            let share = ((time - start) / dt).clamp(0.0, 1.0);
            let settlement =
                first + (last - first) * share * (2.0 - share) + rate * dt * share * (share - 1.0);
            self.noted.push(HistoryPoint { time: *time, settlement });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_noted_exactly_at_every_time_that_is_due() {
        let settlement = |time: f64| 0.3 + 2.0 * time - 0.7 * time * time;
        let rate = |time: f64| 2.0 - 1.4 * time;
        let due = [0.1, 0.15, 0.2, 0.75, 1.0];
        let mut history = History::of(&due);
        // Steps with three times, with none, and with one inside and one at its end.
        for [start, end] in [[0.0, 0.2], [0.2, 0.5], [0.5, 1.0]] {
            history.note((start, settlement(start)), (end, settlement(end)), rate(end));
        }
        assert_eq!(history.noted.len(), due.len());
        for (point, time) in history.noted.iter().zip(due) {
            assert_eq!(point.time, time);
            assert!((point.settlement - settlement(time)).abs() < 1e-15, "{point:?}");
        }
    }
}
