//! A finding as blocks and as a section of a page.

use crate::case::grouping::distinct;
use crate::questions::finding::{Finding, Place};
use crate::render::RenderError;
use crate::render::page::{Block, Figure, Section, slug};

/// Rows of a table that has a file, on the page of a report: three errors of three methods.
const REPORT_ROWS: usize = 9;

/// The section of an answer.
///
/// # Errors
/// If a template needs what is no fact.
pub fn section(finding: &Finding, place: Place) -> Result<Section, RenderError> {
    let question = finding.question;
    Ok(Section::new(question.heading, question.id, blocks(finding, place)?))
}

/// The blocks of an answer: its sentence, with links to the studies that show it in a report, and its parts.
///
/// # Errors
/// If a template needs what is no fact.
pub fn blocks(finding: &Finding, place: Place) -> Result<Vec<Block>, RenderError> {
    let mut sentence = finding.sentence()?;
    if place == Place::Report && !finding.studies.is_empty() {
        sentence.extend([" Evidence: ", &links_to(finding.studies.iter().map(String::as_str)), "."]);
    }
    let parts = finding.parts.iter().filter_map(|block| shown(block, finding, place));
    Ok(std::iter::once(Block::Paragraph(sentence)).chain(parts).collect())
}

/// A block as a place shows it: of a table in a report some rows, of figures those that tell more than a sentence would, on the page
/// of a study under its name.
fn shown(block: &Block, finding: &Finding, place: Place) -> Option<Block> {
    let named = |figure: &Figure| match (place, finding.studies.first()) {
        (Place::Study, Some(study)) => {
            let name = format!("{}-{}", slug(study), figure.name);
            Figure::new(name, (*figure.chart).clone(), figure.caption.clone())
        }
        _ => figure.clone(),
    };
    Some(match block {
        Block::Table(table) if place == Place::Report && table.file.is_some() => {
            Block::Table(table.clone().shown(REPORT_ROWS))
        }
        Block::Figures(figures) => {
            let telling = figures.iter().filter(|figure| figure.chart.is_telling());
            let telling: Vec<Figure> = telling.map(named).collect();
            return (!telling.is_empty()).then_some(Block::Figures(telling));
        }
        Block::Details { summary, blocks } => Block::Details {
            summary: summary.clone(),
            blocks: blocks.iter().filter_map(|block| shown(block, finding, place)).collect(),
        },
        other => other.clone(),
    })
}

/// The page of a study, from the answer page.
pub fn page_of(study: &str) -> String {
    format!("studies/{}.html", slug(study))
}

/// Links to the pages of studies, each once, in running text.
pub fn links_to<'a>(studies: impl IntoIterator<Item = &'a str>) -> String {
    let links = distinct(studies).into_iter().map(|study| format!("[`{study}`]({})", page_of(study)));
    links.collect::<Vec<_>>().join(", ")
}
