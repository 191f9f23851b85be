//! The outcome of a run: its end by name, counters, step sizes and snapshots.

use crate::snapshot::Snapshot;
use oedometer_wording::words;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a run ended before its last output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// Velocities left their physical scale a thousandfold or are not finite, or a settlement or a
    /// pressure is beyond what the scene can reach.
    Unstable,
    /// A point's pores closed: its volume ratio fell to that of the grains.
    PoresClosed,
    /// A point left the grid.
    LeftGrid,
    /// A system of equations, of an implicit step or of a static start, has no unique solution.
    Singular,
    /// The iterations of an implicit step did not come to an end.
    NotConverged,
    /// The run was stopped from outside.
    Stopped,
    /// The run took longer than its study allows.
    TimedOut,
    /// An attached solver could not be started.
    NotStartable,
    /// An attached solver was ended by a signal, and not by this program.
    Killed,
    /// An attached solver ended with an exit code other than 0.
    Failed,
    /// An attached solver says that it cannot run here: exit code 77.
    Skipped,
    /// An attached solver ended well and left no result.
    NoResult,
    /// The result of an attached solver cannot be read as its mapping says.
    Unreadable,
    /// The result of an attached solver holds what is no finite number.
    NotFinite,
    /// The result of an attached solver lacks times or places.
    Incomplete,
}

words!(FailureKind: Unstable "unstable",
    PoresClosed "pores-closed",
    LeftGrid "left-grid",
    Singular "singular",
    NotConverged "not-converged",
    Stopped "stopped",
    TimedOut "timed-out",
    NotStartable "not-startable",
    Killed "killed",
    Failed "failed",
    Skipped "skipped",
    NoResult "no-result",
    Unreadable "unreadable",
    NotFinite "not-finite",
    Incomplete "incomplete",);

impl FailureKind {
    /// Whether it is the end of an attached solver: it lies in programs and files that may have changed since.
    pub fn is_of_attached(self) -> bool {
        match self {
            Self::NotStartable
            | Self::Killed
            | Self::Failed
            | Self::Skipped
            | Self::NoResult
            | Self::Unreadable
            | Self::NotFinite
            | Self::Incomplete => true,
            Self::Unstable
            | Self::PoresClosed
            | Self::LeftGrid
            | Self::Singular
            | Self::NotConverged
            | Self::Stopped
            | Self::TimedOut => false,
        }
    }
}

/// The end of a run that did not reach its last output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Failure {
    /// Name of the failure.
    pub kind: FailureKind,
    /// Step at which it was seen.
    pub step: u64,
    /// Time at which it was seen, s.
    pub time: f64,
    /// Growth a step of the largest velocity when it was last finite.
    #[serde(default)]
    pub growth: Option<f64>,
    /// A sentence with the numbers.
    pub reason: String,
}

impl Failure {
    /// The end of an attached solver, whose steps nobody knows.
    pub fn of_attached(kind: FailureKind, reason: String) -> Self {
        Self { kind, step: 0, time: 0.0, growth: None, reason }
    }

    /// Name of the failure, with the step at which it was seen where that is known.
    pub fn name_with_step(&self) -> String {
        let step = if self.has_place() { format!(" at step {}", self.step) } else { String::new() };
        format!("{}{step}", self.kind.name())
    }

    /// Whether anybody knows the step at which it was seen.
    fn has_place(&self) -> bool {
        self.step > 0 || !(self.kind.is_of_attached() || self.kind == FailureKind::TimedOut)
    }

    /// Step and time at which it was seen, where they are known: ` at step 7, t = 1.0000e-3 s`.
    pub fn place(&self) -> String {
        if self.has_place() {
            format!(" at step {}, t = {:.4e} s", self.step, self.time)
        } else {
            String::new()
        }
    }
}

impl fmt::Display for Failure {
    /// Name, place and reason of the failure.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}{}: {}", self.kind.name(), self.place(), self.reason)
    }
}

/// Work done, in integers: the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Counters {
    /// Material points.
    pub points: usize,
    /// Grid nodes, ghosts included.
    pub nodes: usize,
    /// Time steps.
    pub steps: u64,
    /// Points times steps.
    pub point_updates: u64,
    /// Matrices factored by an implicit integrator.
    #[serde(default)]
    pub factorisations: u64,
    /// Iterations of an implicit integrator's nonlinear solves; a linear problem needs none.
    #[serde(default)]
    pub iterations: u64,
    /// Steps that an implicit integrator took back, for their iterations came to no end or their
    /// error was too large, and took again in smaller ones.
    #[serde(default)]
    pub rejected_steps: u64,
}

/// Step sizes of a run, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StepSizes {
    /// Predicted critical step on the initial configuration.
    pub predicted_critical: f64,
    /// Step the rule asked for.
    pub target: f64,
    /// Largest step taken; outputs are hit exactly, so it is at most the target.
    pub largest: f64,
    /// Smallest critical step of a run whose steps follow the deformation of the body, s; none where it stays that of the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_critical: Option<f64>,
    /// Factor by which the fastest mode grows until the last output under steps of the target, by the eigenvalues of the
    /// step on the initial configuration; none where nothing grows beyond the round-off of the eigenvalues.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
}

/// Settlement at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HistoryPoint {
    /// Time, s.
    pub time: f64,
    /// Settlement of the surface, m.
    pub settlement: f64,
    /// Force, N, of the soil on a plate that is pushed into it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate_force: Option<f64>,
    /// Energy, where waves run and the law has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
}

/// Energy of a body at a time, J: of a unit area in a column, of a unit thickness in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Energy {
    /// Of the motion of grains and water.
    pub kinetic: f64,
    /// Of the strain of the skeleton and of the water.
    pub strain: f64,
}

/// Everything a run leaves behind.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// End of the run.
    pub status: Result<(), Failure>,
    /// State at the start.
    pub start: Snapshot,
    /// State at the output times that were reached.
    pub snapshots: Vec<Snapshot>,
    /// Settlement over time.
    pub history: Vec<HistoryPoint>,
    /// Work.
    pub counters: Counters,
    /// Step sizes.
    pub step_sizes: StepSizes,
}
