//! Studies: what was typed (`file`), what will run (`check`, `sweep`, `case`, `tier`), and the runner.

mod case;
mod check;
mod diagnostic;
mod expectation;
mod file;
mod perturbed;
mod runner;
mod shipped;
mod sweep;
mod tier;

pub use crate::solver::integrator::IntegratorKind;
pub use case::{Case, Task, step_label};
pub use check::{Purpose, Study};
pub use diagnostic::{Diagnostic, StudyError};
pub use expectation::{Axis, Expectation, Measure, NEXT_FINER, NO_REFERENCE};
pub use file::StudySource;
pub(crate) use file::{MethodTable, StudyFile};
pub use perturbed::LastDigit;
pub use runner::{
    Progress, RunError, RunOptions, RunReport, Selected, Shard, TimingReport, deadline_of, estimated_updates,
    named_if_late, run_case, run_studies, run_study, time_study,
};
pub use shipped::shipped_studies;
pub use sweep::AXES;
pub use tier::Tier;
