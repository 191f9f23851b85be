//! Cases of `oedometer`, what is measured and kept of them, how series of errors converge, and files of other programs.
//!
//! A crate of its own for the compiler alone: records are written and read by the thousand and other
//! programs' files have a million points, so this much is compiled with
//! some optimisation, and what only leads here with none. The map of all is the front page of `oedometer`, `src/lib.rs`.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod case;
pub mod convergence;
pub mod formats;
pub mod measure;
pub mod record;

use oedometer_solver::{elementary, exact, mpm, scene, soil, sorting, wording};
