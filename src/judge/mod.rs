//! From records to judgements: verdicts on studies, scores of external results, comparisons of methods.
//!
//! Verdicts are mathematics on plain numbers; `paths` turns records into series of numbers. What has no value is
//! returned as a named reason, never as a number that could pass a test.

pub mod answers;
pub mod blocks;
pub mod case_verdicts;
pub mod comparison;
pub mod explanation;
pub mod findings;
pub mod levels;
pub mod path_context;
pub mod path_labels;
pub mod paths;
pub mod proposals;
pub mod published_equations;
pub mod race;
pub mod score;
pub mod soundness;
pub mod study_check;
pub mod study_findings;
pub mod study_results;
pub mod verdict;
