//! Studies: what was typed (`file`), what will run (`check`, `sweep`, `case`, `tier`), and the runner.

mod case;
pub mod case_expectation;
mod check;
mod deadline;
mod diagnostic;
mod expectation;
mod file;
mod name;
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
pub use name::{name_of, refused_name};
pub use perturbed::LastDigit;
pub use runner::{
    Progress, RunError, RunOptions, RunReport, Selected, Shard, TimingReport, estimated_updates, run_case,
    run_case_within, run_studies, run_study, time_study,
};
pub use shipped::shipped_studies;
pub use sweep::AXES;
pub use tier::Tier;
