//! What the blocks of a study's page print, block by block: every number is computed here and `render` only writes it.

pub mod drawn;
pub mod error_figure;
pub mod number;
pub mod refinement;

use crate::questions::study_results::StudyResults;
use crate::race::situation::Situation;
use refinement::RefinementFinding;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point of a line, `[x, y]`.
pub type Point = (f64, f64);

/// What the blocks of a study's page print, beside runs, series and expectations.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct StudyBlocks {
    /// Errors along every axis that is refined.
    pub refinements: Vec<RefinementFinding>,
    /// A situation of the race.
    pub race: Option<Situation>,
}

impl StudyBlocks {
    /// Everything for the page of a study.
    pub fn new(results: &StudyResults<'_>) -> Self {
        // The page of a race has a table of its own in their place.
        let drawn = !results.study.is_race;
        Self {
            refinements: if drawn { RefinementFinding::along_all_axes(results) } else { Vec::new() },
            race: Situation::from_records(results.study, results.records),
        }
    }
}
