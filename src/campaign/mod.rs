//! Runs the cases of a study: in parallel, resumable, every finished case on disk at once.

pub mod case_run;
pub mod case_runner;
pub mod cpu_clock;
pub mod deadline;
pub mod run_options;
pub mod run_report;
pub mod runner;
pub mod timing;
