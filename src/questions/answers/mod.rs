//! What the records of all studies answer, as plain data: one value per question of a reader. Numbers, names and choices of a
//! fixed list, no sentence; `findings.json` beside the report has them, and templates make sentences of them.

use crate::questions::finding::{Finding, Place, unread};
use crate::questions::list;
use crate::questions::study_results::StudyResults;
use crate::race::RaceFindings;
use oedometer_exact::ExactError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cells of the mesh on which errors are quoted: the paper's.
pub const QUOTED_CELLS: usize = 10;

/// Everything that a report of several studies says: the race, where there was one, and the answer to each question that the
/// records answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReportFindings {
    /// The race to 1 %: whole in `tables/race.csv`, its answers among the findings.
    #[serde(skip)]
    pub race: Option<RaceFindings>,
    /// The answers to the questions that are files of their own.
    #[serde(default, deserialize_with = "unread")]
    #[schemars(schema_with = "list::schema")]
    pub findings: Vec<Finding>,
    /// Whether everything is as expected.
    pub verdict: VerdictFinding,
}

impl ReportFindings {
    /// The answers of the records of some studies.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &[StudyResults<'_>]) -> Result<Self, ExactError> {
        Ok(Self {
            race: RaceFindings::from_studies(results.iter().map(|one| (one.study, one.records))),
            findings: list::answers(results, Place::Report)?,
            verdict: VerdictFinding::new(results),
        })
    }
}

/// Whether everything is as expected.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerdictFinding {
    /// Expectations.
    pub expectations: usize,
    /// Those that are met.
    pub met: usize,
    /// Studies.
    pub studies: usize,
    /// Runs.
    pub runs: usize,
    /// Checks of runs that fail.
    pub unsound: usize,
    /// Names of the studies in which something is not as expected.
    pub failing: Vec<String>,
}

impl VerdictFinding {
    fn new(results: &[StudyResults<'_>]) -> Self {
        let sum = |count: &dyn Fn(&StudyResults<'_>) -> usize| results.iter().map(count).sum::<usize>();
        let failing = results.iter().filter(|one| !one.check.meets_all()).map(|one| one.study.name.clone());
        Self {
            expectations: sum(&|one| one.check.judgements.len()),
            met: sum(&|one| one.check.met()),
            studies: results.len(),
            runs: sum(&|one| one.records.len()),
            unsound: sum(&|one| one.check.unsound.len()),
            failing: failing.collect(),
        }
    }
}
