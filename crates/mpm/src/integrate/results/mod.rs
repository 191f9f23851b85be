//! Results of a run: its end by name, states at the outputs, and the settlement between them.

pub mod outcome;
pub mod snapshot;
