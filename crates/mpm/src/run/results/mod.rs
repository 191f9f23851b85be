//! What a run leaves behind: its end by name, states at the times asked for, and the settlement between.

pub mod outcome;
pub mod snapshot;
