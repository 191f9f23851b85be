//! What a study answers by itself: its setting at the head of its page, and its answers as sections.

use crate::questions::finding::Place;
use crate::questions::setting::SETTING;
use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::page::Block;
use crate::report::sections;

/// Its setting as a paragraph.
///
/// # Errors
/// If a template cannot be filled.
pub fn lead(study: &StudyFindings) -> Result<String, RenderError> {
    let setting = study.plain.findings.iter().find(|finding| finding.question == &SETTING);
    setting.map_or(Ok(String::new()), |setting| Ok(setting.sentence()? + "\n\n"))
}

/// The answers of the study, each below its question.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    for finding in study.plain.findings.iter().filter(|finding| finding.question != &SETTING) {
        blocks.push(Block::Heading(finding.question.heading.to_owned()));
        blocks.extend(sections::blocks(finding, Place::Study)?);
    }
    Ok(blocks)
}
