//! The results of `check` for a terminal, as Markdown, as annotations of a forge and as `JUnit`.

mod forge;
pub mod verdicts;

pub use forge::{annotations_of, junit};

use crate::judge::study_check::StudyCheck;

/// Something that failed, with the sentence on it.
struct Failure<'a> {
    /// Line of the study file that asked for it.
    line: usize,
    subject: &'a str,
    sentence: String,
}

/// Titles of the lists of failures, in the order of [`failures_of`].
const TITLES: [&str; 3] = ["expectations not met", "failed cases", "records that cannot be right"];

/// What failed in a check, golden values aside: unmet expectations, failed cases, and records that cannot be right.
fn failures_of(check: &StudyCheck) -> [Vec<Failure<'_>>; 3] {
    let unmet = check.judgements.iter().filter(|judgement| !judgement.verdict.pass).map(|judgement| {
        let (class, reason) = (judgement.verdict.classification.class.name(), &judgement.verdict.reason);
        Failure { line: judgement.line, subject: &judgement.subject, sentence: format!("{class}: {reason}") }
    });
    let of_cases = [&check.failed_cases, &check.unsound].map(|notes| {
        let failure = |note: &'_ crate::judge::study_check::CaseNote| note.sentence.clone();
        notes.iter().map(|note| Failure { line: 1, subject: &note.case, sentence: failure(note) }).collect()
    });
    let [failed, unsound] = of_cases;
    [unmet.collect(), failed, unsound]
}
