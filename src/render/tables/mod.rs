//! Tables of records, scores, golden values and measured times, for every command that shows them.

pub mod attached_run_table;
pub mod attached_runs;
pub mod critical_steps;
pub mod explanation;
pub mod golden_changes;
pub mod measures;
pub mod phases;
pub mod scores;
pub mod spreads;
pub mod uncertainties;
