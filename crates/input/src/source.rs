//! TOML of a user, with a name for messages.

use crate::diagnostic::{Diagnostic, StudyError};

/// Text of a study with a name for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudySource {
    /// File name, or what stands for it.
    pub name: String,
    /// TOML.
    pub text: String,
}

impl StudySource {
    /// One complaint about the whole text.
    pub fn complaint(&self, message: String, help: String) -> StudyError {
        self.error(vec![Diagnostic { message, span: None, help: Some(help) }])
    }

    /// An error of this study.
    pub fn error(&self, diagnostics: Vec<Diagnostic>) -> StudyError {
        StudyError { name: self.name.clone(), source: self.text.clone(), diagnostics }
    }
}
