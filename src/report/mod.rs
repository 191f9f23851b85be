//! What is written of studies: sentences, tables and pages. It sees findings and verdicts, never a solver; what writes text,
//! Markdown, HTML and SVG lies below, in `render`.

pub mod answers;
pub mod blocks;
pub mod check_page;
pub mod checks;
pub(crate) mod history_tables;
pub mod sections;
pub mod tables;
