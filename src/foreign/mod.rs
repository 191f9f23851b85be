//! Somebody else's solver, run on a case: what it is told, how it is started and ended, how its result is taken.

pub mod attachment;
pub mod case_file;
pub mod command;
pub mod ending;
pub mod output_tail;
pub mod process;
pub mod reading;
pub mod repeats;
pub mod staging;
pub mod started_processes;
pub mod wholeness;
