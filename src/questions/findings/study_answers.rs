//! What a study answers by itself, for its page and for the terminal: errors over the meshes, what it takes to come within a
//! bound.

use crate::judge::paths::StudyPaths;
use crate::questions::findings::QuantityWithin;
use crate::questions::findings::convergence::{ConvergenceTable, FinestMeshes, convergence_tables};
use crate::questions::findings::within::within;
use crate::record::Record;
use crate::study::check::Study;

/// The answers of a study; a race has answers of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyAnswers {
    /// What it takes to come within bounds of the error.
    pub within: Vec<QuantityWithin>,
    /// Errors and rates over the meshes, of a study with a few methods.
    pub convergence: Vec<ConvergenceTable>,
    /// The finest meshes of a study with more methods than that.
    pub finest: Option<FinestMeshes>,
}

impl StudyAnswers {
    /// The answers of a study's records.
    pub fn new(study: &Study, records: &[Record], paths: &StudyPaths<'_>) -> Self {
        if study.is_race {
            return Self::default();
        }
        Self {
            convergence: convergence_tables(study, paths),
            finest: FinestMeshes::new(study, paths),
            within: within(study, records),
        }
    }
}
