//! Tables, charts and pages out of plain data. Nothing here computes science, and nothing here
//! knows a solver: the same description always gives the same bytes.

pub mod annotations;
pub mod changes;
pub mod chart;
pub mod error;
pub mod escape;
pub mod explanation;
pub mod failures;
pub mod junit;
pub mod measures;
pub mod number;
pub mod page;
pub mod phases;
pub mod report;
pub mod scores;
pub mod script;
#[cfg(test)]
#[path = "../../tests/unit/render_showcase.rs"]
mod showcase;
pub mod spreads;
pub mod stability;
pub mod table;
pub mod uncertainties;
pub mod verdicts;
