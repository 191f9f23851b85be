//! Other people's programs as solvers: writes the case file, starts and ends the program, reads its result by what a mapping
//! declares, and says by what the program is known. TOML that people write, with complaints at their lines, is read here too.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod attachment;
pub mod case_file;
pub mod diagnostic;
mod ending;
pub mod git;
mod identity;
pub mod import;
pub mod mending;
mod process;
pub mod reading;
pub mod solver;
pub mod source;
mod staging;
mod started_processes;
pub mod synonyms;
pub mod toml_text;
pub mod units;
