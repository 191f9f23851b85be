//! `oedometer` verifies coupled material point solvers: its own, and other people's.
pub mod assess;
pub mod cli;
pub mod exact;
pub mod golden;
pub mod import;
pub mod record;
pub mod render;
pub mod scene;
pub mod schema;
pub mod solver;
pub mod study;
