//! What is known of the run of an attached solver beside its result.

use crate::case::quantity::Sample;
use serde::{Deserialize, Serialize};

/// The run of an attached solver. What changes from run to run at the same result, like times, stands with the wall
/// times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct AttachedRun {
    /// The command as the study has it, with its placeholders.
    pub command: Vec<String>,
    /// What it says of its version, where it was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Whether it was run once before it was timed.
    #[serde(default)]
    pub warmed_up: bool,
    /// Kind of the places of its result, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<Sample>,
    /// What of the result was taken from where.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub taken: Vec<String>,
    /// Digest of the content of the result's files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result_digest: Option<String>,
    /// Largest difference between the results of repeats, over the largest value of its field; none where there was
    /// one run. Results at other places are told as a note.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeats_differ_by: Option<f64>,
    /// What is odd about the run and fails nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// The last lines that it said, of a run that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub last_words: Vec<String>,
}
