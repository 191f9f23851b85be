//! Other people's programs as solvers: writes the case file, starts and ends the program, reads its result by what a mapping
//! declares, and says by what the program is known.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod attachment;
pub mod case_file;
mod ending;
pub mod git;
mod identity;
pub mod import;
mod process;
pub mod reading;
pub mod solver;
mod staging;
mod started_processes;
