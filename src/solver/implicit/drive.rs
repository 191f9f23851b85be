//! A run by an implicit integrator: from output to output, with snapshots and history.

use super::linear::LinearMarch;
use super::steps::StepLimit;
use crate::solver::body::{Body, ShapeFunction};
use crate::solver::outcome::{Counters, Failure, FailureKind, HistoryPoint, Outcome, RunStatus, StepSizes};
use crate::solver::run::{Observer, Schedule};
use crate::solver::snapshot::Snapshot;

/// Solves a frozen body, quasi-static.
pub fn run_linear<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    schedule: &Schedule,
    limit: StepLimit,
    sizes: StepSizes,
    start_failure: Option<Failure>,
    observer: Observer<'_>,
) -> Outcome {
    let march = LinearMarch::new(body);
    let settled = -body.surface.amplitude_of(&body.grid, &body.points, &body.nodes.displacement);
    let mut run = LinearRun {
        counters: Counters { points: body.points.len(), nodes: body.nodes.len(), ..Counters::default() },
        body,
        march,
        settled,
        time: 0.0,
        sizes,
        history: History::of(&schedule.history),
        expected: limit.expected_steps(schedule.outputs.last().copied().unwrap_or(0.0)),
    };
    let start = run.snapshot();
    let mut snapshots = Vec::new();
    let mut status = start_failure.map_or(RunStatus::Ok, RunStatus::Failed);
    for output in &schedule.outputs {
        if status != RunStatus::Ok {
            break;
        }
        if let Err(failure) = run.advance_to(*output, limit, observer) {
            status = RunStatus::Failed(failure);
            break;
        }
        snapshots.push(run.snapshot());
    }
    run.counters.factorisations = run.march.factorisations;
    Outcome {
        status,
        start,
        snapshots,
        history: run.history.noted,
        counters: run.counters,
        step_sizes: run.sizes,
    }
}

struct LinearRun<'a, const D: usize, const W: usize, S: ShapeFunction<W>> {
    body: &'a Body<D, W, S>,
    march: LinearMarch<D>,
    /// Settlement of the start, m.
    settled: f64,
    time: f64,
    sizes: StepSizes,
    counters: Counters,
    history: History<'a>,
    expected: u64,
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> LinearRun<'_, D, W, S> {
    fn advance_to(&mut self, output: f64, limit: StepLimit, observer: Observer<'_>) -> Result<(), Failure> {
        while output - self.time > 1e-9 * output {
            let segment = limit.segment(self.time, output);
            self.sizes.largest = self.sizes.largest.max(segment.dt);
            self.march.set_step(segment.dt).map_err(|singular| {
                let reason = format!(
                    "the matrix of a step of {:.4e} s has no pivot in row {}",
                    segment.dt, singular.row
                );
                self.failure(FailureKind::Singular, reason)
            })?;
            let start = self.time;
            for step in 1..=segment.count {
                let before = (self.time, self.settlement());
                self.march.step();
                self.time = start + step as f64 * segment.dt;
                self.counters.steps += 1;
                let velocity = -self.march.surface_velocity();
                self.history.note(before, (self.time, self.settlement()), velocity);
            }
            self.counters.point_updates += segment.count * self.counters.points as u64;
            if !self.march.is_finite() {
                return Err(self.failure(FailureKind::Unstable, "an unknown is no number".to_owned()));
            }
            if !observer(self.counters.steps, self.expected) {
                return Err(self.failure(FailureKind::Stopped, "stopped from outside".to_owned()));
            }
        }
        Ok(())
    }

    fn settlement(&self) -> f64 {
        self.settled - self.march.surface_displacement()
    }

    fn snapshot(&self) -> Snapshot {
        self.march.body_now(self.body).snapshot(self.time, self.settlement(), &self.body.points)
    }

    fn failure(&self, kind: FailureKind, reason: String) -> Failure {
        Failure { kind, step: self.counters.steps, time: self.time, reason }
    }
}

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
