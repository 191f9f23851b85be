//! From computed numbers to judgements: norms, oscillation, orders, floors, verdicts, cost.
//!
//! Mathematics on plain numbers, but for `measure` and `summary`, which bring runs to numbers and
//! records to series.
//! What has no value is returned as a named reason, never as a number that could pass a test.

pub mod absent;
pub mod case_verdicts;
pub mod cheapest_method;
pub mod error_place;
pub mod explanation;
pub mod floor_causes;
pub mod judgement;
pub mod locking;
pub mod paths;
pub mod peers;
pub mod profile_checks;
pub mod scatter;
pub mod score;
pub mod situation;
pub mod soundness;
pub mod stability_map;
pub mod stiffness_sweep;
pub mod study_check;
pub mod twins;
pub mod verdict;
pub mod work_precision;
