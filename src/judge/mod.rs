//! From records to verdicts on studies.
//!
//! Verdicts are mathematics on plain numbers; `paths` turns records into series of numbers. What has no value is
//! returned as a named reason, never as a number that could pass a test.

pub mod case_verdicts;
pub mod error_place;
pub mod explanation;
pub mod path_context;
pub mod path_labels;
pub mod paths;
pub mod proposals;
pub mod recommendation;
pub mod study_check;
pub mod study_results;
pub mod unneeded_data;
pub mod verdict;
