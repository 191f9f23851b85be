//! The runs of a study: how they ended, what else was measured of them, what they cost, and their balances.

mod checks;
pub(crate) mod cost;

use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::page::Block;

/// Every block about the runs, in the order of the page.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let mut blocks = checks::blocks(study)?;
    blocks.extend(cost::blocks(study)?);
    blocks.extend(checks::balances(study)?);
    Ok(blocks)
}
