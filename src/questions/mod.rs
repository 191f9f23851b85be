//! What readers ask of studies: a question is one file with its template beside it, and answers with a finding, from which
//! the terminal, the page of a study, the report and `findings.json` are written.

pub mod audit;
pub mod checks;
pub mod choice;
pub mod convergence;
pub mod cost;
pub mod ends;
pub mod expected;
pub mod fields;
pub mod finding;
pub mod list;
pub mod load_curves;
pub mod locking;
pub mod outside_runs;
pub mod paper;
pub mod peers;
pub mod point_sets;
pub mod points;
pub mod profiles;
pub mod published_equations;
pub mod race_tables;
pub mod sentence;
pub mod series;
pub mod series_figure;
pub mod setting;
pub mod settlement;
pub mod stability;
pub mod stiffness_sweep;
pub mod time_step;
pub mod timed_runs;
pub mod uncertainty;
pub mod within;
pub mod words;
