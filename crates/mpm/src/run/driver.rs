//! The driver of every run: steps from output to output, with snapshots, history and checks.

use crate::integrate::run_plan::Plan;
use crate::integrate::schedule::Observer;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper};
use crate::run::watch::Watch;
use oedometer_problem::outcome::{Counters, Energy, Failure, FailureKind, HistoryPoint, Outcome, StepSizes};
use oedometer_problem::snapshot::Snapshot;
use oedometer_problem::time_step::{Steps, steps_for};

/// Steps after which deforming points are given a new step size: the pores at the drained end close within a hundred.
const STEP_RENEWAL: u64 = 32;
/// Share of the critical step beyond which a step is renewed earlier at first: it is beyond the critical one before.
const NEAR_CRITICAL: f64 = 0.9;
/// Share of the step that the estimate promises to be accurate enough.
const SAFETY: f64 = 0.9;
/// Smallest ratio of a step to the one before.
const SMALLEST_CHANGE: f64 = 0.2;
/// Largest ratio of a step to the one before.
const LARGEST_CHANGE: f64 = 4.0;
/// Share of an error that is left by a step of a fifth at most where the error is one of the start.
const STAYS: f64 = 0.7;
/// Growth that is worth new factors.
const WORTH_A_CHANGE: f64 = 1.4;

/// A run on its way.
pub struct Driver<'a> {
    stepper: &'a mut dyn Stepper,
    plan: &'a Plan<'a>,
    observer: Observer<'a>,
    watch: Watch<'a>,
    history: History<'a>,
    time: f64,
    sizes: StepSizes,
    counters: Counters,
    /// Number of steps announced to the observer.
    expected: u64,
    /// Step size by the errors of the steps so far, s.
    adaptive_step: f64,
    /// Error of the last step that was tried from the start and not taken.
    rejected_start: Option<f64>,
}

impl<'a> Driver<'a> {
    /// A run at its start.
    pub fn new(stepper: &'a mut dyn Stepper, plan: &'a Plan<'a>, observer: Observer<'a>) -> Self {
        let end = plan.schedule.outputs.last().copied().unwrap_or(0.0);
        Self {
            watch: Watch::new(plan),
            history: History::new(&plan.schedule.history),
            time: 0.0,
            sizes: plan.sizes,
            counters: Counters { points: plan.points, nodes: plan.nodes, ..Counters::default() },
            expected: plan.steps.expected_steps(end),
            adaptive_step: plan.sizes.target,
            rejected_start: None,
            stepper,
            plan,
            observer,
        }
    }

    /// Steps from output to output, unless the start failed.
    pub fn solve(mut self, start_failure: Option<Failure>) -> Outcome {
        let start = self.stepper.snapshot(0.0);
        self.watch.begin(&start);
        let mut snapshots = Vec::new();
        let mut status = start_failure.map_or(Ok(()), Err);
        for output in &self.plan.schedule.outputs {
            if status.is_err() {
                break;
            }
            match self.output_at(*output) {
                Ok(snapshot) => snapshots.push(snapshot),
                Err(StepFailure { kind, reason }) => {
                    let (step, growth) = (self.counters.steps, self.watch.growth());
                    status = Err(Failure { kind, step, time: self.time, growth, reason });
                }
            }
        }
        let work = self.stepper.work();
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
    fn output_at(&mut self, output: f64) -> Result<Snapshot, StepFailure> {
        self.ask_to_go_on()?;
        while output - self.time > 1e-9 * output {
            match self.plan.steps {
                Steps::Tolerance { tolerance, .. } => self.adapt_step(output, tolerance)?,
                limit => {
                    let row = self.next_row(limit, output);
                    self.take_row(&row)?;
                }
            }
        }
        let snapshot = self.stepper.snapshot(self.time);
        self.watch.look_at_output(self.stepper, &snapshot.points.pressure, &self.sizes)?;
        Ok(snapshot)
    }

    fn ask_to_go_on(&self) -> Result<(), StepFailure> {
        if (self.observer)(self.counters.steps, self.expected) {
            return Ok(());
        }
        Err(StepFailure { kind: FailureKind::Stopped, reason: "stopped from outside".to_owned() })
    }

    /// The next steps of one size towards `output`.
    fn next_row(&mut self, limit: Steps, output: f64) -> EqualSteps {
        let Some(reduction) = self.stepper.step_reduction() else { return limit.row(self.time, output) };
        if reduction < 1.0 {
            let critical = self.sizes.predicted_critical * reduction;
            let smallest = self.sizes.smallest_critical.map_or(critical, |before| before.min(critical));
            self.sizes.smallest_critical = Some(smallest);
        }
        let row = Steps::Constant(self.sizes.target * reduction).row(self.time, output);
        let is_near = self.sizes.target > NEAR_CRITICAL * self.sizes.predicted_critical;
        let first =
            if is_near { Watch::steps_to_look(self.counters.steps, STEP_RENEWAL) } else { STEP_RENEWAL };
        EqualSteps { count: row.count.min(first), ..row }
    }

    /// Makes a row of steps, with a look after every few.
    fn take_row(&mut self, row: &EqualSteps) -> Result<(), StepFailure> {
        let mut some = EqualSteps { count: 0, ..*row };
        let mut left = row.count;
        while left > 0 {
            let to_look = Watch::steps_to_look(self.counters.steps, self.stepper.steps_unwatched());
            let to_history =
                self.history.next_due().map_or(u64::MAX, |due| steps_for(due - self.time, row.dt));
            some = some.next(to_look.min(to_history).min(left));
            left -= some.count;
            self.take(&some, f64::INFINITY)?;
        }
        Ok(())
    }

    /// A step whose size follows the errors of those before it, changed only where that is worth
    /// new factors.
    fn adapt_step(&mut self, output: f64, tolerance: f64) -> Result<(), StepFailure> {
        let rest = output - self.time;
        let left = steps_for(rest, self.adaptive_step);
        let dt = if left <= 2 { rest / left as f64 } else { self.adaptive_step };
        // An error of the first step that a smaller step does not reduce is not an error in time: the start is out of
        // balance, by points off their lattice say, and the first step takes that up whatever its size.
        let jumps = |last: f64, error: f64| error > STAYS * last;
        let step = EqualSteps::first(self.time, dt, 1);
        let mut error = self.take(&step, tolerance)?;
        if error > tolerance && self.time == 0.0 {
            if self.rejected_start.is_some_and(|last| jumps(last, error)) {
                self.take(&step, f64::INFINITY)?;
                error = tolerance;
            }
            self.rejected_start = Some(error);
        }
        let factor = SAFETY * (tolerance / error.max(1e-3 * tolerance)).sqrt();
        if error > tolerance || factor < 1.0 {
            self.adaptive_step = self.adaptive_step.min(dt * factor.max(SMALLEST_CHANGE));
        } else if factor > WORTH_A_CHANGE {
            self.adaptive_step = self.adaptive_step.max(dt * factor.min(LARGEST_CHANGE));
        }
        if left == 1 && error <= tolerance {
            self.time = output;
        }
        Ok(())
    }

    /// Takes steps with a look at their end, and notes what is due within the last of them; their
    /// estimated error.
    fn take(&mut self, steps: &EqualSteps, most_error: f64) -> Result<f64, StepFailure> {
        let (end, dt) = (steps.end(), steps.dt);
        let advances = end > self.time;
        if !advances {
            return Err(StepFailure {
                kind: FailureKind::NotConverged,
                reason: format!("a step of {dt:.3e} s is too small to advance the time"),
            });
        }
        let mut last = *steps;
        let is_due = self.history.next_due().is_some_and(|due| due <= end * (1.0 + 1e-12));
        if is_due && steps.count > 1 {
            let most = EqualSteps { count: steps.count - 1, ..*steps };
            self.stepper.advance(&most, most_error)?;
            (self.time, last) = (most.end(), most.next(1));
        }
        let with_energy = is_due && self.plan.schedule.notes_energy;
        let before = is_due.then(|| noted(self.stepper, self.time, with_energy));
        let error = self.stepper.advance(&last, most_error)?;
        if error > most_error {
            self.ask_to_go_on()?;
            return Ok(error);
        }
        self.time = end;
        self.sizes.largest = self.sizes.largest.max(dt);
        self.counters.steps += steps.count;
        self.counters.point_updates += steps.count * self.counters.points as u64;
        let after = noted(self.stepper, end, with_energy);
        self.watch.look(self.stepper, after.settlement, steps, &self.sizes)?;
        if let Some(before) = before {
            self.history.note(before, after, self.stepper.settlement_rate());
        }
        self.ask_to_go_on()?;
        Ok(error)
    }
}

/// What is noted at one end of a step.
fn noted(stepper: &dyn Stepper, time: f64, with_energy: bool) -> HistoryPoint {
    let energy = if with_energy { stepper.energy_now() } else { None };
    HistoryPoint { time, settlement: stepper.settlement(), plate_force: stepper.plate_force(), energy }
}

/// Times that are due and the settlements noted so far.
#[derive(Clone, Debug)]
pub struct History<'a> {
    due: &'a [f64],
    /// The samples so far.
    pub noted: Vec<HistoryPoint>,
}

impl<'a> History<'a> {
    /// A history without samples, for ascending times `due`, s.
    pub fn new(due: &'a [f64]) -> Self {
        Self { due, noted: Vec::with_capacity(due.len()) }
    }

    /// The next time that is due, s.
    pub fn next_due(&self) -> Option<f64> {
        self.due.get(self.noted.len()).copied()
    }

    /// Notes the times within a step, given its two ends and the rate of the settlement at the later
    /// one: a parabola through the three. Without a rate the settlement goes straight, and so do a force and an energy.
    pub fn note(&mut self, before: HistoryPoint, after: HistoryPoint, rate: Option<f64>) {
        let (first, last) = (before.settlement, after.settlement);
        let dt = after.time - before.time;
        let rate = rate.unwrap_or((last - first) / dt);
        while let Some(time) = self.next_due().filter(|due| *due <= after.time * (1.0 + 1e-12)) {
            let share = ((time - before.time) / dt).clamp(0.0, 1.0);
            let settlement =
                first + (last - first) * share * (2.0 - share) + rate * dt * share * (share - 1.0);
            let forces = before.plate_force.zip(after.plate_force);
            let straight = |first: f64, last: f64| first + share * (last - first);
            let plate_force = forces.map(|(first, last)| straight(first, last));
            let energy = before.energy.zip(after.energy).map(|(first, last)| Energy {
                kinetic: straight(first.kinetic, last.kinetic),
                strain: straight(first.strain, last.strain),
            });
            self.noted.push(HistoryPoint { time, settlement, plate_force, energy });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_recorded_exactly_at_every_time_that_is_due() {
        let settlement = |time: f64| 0.3 + 2.0 * time - 0.7 * time * time;
        let rate = |time: f64| 2.0 - 1.4 * time;
        let due = [0.1, 0.15, 0.2, 0.75, 1.0];
        let mut history = History::new(&due);
        let at = |time: f64| HistoryPoint {
            time,
            settlement: settlement(time),
            plate_force: Some(2.0 * time),
            energy: Some(Energy { kinetic: 3.0 * time, strain: 5.0 - time }),
        };
        // Steps with three times, with none, and with one inside and one at its end.
        for [start, end] in [[0.0, 0.2], [0.2, 0.5], [0.5, 1.0]] {
            history.note(at(start), at(end), Some(rate(end)));
        }
        assert_eq!(history.noted.len(), due.len());
        for (point, time) in history.noted.iter().zip(due) {
            assert_eq!(point.time, time);
            assert!((point.settlement - settlement(time)).abs() < 1e-15, "{point:?}");
            assert!(point.plate_force.is_some_and(|force| (force - 2.0 * time).abs() < 1e-15), "{point:?}");
            let Energy { kinetic, strain } = point.energy.expect("noted at both ends");
            assert!((kinetic - 3.0 * time).abs() + (strain - 5.0 + time).abs() < 1e-14, "{point:?}");
        }
    }

    #[test]
    fn without_a_rate_the_settlement_is_interpolated_linearly() {
        let due = [0.25];
        let mut history = History::new(&due);
        let [before, after] = [(0.0, 1.0), (1.0, 3.0)].map(|(time, settlement)| HistoryPoint {
            time,
            settlement,
            plate_force: None,
            energy: None,
        });
        history.note(before, after, None);
        assert_eq!(
            history.noted,
            [HistoryPoint { time: 0.25, settlement: 1.5, plate_force: None, energy: None }]
        );
    }
}
