//! Attached solvers: writes the case file, starts and ends the program, and reads its result.

pub mod attachment;
pub mod case_file;
mod ending;
mod identity;
mod process;
pub mod reading;
mod staging;
mod started_processes;
