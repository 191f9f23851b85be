//! `oedometer` verifies coupled material point solvers: its own, and other people's.
// Tests and benches may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod assess;
pub mod cli;
pub mod elementary;
pub mod exact;
pub mod golden;
pub mod import;
pub mod record;
pub mod render;
pub mod scene;
pub mod schema;
pub mod solver;
pub mod study;
