//! What `check` says: to a terminal, as Markdown, as annotations of a forge and as `JUnit`.

pub mod annotations;
pub mod failures;
pub mod items;
pub mod junit;
pub mod verdicts;
