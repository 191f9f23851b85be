//! What is written of studies: sentences, tables and pages. It sees findings and verdicts, never a solver; what writes text,
//! Markdown, HTML and SVG lies below, in `render`.

pub mod annotations;
pub mod answers;
pub mod check_page;
pub(crate) mod history_tables;
pub mod junit;
pub mod sections;
pub mod studies_page;
pub mod study_page;
pub mod tables;

#[cfg(test)]
mod tests;
