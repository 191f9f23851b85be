//! Why a call from another language has no answer.

use crate::foreign::reading::MappingError;
use crate::score::results::ScoreError;
use crate::study::diagnostic::StudyError;
use crate::study::overrides::OverrideError;
use oedometer_exact::ExactError;
use oedometer_formats::ImportError;

/// Why a call has no answer: a sentence for who called, with the error behind it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ApiError {
    /// Nothing has a name; the sentence lists the names there are.
    #[error("{0}")]
    UnknownName(String),
    /// Lists and numbers that do not fit each other or the scene.
    #[error("{0}")]
    Unfit(String),
    /// An exact solution refuses its inputs.
    #[error(transparent)]
    Exact(#[from] ExactError),
    /// A file cannot be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A mapping cannot be read or is wrong.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// An input of a scene or solution is wrong.
    #[error(transparent)]
    Input(#[from] OverrideError),
    /// Results have no score.
    #[error(transparent)]
    Score(#[from] ScoreError),
    /// A case cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

impl From<StudyError> for ApiError {
    fn from(error: StudyError) -> Self {
        Self::Mapping(error.into())
    }
}
