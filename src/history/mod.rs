//! Results over time: two states of a study beside each other, and golden values over the commits that changed them.
//!
//! A state is a folder of records, or the golden files of a git revision; `rounds`
//! alone runs something, two commands of a study.

pub(crate) mod accepted_inputs;
pub(crate) mod comparison;
pub(crate) mod repository;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod timeline;
