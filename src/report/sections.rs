//! A finding as blocks and as a section of a page.

use crate::case::grouping::distinct;
use crate::questions::finding::{Finding, Part, Place};
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
    let mut blocks = vec![Block::Paragraph(sentence)];
    blocks.extend(parts_as_blocks(finding, &finding.parts, place)?);
    Ok(blocks)
}

fn parts_as_blocks(finding: &Finding, parts: &[Part], place: Place) -> Result<Vec<Block>, RenderError> {
    // Pages of several studies may share a folder.
    let named = |figure: &Figure| match (place, finding.studies.first()) {
        (Place::Study, Some(study)) => {
            let name = format!("{}-{}", slug(study), figure.name);
            Figure::new(name, (*figure.chart).clone(), figure.caption.clone())
        }
        _ => figure.clone(),
    };
    let block = |part: &Part| {
        Ok(match part {
            Part::Sentence(template) => Block::Paragraph(finding.words(template)?),
            Part::Table(table) if place == Place::Report && table.file.is_some() => {
                Block::Table(table.clone().shown(REPORT_ROWS))
            }
            Part::Table(table) => Block::Table(table.clone()),
            Part::Figures(figures) => Block::Figures(figures.iter().map(named).collect()),
            Part::Views(views) => {
                let view = |(word, parts): &(String, Vec<Part>)| {
                    Ok((word.clone(), parts_as_blocks(finding, parts, place)?))
                };
                Block::Switch(views.iter().map(view).collect::<Result<_, RenderError>>()?)
            }
            Part::Details(summary, parts) => {
                let (summary, blocks) = (summary.clone(), parts_as_blocks(finding, parts, place)?);
                Block::Details { summary, blocks }
            }
        })
    };
    parts.iter().map(block).collect()
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
