//! From computed numbers to judgements: norms, oscillation, orders, floors, verdicts, cost.
//!
//! Mathematics on plain numbers, but for `measure` and `summary`, which bring runs to numbers and
//! records to series.
//! What has no value is returned as a named reason, never as a number that could pass a test.

mod approach;
mod bend;
mod beside;
mod cancelling;
mod case;
pub mod case_expectation;
mod causes;
pub mod class;
pub mod classify;
pub mod curves;
pub mod eca_hoekstra;
pub mod expectation;
pub mod explain;
pub mod floor;
pub mod joint;
mod least_squares;
pub mod limiter;
pub mod locking;
pub mod measure;
pub mod norm;
pub mod norms;
pub mod numerical_uncertainty;
pub mod orders;
pub mod oscillation;
pub mod pareto;
mod pattern_search;
pub mod peers;
pub mod places;
pub mod plane_field;
pub mod record_checks;
pub mod score;
pub mod series;
pub mod soundness;
pub mod spread;
pub mod stability_map;
pub mod statistics;
pub mod stiffness_sweep;
mod student;
pub mod study_check;
pub mod summary;
pub mod two_terms;
pub mod uncertainty;
pub mod verdict;
pub mod window;
pub mod wording;
pub mod work_precision;
