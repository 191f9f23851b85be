//! Somebody else's solver, run on a case: what it is told, how it is started and ended, how its result is taken.

pub mod attachment;
pub mod case_file;
mod ending;
mod process;
mod program_digest;
pub mod reading;
mod staging;
mod started_processes;
mod wholeness;
