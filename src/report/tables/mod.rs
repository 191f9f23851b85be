//! Tables of records, scores, golden values and measured times, for every command that shows them.

pub mod explanation;
pub mod golden_changes;
pub mod measures;
pub mod scores;
