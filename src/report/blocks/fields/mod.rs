//! What a study computes, beside theory: loads and pressure fields of a plane, profiles and consolidation of a column.

mod layer;
pub(crate) mod theory_lines;

use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::page::Block;

/// Every block of fields and profiles, in the order of the page.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let mut blocks = layer::blocks(study)?;
    blocks.extend(theory_lines::blocks(study)?);
    Ok(blocks)
}
