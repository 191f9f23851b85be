//! Results over time: two states of a study beside each other, and golden values over the commits that changed them.
//!
//! Nothing here solves anything. A state is a folder of records, or the golden files of a git revision.

pub(crate) mod comparison;
pub(crate) mod repository;
pub(crate) mod state;
pub(crate) mod timeline;
