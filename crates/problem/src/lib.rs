//! A problem of saturated soil as plain data, between the scenes that make one and the solver that solves it; and what is
//! left of a run.
//!
//! `problem` is the body with what acts on it; `method`, `integrator`, `formulation`, `settings` and `time_step` are the choices of a solver; `arrangement` says where
//! points lie and `forcing` what makes a motion that was chosen. `outcome`, `snapshot` and `critical_step` are results,
//! `quantity` what is measured of them, `wave_speeds` what is known of a step before.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod arrangement;
pub mod critical_step;
pub mod forcing;
pub mod formulation;
pub mod integrator;
pub mod method;
pub mod outcome;
pub mod problem;
pub mod quantity;
pub mod settings;
pub mod snapshot;
pub mod time_step;
pub mod wave_speeds;
