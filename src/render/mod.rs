//! Tables, charts and pages made from plain data. Nothing here computes results or knows a solver, and the same
//! description always gives the same bytes.

pub mod answers;
mod chart;
pub mod checks;
mod error;
pub mod escape;
pub(crate) mod history_tables;
mod number;
pub mod page;
pub mod report;
mod script;
pub mod table;
pub mod tables;
