//! Checks that tests of this folder share.

use crate::golden::compare::{Change, Difference, DifferenceGroup};
use crate::golden::measure::key;
use crate::judge::study_check::{CaseNote, StudyCheck};

/// Golden values of one kind of change.
pub(super) fn group(change: Change) -> DifferenceGroup {
    let key = key("MPM", 0.1, "pressure points terzaghi");
    let worst = Difference { key, change, golden: Some(1.0), found: Some(2.0), tolerance: 1e-9 };
    let shared = Vec::new();
    DifferenceGroup {
        change,
        values: 1,
        cases: 1,
        shared_by_cases: shared.clone(),
        shared_by_measures: shared,
        worst,
        place: None,
    }
}

/// A check with failed cases and a warning.
pub(super) fn check(failures: usize) -> StudyCheck {
    let note =
        |number| CaseNote { case: format!("case {number}"), sentence: "unstable: 5 %,\nsoon".to_owned() };
    StudyCheck {
        study: "study".to_owned(),
        failed_cases: (0..failures).map(note).collect(),
        compares_golden: true,
        warnings: vec!["slow".to_owned()],
        ..StudyCheck::default()
    }
}
