//! The results of `check` and of `score` as `JUnit`, in the Jenkins dialect.

use crate::campaign::taken_over::TakenOver;
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::judge::verdict::{Check, Judgement, VerdictOutcome};
use crate::report::tables::golden_changes::sentence;
use quick_junit::{NonSuccessKind, Property, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;

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
        for note in check.failed_cases.iter().chain(&check.unsound) {
            let name = format!("{}/{}/run", check.study, note.case);
            suite.add_test_case(TestCase::new(name, status(false, &note.sentence)));
        }
        let (agrees, sentence) = match &check.golden_problem {
            None => {
                let inputs = check.sentence_on_inputs().into_iter();
                let sentences: Vec<String> = inputs.chain(check.groups.iter().map(sentence)).collect();
                (sentences.is_empty(), sentences.join(". "))
            }
            Some(error) => (false, error.to_string()),
        };
        let status = match check.end() {
            CheckEnd::HeldBack => skipped("its programs must not be started without --allow-solvers"),
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
pub struct ScoredCase {
    /// Name of the case, `file/quantity/time`.
    pub subject: String,
    /// Why it fails, if it does.
    pub failure: Option<String>,
}

/// What `score` judged as a `JUnit` document of one suite, with sentences on what the result looks like.
///
/// # Errors
/// If the document cannot be written.
pub fn junit_of_score(
    scene: &str,
    cases: &[ScoredCase],
    diagnosis: impl Iterator<Item = String>,
) -> Result<String, SerializeError> {
    let mut report = Report::new("oedometer");
    let mut suite = TestSuite::new(format!("score {scene}"));
    for one in cases {
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
    let case = |measured: &'_ Check| {
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
mod tests {
    use super::*;
    use crate::report::annotations::annotations_of;
    use crate::report::tests::check;

    #[test]
    fn a_changed_input_fails_in_every_form_although_no_value_moved() {
        let changed =
            StudyCheck { other_inputs: vec!["MPM cells=4".to_owned()], warnings: Vec::new(), ..check(0) };
        let told = "1 case has other inputs than its golden values, like `MPM cells=4`: `git diff` of the \
                    study shows which";
        let lines = annotations_of(std::slice::from_ref(&changed), |_| None);
        assert_eq!(lines, [format!("::error title=study%3A inputs changed::{told}")]);
        let document = junit(&[changed]).unwrap();
        assert!(document.contains(r#"failures="1""#), "{document}");
        assert!(document.contains(told), "{document}");
        assert!(junit(&[check(0)]).unwrap().contains(r#"failures="0""#));
    }
}
