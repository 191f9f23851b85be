//! What every check of a study works on: the complaints so far, and what the cases share.

use crate::case::Case;
use crate::case::keys::{Key, Value};
use crate::study::diagnostic::Diagnostic;
use crate::study::file::StudySource;
use crate::study::solver::Solver;
use std::ops::Range;

/// What a study is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Its cases are to be solved.
    Solving,
    /// Only its problem is wanted, for an exact solution: no grid has to fit it.
    Theory,
}

/// Complaints as they come up; every method gives a usable value or none.
pub(crate) struct Checker<'a> {
    pub(crate) source: &'a StudySource,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Height of all cases, by which the levels of expectations are sized; none where they have several.
    pub(crate) column_height: Option<f64>,
    /// Cases that the sweeps seen so far multiply out to.
    pub(crate) multiplied_out: usize,
    pub(crate) purpose: Purpose,
    /// Attached solvers, whose names are methods too.
    pub(crate) solvers: Vec<Solver>,
    /// What is odd and runs all the same, as a person reads it.
    pub(crate) warnings: Vec<String>,
}

impl Checker<'_> {
    /// Notes a complaint.
    pub(crate) fn complain(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.diagnostics.push(Diagnostic::at(span, message, help));
    }
}

/// What the cases of a study share where a sweep does not say otherwise.
pub(crate) struct Common {
    /// The seed values of the scene.
    pub(crate) seed: Case,
    /// What the study gives by its own tables.
    pub(crate) given: Vec<(&'static Key, Value)>,
}

impl Common {
    /// A case of the study before anything is swept.
    pub(crate) fn base(&self) -> Case {
        let mut case = self.seed.clone();
        for (key, value) in &self.given {
            key.set(&mut case, *value);
        }
        case
    }
}
