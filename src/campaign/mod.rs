//! Runs the cases of a study in parallel, resumably, with every finished case on disk at once.

pub mod case_run;
pub mod case_runner;
pub mod endless;
pub mod refinement;
pub mod runner;
pub mod shares;
pub mod stop;
pub mod taken_over;
#[cfg(test)]
mod tests;
