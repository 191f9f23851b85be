//! What is found about a study, as one value of plain data: the answers to the questions. `findings.json` is written beside the
//! page of a study, and `oedometer schema findings` describes it. Lengths are in m, pressures in Pa, times in s; errors are
//! relative.

use crate::questions::finding::{Finding, Place, unread};
use crate::questions::list;
use crate::questions::study_results::StudyResults;
use crate::race::situation::Situation;
use oedometer_exact::ExactError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the layout; it rises when a field goes or changes its meaning.
pub const SCHEMA: u32 = 2;

/// Everything that is found about a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Findings {
    /// Version of the layout.
    pub schema: u32,
    /// Name of the study.
    pub study: String,
    /// Name of its scene.
    pub scene: String,
    /// Names of its references, the scene's own first.
    pub references: Vec<String>,
    /// The answers.
    #[serde(default, deserialize_with = "unread")]
    #[schemars(schema_with = "list::schema")]
    #[expect(clippy::struct_field_names, reason = "a key of findings.json")]
    pub findings: Vec<Finding>,
    /// A situation of the race.
    pub race: Option<Situation>,
}

impl Findings {
    /// Everything about a study, from its records and verdicts.
    ///
    /// # Errors
    /// When a reference refuses a case.
    pub fn new(results: &StudyResults<'_>) -> Result<Self, ExactError> {
        let StudyResults { study, records, .. } = results;
        Ok(Self {
            schema: SCHEMA,
            study: study.name.clone(),
            scene: study.scene.name.to_owned(),
            references: study.references.iter().map(|kind| kind.name().to_owned()).collect(),
            findings: list::answers(std::slice::from_ref(results), Place::Study)?,
            race: Situation::from_records(study, records),
        })
    }
}
