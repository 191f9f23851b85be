//! The pages behind the answers: one per study, and the list of all studies.

pub(crate) mod answers;
mod expectations;
pub mod index_page;
pub mod race;
pub(crate) mod refinement;
pub mod study_page;

use crate::render::chart::Chart;
use crate::render::page::{Figure, slug};

/// A figure of a study, whose name begins with that of the study.
fn figure_of(study: &str, name: &str, chart: Chart, caption: impl Into<String>) -> Figure {
    Figure::new(slug(&format!("{study}-{name}")), chart, caption)
}
