//! The pages behind the answers: one per study, and the list of all studies.

mod checks;
pub(crate) mod cost;
pub(crate) mod labels;
pub(crate) mod layer;
mod maps;
pub mod pages;
pub mod race;
pub(crate) mod refinement;
pub(crate) mod setting;
pub(crate) mod theory_lines;
pub(crate) mod within;

use crate::judge::study_results::StudyResults;
use crate::render::chart::Chart;
use crate::render::page::{Figure, slug};

/// A figure of a study, whose name begins with that of the study.
fn figure_of(results: &StudyResults<'_>, name: &str, chart: Chart, caption: impl Into<String>) -> Figure {
    Figure::new(slug(&format!("{}-{name}", results.study.name)), chart, caption)
}
