//! Attached solvers: writes the case file, starts and ends the program, and reads its result.

pub mod attachment;
pub mod case_file;
mod ending;
mod process;
mod program_digest;
pub mod reading;
mod staging;
mod started_processes;
mod wholeness;
