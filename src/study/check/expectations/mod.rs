//! Checks of what a study expects: of its cases, of its series, and whether there is anything to judge.

pub mod check_case_expectation;
pub mod check_series_expectation;
pub mod matching;
