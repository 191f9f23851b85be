//! The results of `check` as annotations of GitHub's workflows at the line of the study that
//! asked for it, and as `JUnit` in the Jenkins dialect.

use crate::campaign::taken_over::TakenOver;
use crate::golden::compare::Change;
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::judge::verdict::{Judgement, VerdictOutcome};
use crate::report::tables::golden_changes::sentence;
use quick_junit::{NonSuccessKind, Property, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;

/// Something that failed, with the sentence on it.
pub(super) struct Failure<'a> {
    /// Line of the study file that asked for it.
    line: usize,
    pub(super) subject: &'a str,
    sentence: String,
}

/// What failed in a check, golden values aside: unmet expectations, failed cases, and records that break a balance or a bound.
pub(super) fn failures_of(check: &StudyCheck) -> [Vec<Failure<'_>>; 3] {
    let unmet = check.judgements.iter().filter(|judgement| !judgement.verdict.pass).map(|judgement| {
        let (class, reason) = (judgement.verdict.classification.class.name(), &judgement.verdict.reason);
        let sentence = if reason.starts_with(class) { reason.clone() } else { format!("{class}: {reason}") };
        Failure { line: judgement.line, subject: &judgement.subject, sentence }
    });
    let of_cases = [&check.failed_cases, &check.unsound].map(|notes| {
        let failure = |note: &'_ crate::judge::study_check::CaseNote| note.sentence.clone();
        notes.iter().map(|note| Failure { line: 1, subject: &note.case, sentence: failure(note) }).collect()
    });
    let [failed, unsound] = of_cases;
    [unmet.collect(), failed, unsound]
}

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
        for failure in failures_of(check).into_iter().flatten() {
            add("error", failure.line, failure.subject, &failure.sentence);
        }
        if let Some(told) = check.told_inputs() {
            add("error", 1, "inputs changed", &told);
        }
        match &check.golden {
            Err(_) if check.end() == CheckEnd::HeldBack => {
                add("warning", 1, "not run", "its programs may not be started without --allow-solvers");
            }
            Err(error) => add("error", 1, "golden values", &error.to_string()),
            Ok(_) => {
                for group in &check.groups {
                    let level = if group.change == Change::Stale { "warning" } else { "error" };
                    add(level, 1, &format!("golden values {}", group.change.name()), &sentence(group));
                }
            }
        }
        for sentence in TakenOver::sentences(&check.taken_over) {
            add("notice", 1, "taken over", &sentence);
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

/// Golden values that `JUnit` names, the worst first.
const MOST_NAMED: usize = 10;

/// Checks as a `JUnit` document: one suite per study; one case per check of an expectation, named
/// `study/method/quantity/check`, one per bad record, and one for the golden values.
///
/// # Errors
/// If the document cannot be written.
pub fn junit(checks: &[StudyCheck]) -> Result<String, SerializeError> {
    let mut report = Report::new("oedometer");
    for check in checks {
        let mut suite = TestSuite::new(check.study.clone());
        for sentence in TakenOver::sentences(&check.taken_over) {
            suite.add_property(Property::new("taken over", sentence));
        }
        if !check.diagnoses.is_empty() {
            // First, because it is the cause of what fails below.
            let mut status = status(check.end() == CheckEnd::Pass, &check.diagnoses.join("\n"));
            if matches!(status, TestCaseStatus::NonSuccess { .. }) {
                status.set_type("diagnosis");
            }
            let mut case = TestCase::new(format!("{}/diagnosis", check.study), status);
            case.set_system_out(check.diagnoses.join("\n"));
            suite.add_test_case(case);
        }
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for judgement in &check.judgements {
            for mut case in cases_of(check, judgement) {
                // Two expectations of one series are told apart by their place in the file.
                let count = seen.entry(case.name.to_string()).or_default();
                *count += 1;
                if *count > 1 {
                    case.name = format!("{} (line {})", case.name.as_str(), judgement.line).into();
                }
                suite.add_test_case(case);
            }
        }
        let [_, failed, unsound] = failures_of(check);
        for failure in failed.into_iter().chain(unsound) {
            let name = format!("{}/{}/run", check.study, failure.subject);
            suite.add_test_case(TestCase::new(name, status(false, &failure.sentence)));
        }
        let (agrees, sentence) = match &check.golden {
            Ok(differences) => {
                let inputs = check.told_inputs().into_iter();
                let mut sentences: Vec<String> = inputs.chain(check.groups.iter().map(sentence)).collect();
                if !differences.is_empty() {
                    let worst = differences.iter().take(MOST_NAMED).map(|one| one.key.to_string());
                    sentences.push(format!("The worst: {}", worst.collect::<Vec<_>>().join("; ")));
                }
                (sentences.is_empty(), sentences.join(". "))
            }
            Err(error) => (false, error.to_string()),
        };
        let status = match check.end() {
            CheckEnd::HeldBack => skipped("its programs may not be started without --allow-solvers"),
            _ => status(agrees, &sentence),
        };
        if check.compares_golden || check.end() == CheckEnd::HeldBack {
            suite.add_test_case(TestCase::new(format!("{}/golden", check.study), status));
        }
        report.add_test_suite(suite);
    }
    report.to_string()
}

/// Something that `score` judged: a file and what of it, and how it fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Name of the case, `file/quantity/time`.
    pub subject: String,
    /// Why it fails, if it does.
    pub failure: Option<String>,
}

/// What `score` judged as a `JUnit` document of one suite, with sentences on what the result looks like.
///
/// # Errors
/// If the document cannot be written.
pub fn junit_of_findings(
    scene: &str,
    findings: &[Finding],
    diagnosis: impl Iterator<Item = String>,
) -> Result<String, SerializeError> {
    let mut report = Report::new("oedometer");
    let mut suite = TestSuite::new(format!("score {scene}"));
    for one in findings {
        let status = status(one.failure.is_none(), one.failure.as_deref().unwrap_or_default());
        suite.add_test_case(TestCase::new(one.subject.clone(), status));
    }
    for sentence in diagnosis {
        suite.add_property(Property::new("diagnosis", sentence));
    }
    report.add_test_suite(suite);
    report.to_string()
}

/// One case per check; a known failure counts as skipped, an unexpected pass as a failure.
fn cases_of(check: &StudyCheck, judgement: &Judgement) -> Vec<TestCase> {
    let name = format!("{}/{}", check.study, judgement.subject.replacen(": ", "/", 1));
    let verdict = &judgement.verdict;
    let case = |measured: &'_ crate::judge::verdict::Check| {
        let status = if !measured.pass && verdict.outcome == VerdictOutcome::KnownFailure {
            skipped(&verdict.reason)
        } else {
            status(measured.pass, &measured.reason)
        };
        let mut case = TestCase::new(format!("{name}/{}", measured.name), status);
        if let Some(value) = measured.measured {
            case.add_property(Property::new(measured.name.clone(), format!("{value:.6e}")));
        }
        case.add_property(Property::new("class", verdict.classification.class.name()));
        case
    };
    let mut cases: Vec<TestCase> = verdict.checks.iter().map(case).collect();
    if verdict.outcome == VerdictOutcome::UnexpectedPass {
        cases.push(TestCase::new(format!("{name}/known failure"), status(false, &verdict.reason)));
    }
    cases
}

fn skipped(why: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::skipped();
    status.set_message(why);
    status
}

fn status(pass: bool, sentence: &str) -> TestCaseStatus {
    if pass {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(sentence);
    status
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::golden::GoldenError;
    use crate::golden::compare::{Difference, DifferenceGroup};
    use crate::golden::measure::key;
    use crate::judge::study_check::CaseNote;

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
            levels(StudyCheck { golden: Err(missing), ..check(0) }),
            ["error title=study%3A golden values"]
        );
        let unsound = vec![CaseNote { case: "case".to_owned(), sentence: "water is lost".to_owned() }];
        assert_eq!(levels(StudyCheck { unsound, ..check(0) }), ["error title=study%3A case"]);
    }

    #[test]
    fn a_changed_input_fails_in_every_form_although_no_value_moved() {
        let changed =
            StudyCheck { other_inputs: vec!["MPM cells=4".to_owned()], warnings: Vec::new(), ..check(0) };
        let told = "1 case is of other inputs than its golden values, like `MPM cells=4`: `git diff` of the study shows which";
        let lines = annotations_of(std::slice::from_ref(&changed), |_| None);
        assert_eq!(lines, [format!("::error title=study%3A inputs changed::{told}")]);
        let document = junit(&[changed]).unwrap();
        assert!(document.contains(r#"failures="1""#), "{document}");
        assert!(document.contains(told), "{document}");
        assert!(junit(&[check(0)]).unwrap().contains(r#"failures="0""#));
    }
}
