//! What a study answers by itself, for its page and for the terminal: errors over the meshes, what it takes to come within a
//! bound, settlements by date, and who locks.

use crate::judge::paths::StudyPaths;
use crate::questions::answers::locking::LockingFinding;
use crate::questions::findings::QuantityWithin;
use crate::questions::findings::convergence::{ConvergenceTable, FinestMeshes, convergence_tables};
use crate::questions::findings::settlement::{SettlementTable, settlement_tables};
use crate::questions::findings::within::within;
use crate::record::Record;
use crate::study::check::Study;
use oedometer_exact::ExactError;

/// The answers of a study; a race has answers of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyAnswers {
    /// What it takes to come within bounds of the error.
    pub within: Vec<QuantityWithin>,
    /// Settlements at the outputs.
    pub settlements: Vec<SettlementTable>,
    /// Which methods lock, where the study sweeps Poisson's ratio in the plane.
    pub locking: Option<LockingFinding>,
    /// Errors and rates over the meshes, of a study with a few methods.
    pub convergence: Vec<ConvergenceTable>,
    /// The finest meshes of a study with more methods than that.
    pub finest: Option<FinestMeshes>,
}

impl StudyAnswers {
    /// The answers of a study's records.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(study: &Study, records: &[Record], paths: &StudyPaths<'_>) -> Result<Self, ExactError> {
        if study.is_race {
            return Ok(Self::default());
        }
        let within = within(study, records);
        Ok(Self {
            settlements: settlement_tables(study, records, &within)?,
            locking: LockingFinding::of_study(study, records)?,
            convergence: convergence_tables(study, paths),
            finest: FinestMeshes::new(study, paths),
            within,
        })
    }
}
