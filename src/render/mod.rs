//! Tables, charts and pages out of plain data. Nothing here computes science, and nothing here
//! knows a solver: the same description always gives the same bytes.

pub mod answers;
pub mod chart;
pub mod checks;
pub mod escape;
pub mod number;
pub mod page;
pub mod render_error;
pub mod report;
pub mod script;
#[cfg(test)]
mod showcase;
pub mod table;
pub mod tables;
