//! The pages behind the answers: one per study, and the list of all studies.

pub(crate) mod answers;
mod expectations;
pub mod index_page;
pub mod race;
pub mod study_page;
