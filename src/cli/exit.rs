//! Exit codes, and errors as messages.

use crate::campaign::endless::EndlessCases;
use crate::campaign::runner::RunError;
use crate::score::results::ScoreError;
use crate::study::diagnostic::StudyError;
use crate::study::overrides::OverrideError;
use oedometer_exact::exact_error::ExactError;
use oedometer_formats::ImportError;

/// The exit codes, for `--help`.
pub const HELP: &str = "Exit codes: 0 pass, 1 a verdict failed, 2 usage or bad study file, 3 a case failed or timed \
                        out, 4 nothing selected, 5 golden values missing or stale, 6 cases missing (an \
                        incomplete merge, an interrupted run, solvers that may not start)";

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Success.
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
    /// Cases are missing: an incomplete merge, an interrupted run, or solvers that may not start.
    IncompleteMerge = 6,
}

/// An error with the exit code of the command.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Ended {
    message: String,
    exit: Exit,
}

impl Ended {
    /// An error with a message and an exit code.
    pub fn with(exit: Exit, message: impl Into<String>) -> anyhow::Error {
        Self { message: message.into(), exit }.into()
    }

    /// A usage error.
    pub fn usage(message: impl Into<String>) -> anyhow::Error {
        Self::with(Exit::Usage, message)
    }
}

impl Exit {
    /// The exit code of an error.
    pub fn of(error: &anyhow::Error) -> Self {
        if let Some(ended) = error.downcast_ref::<Ended>() {
            return ended.exit;
        }
        if matches!(error.downcast_ref(), Some(ScoreError::NoTime(_))) {
            return Self::NothingSelected;
        }
        let is_of_input = error.is::<StudyError>()
            || error.is::<EndlessCases>()
            || matches!(error.downcast_ref(), Some(RunError::Endless(_)))
            || error.is::<OverrideError>()
            || error.is::<ScoreError>();
        if is_of_input || error.is::<ExactError>() || error.is::<ImportError>() {
            Self::Usage
        } else {
            Self::CaseFailed
        }
    }
}

/// The message of an error.
pub fn sentence(error: &anyhow::Error) -> String {
    let of_lines = |error: &'_ OverrideError| matches!(error, OverrideError::Study(_));
    if error.is::<StudyError>() || error.downcast_ref().is_some_and(of_lines) {
        return error.to_string();
    }
    // A cause that the message already ends with is not repeated.
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if message.is_empty() {
            message = cause;
        } else if !message.ends_with(&cause) {
            message = format!("{message}: {cause}");
        }
    }
    let message = without_numbers_of_the_system(&message);
    if message.starts_with("error: ") { message } else { format!("error: {message}") }
}

/// Removes error numbers of the system: ` (os error 2)`.
fn without_numbers_of_the_system(sentence: &str) -> String {
    let mut rest = sentence;
    let mut shortened = String::new();
    while let Some((before, after)) = rest.split_once(" (os error ") {
        shortened.push_str(before);
        rest = after.split_once(')').map_or("", |(_, after)| after);
    }
    shortened + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn a_cause_is_told_once_and_without_the_number_of_the_system() {
        let none = || std::io::Error::from_raw_os_error(2);
        let error = anyhow::Error::from(none()).context("cannot read a.csv");
        assert_eq!(sentence(&error), "error: cannot read a.csv: No such file or directory");
        assert_eq!(sentence(&anyhow::anyhow!("error: no column")), "error: no column");
        let twice = Err::<(), _>(none()).context(format!("cannot read a.csv: {}", none())).expect_err("none");
        assert_eq!(sentence(&twice), "error: cannot read a.csv: No such file or directory");
    }

    #[test]
    fn every_error_has_the_exit_code_of_its_kind_under_whatever_it_is_told_with() {
        let study = || StudyError { name: "s".to_owned(), source: String::new(), diagnostics: Vec::new() };
        for (error, exit, code) in [
            (Ended::usage("a"), Exit::Usage, 2),
            (Ended::with(Exit::VerdictFailed, "a"), Exit::VerdictFailed, 1),
            (Ended::with(Exit::Golden, "a"), Exit::Golden, 5),
            (Ended::with(Exit::IncompleteMerge, "a"), Exit::IncompleteMerge, 6),
            (ScoreError::NoTime("a".to_owned()).into(), Exit::NothingSelected, 4),
            (ScoreError::Exact(ExactError::NoFields).into(), Exit::Usage, 2),
            (study().into(), Exit::Usage, 2),
            (OverrideError::Typed("a".to_owned()).into(), Exit::Usage, 2),
            (OverrideError::Study(study()).into(), Exit::Usage, 2),
            (ExactError::NoFields.into(), Exit::Usage, 2),
            (std::io::Error::other("full").into(), Exit::CaseFailed, 3),
        ] {
            assert_eq!((Exit::of(&error), exit as u8), (exit, code), "{error}");
            assert_eq!(Exit::of(&error.context("more")), exit);
        }
        assert_eq!(Exit::Pass as u8, 0);
        let order = [Exit::Pass, Exit::VerdictFailed, Exit::Usage, Exit::CaseFailed, Exit::NothingSelected];
        assert!(order.is_sorted() && order[4] < Exit::Golden && Exit::Golden < Exit::IncompleteMerge);
        let told = "Exit codes: 0 pass, 1 a verdict failed, 2 usage or bad study file, 3 a case failed or timed out, \
                    4 nothing selected, 5 golden values missing or stale, 6 cases missing (an incomplete merge, an \
                    interrupted run, solvers that may not start)";
        assert_eq!(HELP, told);
    }

    #[test]
    fn what_shows_its_lines_has_no_word_before_them_and_all_else_has() {
        let diagnostics = vec![crate::study::diagnostic::Diagnostic::at(0..1, "odd", "none")];
        let study = StudyError { name: "s".to_owned(), source: "x".to_owned(), diagnostics };
        let lines = "error: odd\n --> s:1:1\n  |\n1 | x\n  | ^\n  |\n  = help: none";
        assert_eq!(sentence(&study.clone().into()), lines);
        assert_eq!(sentence(&OverrideError::Study(study).into()), lines);
        assert_eq!(sentence(&OverrideError::Typed("a".to_owned()).into()), "error: a");
        let both = Ended::usage("a (os error 2) and b (os error 13), c").context("first");
        assert_eq!(sentence(&both), "error: first: a and b, c");
    }
}
