//! From computed numbers to judgements: norms, oscillation, orders, floors, verdicts, cost.
//!
//! Everything here is mathematics on plain numbers: nothing knows of solvers, studies or files.
//! What has no value is returned as a named reason, never as a number that could pass a test.

mod bend;
mod cancelling;
mod case;
mod least_squares;
mod pattern_search;

pub mod class;
pub mod classify;
pub mod eca_hoekstra;
pub mod expectation;
pub mod floor;
pub mod joint;
pub mod limiter;
pub mod norms;
pub mod orders;
pub mod oscillation;
pub mod pareto;
pub mod series;
pub mod statistics;
pub mod two_terms;
pub mod uncertainty;
pub mod verdict;
pub mod window;
pub mod wording;
