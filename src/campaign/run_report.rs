//! What the runner reports: progress, the end, and why it could not continue.

use crate::case::Case;
use crate::record::provenance::Origins;
use crate::record::whole_file::StoreError;
use crate::record::{Record, Status};
use crate::study::check::Study;
use oedometer_exact::exact_error::ExactError;

/// What the runner tells while it works.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Work ahead, as estimated before the runs.
    Planned {
        /// Cases to be run.
        cases: usize,
        /// Cases taken up from disk.
        resumed: usize,
        /// Time that they will take on one core, as estimated, ns; the largest number where there is more.
        work: u64,
        /// Cases at the same time.
        jobs: usize,
        /// The one that will take longest.
        longest: Option<Box<LongestCase>>,
    },
    /// Work done since the last word, in the unit of the plan.
    Advanced(u64),
    /// A case failed.
    Failed {
        /// Its study.
        study: String,
        /// Label of the case.
        label: String,
        /// Failure sentence.
        failure: String,
    },
}

/// The case of a run that will take longest.
#[derive(Clone, Debug, PartialEq)]
pub struct LongestCase {
    /// Its study.
    pub study: String,
    /// What will be run.
    pub case: Case,
    /// Time after which it is ended, s.
    pub case_seconds: f64,
}

/// Why a study could not be run to its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A result could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A case could not be set up, or crashed, which is a fault of this program.
    #[error("{label}: {reason}")]
    Case {
        /// Label of the case.
        label: String,
        /// Why it has no record.
        reason: String,
    },
}

impl RunError {
    /// The error of a case that its exact solutions refuse.
    pub fn refused(case: &Case, error: &ExactError) -> Self {
        Self::Case { label: case.label(), reason: error.to_string() }
    }

    /// The error of a case that crashed.
    pub fn crashed(case: &Case) -> Self {
        Self::Case { label: case.label(), reason: "crashed; please report it with the study file".to_owned() }
    }

    /// The case that has no record, with the reason; `None` if no single case caused it.
    pub fn of_case(&self) -> Option<(&str, String)> {
        match self {
            Self::Store(_) => None,
            Self::Case { label, reason } => Some((label, reason.clone())),
        }
    }
}

/// What a run of a study gave.
#[derive(Debug, Default)]
pub struct RunReport {
    /// Records in the order of the study; none where they are only on disk.
    pub records: Vec<Record>,
    /// What there is of its cases, wherever their records are.
    pub tally: Tally,
    /// How many of the records were there before.
    pub resumed: usize,
    /// What made those.
    pub origins: Origins,
    /// Records of another program that were there, and whose cases were run again.
    pub of_another_program: usize,
    /// What went wrong beside failed cases; finished records are kept all the same.
    pub errors: Vec<RunError>,
}

/// Cases of a run by how they ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cases with a record.
    pub recorded: usize,
    /// Those of them that failed.
    pub failed: usize,
    /// Those that failed and were not expected to.
    pub unforeseen: usize,
    /// Those of them that were not begun, because their programs were not allowed to start.
    pub held_back: usize,
    /// Cases that were not begun or not ended, for the run was stopped.
    pub left: usize,
}

impl Tally {
    /// Counts the record of a case of a study.
    pub fn add(&mut self, study: &Study, record: &Record) {
        self.recorded += 1;
        if record.status != Status::Ok {
            self.failed += 1;
            self.held_back += usize::from(record.status.is_skipped() && study.holds_back(&record.case));
            self.unforeseen += usize::from(!(record.status.is_skipped() || study.foresees(record)));
        }
    }

    /// Counts those of another tally too.
    pub fn join(&mut self, other: Self) {
        self.recorded += other.recorded;
        self.failed += other.failed;
        self.unforeseen += other.unforeseen;
        self.held_back += other.held_back;
        self.left += other.left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tallies_are_joined_count_by_count() {
        let tally = |by: usize| Tally {
            recorded: 13 * by,
            failed: 7 * by,
            unforeseen: 5 * by,
            held_back: 3 * by,
            left: 2 * by,
        };
        let mut all = tally(1);
        all.join(tally(10));
        assert_eq!(all, tally(11));
    }
}
