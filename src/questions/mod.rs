//! What readers ask of studies: a question is one file with its template beside it, and answers with a finding, from which
//! the terminal, the page of a study, the report and `findings.json` are written.

pub mod answers;
pub mod audit;
pub mod blocks;
pub mod checks;
pub mod choice;
pub mod cost;
pub mod ends;
pub mod fields;
pub mod finding;
pub mod findings;
pub mod levels;
pub mod list;
pub mod load_curves;
pub mod locking;
pub mod outside_runs;
pub mod paper;
pub mod peers;
pub mod point_sets;
pub mod profiles;
pub mod published_equations;
pub mod race_tables;
pub mod sentence;
pub mod setting;
pub mod settlement;
pub mod stability;
pub mod stiffness_sweep;
pub mod study_findings;
pub mod study_results;
pub mod timed_runs;
pub mod uncertainty;
pub mod words;
pub mod work;
