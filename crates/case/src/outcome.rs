//! The narrow interface: whatever solves cases, and what it leaves of one. Campaigns, records, judgements and pages know cases and
//! outcomes alone.

use crate::machine::Machine;
use crate::{Case, Sample};
use oedometer_exact::exact_error::ExactError;
use oedometer_problem::critical_step::CriticalStep;
use oedometer_problem::outcome::{Counters, Failure, FailureKind, HistoryPoint, StepSizes};
use oedometer_problem::snapshot::Snapshot;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Solves cases: a method of this program, a program that a study attaches, a result that lies there, or yours.
pub trait Solver: Sync {
    /// Solves a case. A failure is an outcome too.
    ///
    /// # Errors
    /// When the numbers of the case are such that nothing can solve it.
    fn solve(&self, case: &Case, course: &Course<'_>) -> Result<Outcome, ExactError>;

    /// How an earlier outcome relates to the present solver, by what identifies the program that made it; for this
    /// program, its sources.
    fn standing(&self, earlier: Option<&AttachedRun>) -> Standing {
        let _ = earlier;
        Standing::Proven
    }
}

impl<S: Solver + ?Sized> Solver for &S {
    fn solve(&self, case: &Case, course: &Course<'_>) -> Result<Outcome, ExactError> {
        (**self).solve(case, course)
    }

    fn standing(&self, earlier: Option<&AttachedRun>) -> Standing {
        (**self).standing(earlier)
    }
}

/// What an earlier outcome is to the solver of now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It is what the solver of now would leave.
    Proven,
    /// Nothing says whether it is.
    Unproven,
    /// Another solver left it, or it is read anew at no cost.
    Outdated,
}

/// How a case is to be solved, which changes nothing of the result.
#[derive(Clone, Copy)]
pub struct Course<'a> {
    /// Threads that it may use.
    pub threads: usize,
    /// Whether nothing else competes for the cores meanwhile.
    pub alone: bool,
    /// Longest wall time, s.
    pub seconds: f64,
    /// Folder of the case's record, beside which files of the run may be kept; `None` if none are kept.
    pub place: Option<&'a Path>,
    /// Takes work done and expected, and says whether the case is still wanted.
    pub observe: &'a dyn Fn(u64, u64) -> bool,
}

impl Course<'_> {
    /// Alone, on one thread, as long as it takes, with nothing kept.
    pub fn alone() -> Self {
        Self { threads: 1, alone: true, seconds: f64::INFINITY, place: None, observe: &|_, _| true }
    }

    /// Whether the case is still wanted.
    pub fn is_wanted(&self) -> bool {
        (self.observe)(0, 1)
    }
}

/// What a solver leaves of a case.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// A state at each output, in their order; none where it failed.
    pub snapshots: Vec<Snapshot>,
    /// Kind of the places of its states where it has one only; points, centres and nodes of a solver that has all.
    pub sample: Option<Sample>,
    /// Sizes of its steps, s, as far as they are known.
    pub steps: StepSizes,
    /// What only a solver within this program knows.
    pub inside: Option<Inside>,
    /// What is known of a program that made it.
    pub foreign: Option<AttachedRun>,
    /// Wall times.
    pub wall: Vec<WallSample>,
}

/// What only a solver within this program knows of its run.
#[derive(Clone, Debug)]
pub struct Inside {
    /// Work done.
    pub counters: Counters,
    /// The state at the start.
    pub start: Option<Snapshot>,
    /// Settlements over time.
    pub history: Vec<HistoryPoint>,
    /// The critical step, where that was the question.
    pub critical_step: Option<CriticalStep>,
}

impl Outcome {
    /// States at the outputs of a case, from a solver that says no more. Places without volumes stand for equal ones.
    pub fn of_states(mut snapshots: Vec<Snapshot>, sample: Sample) -> Self {
        for state in &mut snapshots {
            for samples in [&mut state.points, &mut state.centres, &mut state.nodes] {
                if samples.volume.is_empty() {
                    samples.volume = vec![1.0; samples.initial_height.len()];
                }
            }
        }
        Self { sample: Some(sample), snapshots, ..Self::of_end(Status::Ok) }
    }

    /// The end of a case that failed.
    pub fn of_failure(failure: Failure) -> Self {
        Self::of_end(Status::Failed(failure))
    }

    /// The same with the sizes of its steps.
    #[must_use]
    pub fn with_steps(self, steps: StepSizes) -> Self {
        Self { steps, ..self }
    }

    /// The same with what only a solver within this program knows.
    #[must_use]
    pub fn with_inside(self, inside: Inside) -> Self {
        Self { inside: Some(inside), ..self }
    }

    /// The same with what is known of the program that made it.
    #[must_use]
    pub fn made_by(self, program: AttachedRun) -> Self {
        Self { foreign: Some(program), ..self }
    }

    /// The same with its wall times.
    #[must_use]
    pub fn timed(self, wall: Vec<WallSample>) -> Self {
        Self { wall, ..self }
    }

    /// An end without states.
    pub fn of_end(status: Status) -> Self {
        Self {
            status,
            snapshots: Vec::new(),
            sample: None,
            steps: StepSizes::default(),
            inside: None,
            foreign: None,
            wall: Vec::new(),
        }
    }
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Every output reached.
    Ok,
    /// Ended before, by name.
    Failed(Failure),
}

impl Status {
    /// Whether the case ran out of its time.
    pub fn is_late(&self) -> bool {
        self.failure().is_some_and(|failure| failure.kind == FailureKind::TimedOut)
    }

    /// Whether another run may end otherwise: the time was too short, or an attached solver failed.
    pub fn is_worth_another_run(&self) -> bool {
        self.is_late() || self.failure().is_some_and(|failure| failure.kind.is_of_attached())
    }

    /// Whether an attached solver says that it cannot run here.
    pub fn is_skipped(&self) -> bool {
        self.failure().is_some_and(|failure| failure.kind == FailureKind::Skipped)
    }

    /// How it failed, if it did.
    pub fn failure(&self) -> Option<&Failure> {
        match self {
            Self::Ok => None,
            Self::Failed(failure) => Some(failure),
        }
    }

    /// `ok`, or the failure's name.
    pub fn name(&self) -> &'static str {
        self.failure().map_or("ok", |failure| failure.kind.name())
    }
}

/// One wall time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WallSample {
    /// Seconds of wall time.
    pub seconds: f64,
    /// Whether nothing else of this program ran meanwhile; only such samples are compared.
    pub alone: bool,
    /// Seconds that the processor worked on it, if the system reports it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cpu_seconds: Option<f64>,
    /// Where it ran, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// Largest memory of an attached solver, bytes, if the system reports it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_memory: Option<u64>,
    /// Runnable processes when an attached solver began, if the system reports it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    /// Time that an attached solver says it took, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_seconds: Option<f64>,
}

/// What is known of the run of an attached solver beside its result. What changes from run to run at the same result, like
/// times, is kept with the wall times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct AttachedRun {
    /// The command as the study has it, with its placeholders.
    pub command: Vec<String>,
    /// What it says of its version, where it was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Digest of all by which its program is known, where the study declares that it is: the program that the command
    /// starts, the files that command and environment name, those in `known_by`, and the output of the version command.
    /// None where one of them cannot be read, or changed while it ran.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program_digest: Option<String>,
    /// Commit that the repository of the study was at when it was run, and whether files had changed since.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// Whether it was run once before it was timed.
    #[serde(default)]
    pub warmed_up: bool,
    /// Kind of the places of its result, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<Sample>,
    /// What of the result was taken from where.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub taken: Vec<String>,
    /// Digest of the content of the result's files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result_digest: Option<String>,
    /// Largest difference between the results of repeats, over the largest value of its field; `None` after a
    /// single run. Results at different places are reported in a note.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeats_differ_by: Option<f64>,
    /// What is odd about the run and fails nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// The last lines that it said, of a run that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub last_words: Vec<String>,
}

impl AttachedRun {
    /// What made the result: version, program and commit, as far as they are known.
    pub fn made_by(&self) -> String {
        if self.command.is_empty() {
            return "existing files".to_owned();
        }
        let version = self.version.as_ref().map(|version| format!("`{version}`"));
        let program = self.program_digest.as_ref().map_or_else(
            || format!("`{}`", self.command.join(" ")),
            |digest| format!("program {}", digest.chars().take(8).collect::<String>()),
        );
        let commit = self.commit.as_ref().map(|commit| format!("at commit {commit}"));
        let known: Vec<String> = [version, Some(program), commit].into_iter().flatten().collect();
        known.join(", ")
    }
}
