//! The solver of `oedometer`: what is solved, how, and the exact solutions that hold it.
//!
//! A crate of its own for the compiler alone: this much is compiled with every optimisation, the rest of the program
//! with less, side by side. The map of both is the front page of `oedometer`, `src/lib.rs`.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod elementary;
pub mod exact;
pub mod mpm;
pub mod scene;
pub mod soil;
pub mod sorting;
pub mod wording;

#[cfg(test)]
#[path = "../tests/unit/solver.rs"]
mod tests;
