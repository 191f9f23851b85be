//! What readers ask of studies, answered as plain data: numbers and names; pages make sentences of it.

pub mod answers;
pub mod blocks;
pub mod choice;
pub mod comparison;
pub mod findings;
pub mod levels;
pub mod published_equations;
pub mod race_tables;
pub mod study_findings;
pub mod study_results;
