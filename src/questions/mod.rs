//! What readers ask of studies: a question is one file with its template beside it, and answers with a finding, from which
//! the terminal, the page of a study, the report and `findings.json` are written.

pub mod answers;
pub mod blocks;
pub mod choice;
pub mod comparison;
pub mod finding;
pub mod findings;
pub mod levels;
pub mod list;
pub mod locking;
pub mod published_equations;
pub mod race_tables;
pub mod sentence;
pub mod settlement;
pub mod study_findings;
pub mod study_results;
pub mod words;
