//! The results of `check` as annotations of GitHub's workflows, at the line of the study that asked for it.

use crate::campaign::taken_over::TakenOver;
use crate::golden::compare::Change;
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::report::tables::golden_changes::sentence;

/// Annotations before the rest is only counted: GitHub shows ten per step.
const MOST: usize = 9;

/// The annotations of checks, failures first, at most nine and one that counts the others.
/// `file_of` gives the file of a study.
pub fn annotations_of(checks: &[StudyCheck], file_of: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for check in checks {
        let file = file_of(&check.study);
        let mut add = |level: &str, line: usize, title: &str, message: &str| {
            let place =
                file.as_ref().map_or(String::new(), |file| format!("file={},line={line},", property(file)));
            let title = property(&format!("{}: {title}", check.study));
            all.push(format!("::{level} {place}title={title}::{}", data(message)));
        };
        let level = if check.end() == CheckEnd::Pass { "warning" } else { "error" };
        for diagnosis in &check.diagnoses {
            add(level, 1, "diagnosis", diagnosis);
        }
        for judgement in check.unmet() {
            let (class, reason) = (judgement.verdict.classification.class.name(), &judgement.verdict.reason);
            let class = if reason.starts_with(class) { String::new() } else { format!("{class}: ") };
            add("error", judgement.line, &judgement.subject, &format!("{class}{reason}"));
        }
        for note in check.failed_cases.iter().chain(&check.unsound) {
            add("error", 1, &note.case, &note.sentence);
        }
        if let Some(sentence) = check.sentence_on_inputs() {
            add("error", 1, "inputs changed", &sentence);
        }
        match &check.golden_problem {
            Some(_) if check.end() == CheckEnd::HeldBack => {
                add("warning", 1, "not run", "its programs must not be started without --allow-solvers");
            }
            Some(error) => add("error", 1, "golden values", &error.to_string()),
            None => {
                for group in &check.groups {
                    let level = if group.change == Change::Stale { "warning" } else { "error" };
                    add(level, 1, &format!("golden values {}", group.change.name()), &sentence(group));
                }
            }
        }
        for sentence in TakenOver::sentences(&check.taken_over) {
            add("notice", 1, "reused", &sentence);
        }
        for warning in &check.warnings {
            add("warning", 1, "wall time", warning);
        }
    }
    all.sort_by_key(|annotation| !annotation.starts_with("::error"));
    let more = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    if more > 0 {
        all.push(format!("::notice title=oedometer check::{more} more: see the summary"));
    }
    all
}

/// Text as the message of a workflow command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// Text as a property of a workflow command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::GoldenError;
    use crate::judge::study_check::CaseNote;
    use crate::report::tests::{check, group};

    #[test]
    fn nine_are_shown_and_the_others_counted() {
        let lines = annotations_of(&[check(3)], |_| None);
        assert_eq!(lines.len(), 4);
        assert_eq!(lines[0], "::error title=study%3A case 0::unstable: 5 %25,%0Asoon");
        assert!(lines[3].starts_with("::warning "), "failures come first: {lines:?}");
        let lines = annotations_of(&[check(20)], |study| Some(format!("studies/{study}.toml")));
        assert_eq!(lines.len(), 10);
        assert!(lines[0].starts_with("::error file=studies/study.toml,line=1,title="));
        assert_eq!(lines[9], "::notice title=oedometer check::12 more: see the summary");
        assert!(annotations_of(&[StudyCheck { warnings: Vec::new(), ..check(0) }], |_| None).is_empty());
        let last = |failures: usize| annotations_of(&[check(failures)], |_| None).pop().expect("some");
        assert_eq!(last(8), "::warning title=study%3A wall time::slow", "nine fit");
        assert_eq!(last(9), "::notice title=oedometer check::1 more: see the summary");
    }

    #[test]
    fn errors_of_any_study_come_before_the_warnings_of_all() {
        // Failed cases and warnings of two studies.
        for counts in [[(0, 12), (2, 0)], [(2, 0), (0, 12)], [(1, 12), (1, 0)], [(1, 3), (1, 9)]] {
            let checks = counts.map(|(failures, warnings)| StudyCheck {
                warnings: vec!["slow".to_owned(); warnings],
                ..check(failures)
            });
            let lines = annotations_of(&checks, |_| None);
            let count = |start: &str| lines.iter().filter(|line| line.starts_with(start)).count();
            assert_eq!([count("::error "), count("::warning "), count("::notice ")], [2, 7, 1], "{lines:?}");
            assert!(lines[..2].iter().all(|line| line.starts_with("::error ")), "{lines:?}");
            assert!(lines[9].ends_with("::5 more: see the summary"), "{lines:?}");
        }
    }

    #[test]
    fn only_a_golden_value_that_is_worse_than_the_present_one_is_a_warning() {
        let levels = |check: StudyCheck| {
            let lines = annotations_of(&[StudyCheck { warnings: Vec::new(), ..check }], |_| None);
            lines
                .iter()
                .map(|line| line.split("::").nth(1).unwrap_or_default().to_owned())
                .collect::<Vec<_>>()
        };
        for (change, level) in [
            (Change::Moved, "error"),
            (Change::Missing, "error"),
            (Change::Extra, "error"),
            (Change::Smaller, "error"),
            (Change::Stale, "warning"),
        ] {
            let found = levels(StudyCheck { groups: vec![group(change)], ..check(0) });
            assert_eq!(found, [format!("{level} title=study%3A golden values {}", property(change.name()))]);
        }
        let missing = GoldenError::Missing("study.csv".into());
        assert_eq!(
            levels(StudyCheck { golden_problem: Some(missing), ..check(0) }),
            ["error title=study%3A golden values"]
        );
        let unsound = vec![CaseNote { case: "case".to_owned(), sentence: "water is lost".to_owned() }];
        assert_eq!(levels(StudyCheck { unsound, ..check(0) }), ["error title=study%3A case"]);
    }
}
