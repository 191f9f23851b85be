//! From computed numbers to judgements: norms, oscillation, orders, floors, verdicts, cost.
//!
//! Verdicts are mathematics on plain numbers; `paths` brings records to series of them.
//! What has no value is returned as a named reason, never as a number that could pass a test.

pub mod absent;
pub mod case_verdicts;
pub mod comparison;
pub mod error_place;
pub mod explanation;
pub mod floor_causes;
pub mod judgement;
pub mod paths;
pub mod profile_checks;
pub mod scatter;
pub mod score;
pub mod soundness;
pub mod study_check;
pub mod thinned;
pub mod verdict;
