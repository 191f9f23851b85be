//! What fails in a check, golden values aside.

use crate::judge::study_check::{CaseNote, StudyCheck};

/// Something that failed, with the sentence on it.
pub(super) struct Failure<'a> {
    /// Line of the study file that asked for it.
    pub(super) line: usize,
    pub(super) subject: &'a str,
    pub(super) sentence: String,
}

/// What failed in a check, golden values aside: unmet expectations, failed cases, and records that break a balance or a bound.
pub(super) fn failures_of(check: &StudyCheck) -> [Vec<Failure<'_>>; 3] {
    let unmet = check.judgements.iter().filter(|judgement| !judgement.verdict.pass).map(|judgement| {
        let (class, reason) = (judgement.verdict.classification.class.name(), &judgement.verdict.reason);
        let sentence = if reason.starts_with(class) { reason.clone() } else { format!("{class}: {reason}") };
        Failure { line: judgement.line, subject: &judgement.subject, sentence }
    });
    let of_cases = [&check.failed_cases, &check.unsound].map(|notes| {
        let failure = |note: &'_ CaseNote| note.sentence.clone();
        notes.iter().map(|note| Failure { line: 1, subject: &note.case, sentence: failure(note) }).collect()
    });
    let [failed, unsound] = of_cases;
    [unmet.collect(), failed, unsound]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::golden::compare::{Change, Difference, DifferenceGroup};
    use crate::golden::measure::key;

    /// Golden values of one kind of change.
    pub(in crate::report) fn group(change: Change) -> DifferenceGroup {
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
    pub(in crate::report) fn check(failures: usize) -> StudyCheck {
        let note =
            |number| CaseNote { case: format!("case {number}"), sentence: "unstable: 5 %,\nsoon".to_owned() };
        StudyCheck {
            study: "study".to_owned(),
            failed_cases: (0..failures).map(note).collect(),
            unsound: Vec::new(),
            other_inputs: Vec::new(),
            input_changes: Vec::new(),
            proposals: Vec::new(),
            judgements: Vec::new(),
            golden: Ok(Vec::new()),
            compares_golden: true,
            groups: Vec::new(),
            changes: Vec::new(),
            agreeing: 0,
            expected: 0,
            unjudged: 0,
            held_back: 0,
            taken_over: Vec::new(),
            warnings: vec!["slow".to_owned()],
            diagnoses: Vec::new(),
        }
    }
}
