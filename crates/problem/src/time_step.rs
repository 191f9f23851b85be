//! The rule by which steps are chosen, and how large it lets them be.

use oedometer_soil::elementary;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Rule by which the time step is chosen: one of [`STEP_KINDS`] with a number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TimeStep {
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

/// A kind of rule: its word in study files and labels, what it makes of a number, and the least number with which a run
/// comes to an end, with the reason.
#[derive(Clone, Copy, Debug)]
pub struct StepKind {
    /// Word.
    pub word: &'static str,
    /// The rule with a number.
    pub make: fn(f64) -> TimeStep,
    /// Least number.
    pub least: f64,
    /// Why not a smaller one.
    pub why: &'static str,
}

/// The kinds in the order of a table's keys.
pub static STEP_KINDS: [StepKind; 5] = [
    StepKind { word: "stable", make: TimeStep::Stable, least: 1e-9, why: NO_ERROR_LEFT },
    StepKind { word: "courant", make: TimeStep::Courant, least: 1e-9, why: NO_ERROR_LEFT },
    StepKind { word: "seconds", make: TimeStep::Seconds, least: 0.0, why: "" },
    StepKind {
        word: "growth",
        make: TimeStep::Growth,
        least: 1e-9,
        why: "a smaller growth needs too many steps",
    },
    StepKind {
        word: "tolerance",
        make: TimeStep::Tolerance,
        least: 1e-12,
        why: "round-off errors are of that size",
    },
];
const NO_ERROR_LEFT: &str = "smaller steps no longer reduce the error in time";

impl fmt::Display for TimeStep {
    /// As the command line takes it: `stable=0.8`.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = self.kind().word;
        match self {
            Self::Stable(number) | Self::Courant(number) | Self::Growth(number) => {
                write!(out, "{word}={number}")
            }
            Self::Seconds(number) | Self::Tolerance(number) => write!(out, "{word}={number:e}"),
        }
    }
}

impl TimeStep {
    /// Its kind.
    pub fn kind(&self) -> &'static StepKind {
        &STEP_KINDS[match self {
            Self::Stable(_) => 0,
            Self::Courant(_) => 1,
            Self::Seconds(_) => 2,
            Self::Growth(_) => 3,
            Self::Tolerance(_) => 4,
        }]
    }

    /// Its number: of two rules of a kind the larger one takes the longer steps.
    pub fn number(self) -> f64 {
        let (Self::Stable(number)
        | Self::Courant(number)
        | Self::Seconds(number)
        | Self::Growth(number)
        | Self::Tolerance(number)) = self;
        number
    }

    /// The rule of the same kind with another number.
    #[must_use]
    pub fn with_number(self, number: f64) -> Self {
        (self.kind().make)(number)
    }

    /// The step, s, that it asks for at first.
    pub fn first(&self, scales: &StepScales) -> f64 {
        match self {
            Self::Stable(share) => share * scales.critical,
            Self::Courant(share) => share * scales.cell_size / scales.wave_speed,
            Self::Seconds(seconds) => *seconds,
            Self::Growth(growth) => growth * scales.diffusion(),
            Self::Tolerance(tolerance) => tolerance.sqrt().min(0.1) * scales.diffusion(),
        }
    }

    /// The steps of a run, of at most `most` seconds: where they grow, the first ones resolve the first output as the
    /// later ones theirs.
    pub fn steps(&self, scales: &StepScales, outputs: &[f64], most: f64) -> Steps {
        let target = self.first(scales);
        match self {
            Self::Stable(_) | Self::Courant(_) | Self::Seconds(_) => Steps::Constant(target),
            Self::Growth(growth) => {
                let first = outputs.iter().copied().find(|output| *output > 0.0);
                let start = first.unwrap_or(f64::INFINITY).min(scales.diffusion());
                Steps::Growing { first: growth * start, growth: *growth, most }
            }
            Self::Tolerance(tolerance) => Steps::Tolerance { first: target, tolerance: *tolerance },
        }
    }
}

/// What a rule measures steps by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepScales {
    /// Critical step, s.
    pub critical: f64,
    /// Cell size `h`, m.
    pub cell_size: f64,
    /// Speed `c` of the fastest wave, m/s.
    pub wave_speed: f64,
    /// Largest coefficient of consolidation `c_v`, m²/s.
    pub consolidation: f64,
}

impl StepScales {
    /// Time, s, in which pressure diffuses through a cell, `h²/c_v`: nothing earlier is resolved.
    fn diffusion(&self) -> f64 {
        self.cell_size * self.cell_size / self.consolidation
    }
}

/// Some of a row of equal steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EqualSteps {
    /// Time at which the row starts, s.
    pub start: f64,
    /// Size, s.
    pub dt: f64,
    /// Steps of the row that are behind these.
    pub done: u64,
    /// Number of steps.
    pub count: u64,
}

impl EqualSteps {
    /// The first steps of a row that starts at a time.
    pub fn first(start: f64, dt: f64, count: u64) -> Self {
        Self { start, dt, done: 0, count }
    }

    /// The next `count` steps after these.
    #[must_use]
    pub fn next(&self, count: u64) -> Self {
        Self { done: self.done + self.count, count, ..*self }
    }

    /// Time after so many of these steps, s.
    #[inline]
    pub fn time_after(&self, steps: u64) -> f64 {
        self.start + (self.done + steps) as f64 * self.dt
    }

    /// Time after all of them, s.
    pub fn end(&self) -> f64 {
        self.time_after(self.count)
    }
}

/// Step sizes grow by this factor from one level to the next.
const LEVEL_RATIO: f64 = std::f64::consts::SQRT_2;

/// What becomes of a rule in a run: the limit of the step size at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// One step size at all times, s.
    Constant(f64),
    /// `max(Δt₀, α t)`: consolidation slows down as the square root of time, and so may the steps.
    Growing {
        /// `Δt₀`, s.
        first: f64,
        /// `α`.
        growth: f64,
        /// Largest step, s.
        most: f64,
    },
    /// Bound on the estimated error of a step.
    Tolerance {
        /// The first step, s.
        first: f64,
        /// Error that a step may have.
        tolerance: f64,
    },
}

impl Steps {
    /// The steps to take next from `time` towards `output`: of one size, which is at most the
    /// limit wherever it is taken, and that end at `output` or where larger ones may begin.
    pub fn row(&self, time: f64, output: f64) -> EqualSteps {
        let (size, end) = match *self {
            Self::Constant(size) => (size, output),
            // The driver adapts the size from here on.
            Self::Tolerance { first, .. } => (first, output),
            Self::Growing { first, growth, most } => {
                let allowed = (growth * time).max(first).min(most);
                // A time that is a level's beginning up to round-off is in that level.
                let level = (elementary::ln(allowed / first) / elementary::ln(LEVEL_RATIO) + 1e-9).floor();
                let size = first * elementary::powf(LEVEL_RATIO, level);
                let grown =
                    if size * LEVEL_RATIO > most { f64::INFINITY } else { size * LEVEL_RATIO / growth };
                // No row of its own for the last step to an output.
                (size, if output < grown + size { output } else { grown })
            }
        };
        let count = steps_for(end - time, size);
        EqualSteps::first(time, (end - time) / count as f64, count)
    }

    /// Steps from the start to `end`, without the outputs in between.
    pub fn expected_steps(&self, end: f64) -> u64 {
        if let Self::Tolerance { tolerance, .. } = self {
            return steps_for(10.0, tolerance.sqrt());
        }
        let (mut time, mut steps) = (0.0, 0_u64);
        while end - time > 1e-9 * end {
            let row = self.row(time, end);
            let next = row.end();
            steps = steps.saturating_add(row.count);
            // Times at the edge of the numbers: what no longer advances is endless.
            let advances = next > time;
            if !advances {
                return u64::MAX;
            }
            time = next;
        }
        steps
    }
}

/// Equal steps of at most `step` that fill a duration; at least one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates, and that is the right end"
)]
pub fn steps_for(duration: f64, step: f64) -> u64 {
    // A duration that is a whole number of steps up to round-off is that number.
    ((duration / step) * (1.0 - 1e-12)).ceil().max(1.0) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn growing_steps_keep_to_their_limit_and_come_in_few_sizes(
            growth in 0.005..0.5_f64, first in 1e-6..1e-2_f64,
        ) {
            let limit = Steps::Growing { first, growth, most: f64::INFINITY };
            let outputs = [0.05, 0.1, 1.0];
            let (mut time, mut sizes, mut steps) = (0.0, 0, 0);
            for output in outputs {
                while output - time > 1e-9 * output {
                    let row = limit.row(time, output);
                    // Levels are powers, so a last step may exceed the limit by less than one.
                    prop_assert!(row.dt <= (growth * time).max(first) * (1.0 + 1e-9));
                    time += row.count as f64 * row.dt;
                    sizes += 1;
                    steps += row.count;
                }
                prop_assert!((time / output - 1.0).abs() < 1e-9);
            }
            let levels = ((growth / first).max(1.0).ln() / LEVEL_RATIO.ln()).ceil() + 6.0;
            prop_assert!(f64::from(sizes) <= levels, "{sizes} sizes for {levels} levels");
            // Not many more than the limit itself would take.
            let least = 1.0 / growth + (growth / first).max(1.0).ln() / growth.ln_1p();
            prop_assert!(steps as f64 <= 1.35 * least + 2.0 * f64::from(sizes) + 1.0 / first.max(0.5));
        }
    }

    #[test]
    fn constant_steps_fill_the_interval() {
        assert_eq!(Steps::Constant(0.3).row(0.1, 1.0), EqualSteps::first(0.1, 0.3, 3));
        assert_eq!(Steps::Constant(0.4).row(0.0, 1.0).count, 3);
        assert_eq!(Steps::Constant(0.25).expected_steps(1.0), 4);
    }

    #[test]
    fn growing_steps_stop_at_their_largest_size() {
        let limit = Steps::Growing { first: 1e-3, growth: 0.1, most: 7e-3 };
        let (mut time, mut largest) = (0.0, 0.0_f64);
        // After the first output a tenth of the time is far more.
        for output in [1.0, 2.0] {
            while output - time > 1e-9 {
                let row = limit.row(time, output);
                largest = largest.max(row.dt);
                time = row.end();
            }
        }
        // Levels of a root of two from the first: the last below 7e-3 is 5.66e-3.
        assert!(largest <= 7e-3 && largest > 5e-3, "{largest:e}");
    }

    #[test]
    fn a_rule_is_its_kind_with_its_number() {
        for kind in &STEP_KINDS {
            let rule = (kind.make)(0.25);
            assert_eq!((rule.kind().word, rule.number()), (kind.word, 0.25));
            assert_eq!(rule.with_number(0.5), (kind.make)(0.5));
            assert!(rule.to_string().starts_with(&format!("{}=", kind.word)), "{rule}");
        }
    }
}
