//! Tables, charts and pages out of plain data. Nothing here computes science, and nothing here
//! knows a solver: the same description always gives the same bytes.
pub mod annotations;
mod changes;
pub mod chart;
mod error;
mod escape;
pub mod explanation;
mod failures;
pub mod junit;
pub mod measures;
pub mod number;
pub mod page;
pub mod phases;
pub mod report;
pub mod scores;
mod script;
#[cfg(test)]
mod showcase;
pub mod spreads;
pub mod stability;
pub mod table;
pub mod uncertainties;
pub mod verdicts;

pub use error::RenderError;
