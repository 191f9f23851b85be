//! Studies: what was typed (`file`), what will run (`check`, `sweep`, `case`, `tier`), and the runner.

pub mod case_expectation;
pub mod check;
pub mod choice_tables;
pub mod diagnostic;
pub mod expectation;
pub mod file;
pub mod inputs;
pub mod name;
pub mod perturbed;
pub mod reading;
pub mod result_table;
pub mod shipped;
pub mod solver;
pub mod solver_table;
pub mod sweep;
