//! Runs the cases of a study in parallel, resumably, with every finished case on disk at once.

pub mod case_run;
pub mod case_runner;
mod clock;
pub mod run_report;
pub mod runner;
pub mod shares;
pub mod stop;
