//! Exit codes, decided in one place.

use crate::exact::exact_error::ExactError;
use crate::import::import_error::ImportError;
use crate::study::diagnostic::StudyError;

/// The exit codes, as `--help` tells them.
pub const HELP: &str = "Exit codes: 0 pass, 1 a verdict failed, 2 usage or bad study file, 3 a case failed or timed \
                        out, 4 nothing selected, 5 golden missing or stale, 6 incomplete merge";

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// All well.
    Pass = 0,
    /// A verdict failed.
    VerdictFailed = 1,
    /// Usage, or a bad study file.
    Usage = 2,
    /// A case failed or timed out.
    CaseFailed = 3,
    /// Nothing was selected.
    NothingSelected = 4,
    /// A golden value is missing or stale.
    Golden = 5,
    /// A merge has holes.
    IncompleteMerge = 6,
}

/// An error that says how the command ends.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Ended {
    message: String,
    exit: Exit,
}

impl Ended {
    /// An error with a sentence and an exit code.
    pub fn with(exit: Exit, message: impl Into<String>) -> anyhow::Error {
        Self { message: message.into(), exit }.into()
    }

    /// A usage error.
    pub fn usage(message: impl Into<String>) -> anyhow::Error {
        Self::with(Exit::Usage, message)
    }
}

impl Exit {
    /// The exit of an error, by what caused it.
    pub fn of(error: &anyhow::Error) -> Self {
        match error.downcast_ref::<Ended>() {
            Some(ended) => ended.exit,
            None if error.is::<StudyError>() || error.is::<ExactError>() || error.is::<ImportError>() => {
                Self::Usage
            }
            None => Self::CaseFailed,
        }
    }
}

/// An error as a person reads it.
pub fn sentence(error: &anyhow::Error) -> String {
    match error.downcast_ref::<StudyError>() {
        Some(study) => study.to_string(),
        None => format!("error: {error:#}"),
    }
}
