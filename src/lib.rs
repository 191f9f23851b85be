//! `oedometer` verifies coupled material point solvers: its own, and other people's.
// Tests and benches may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod campaign;
pub mod case;
pub mod cli;
pub mod convergence;
pub mod elementary;
pub mod exact;
pub mod golden;
pub mod import;
pub mod judge;
pub mod measure;
pub mod mpm;
pub mod record;
pub mod render;
pub mod scene;
pub mod schema;
pub mod soil;
pub mod study;
pub mod wording;
