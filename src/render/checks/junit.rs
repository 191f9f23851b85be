//! `JUnit`, in the Jenkins dialect: one suite a study, one case a check of an expectation, named
//! `study/method/quantity/check`, and one for its records and its golden values each.

use crate::judge::judgement::Judgement;
use crate::judge::study_check::{CaseNote, StudyCheck};
use crate::judge::verdict::VerdictOutcome;
use crate::render::tables::golden_changes::sentence;
use quick_junit::{NonSuccessKind, Property, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;

/// Golden values that are named, the worst first.
const MOST_NAMED: usize = 10;

/// Checks as a `JUnit` document.
///
/// # Errors
/// If the document cannot be written.
pub fn report_of(checks: &[StudyCheck]) -> Result<String, SerializeError> {
    let mut report = Report::new("oedometer");
    for check in checks {
        let mut suite = TestSuite::new(check.study.clone());
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
        for CaseNote { case, sentence } in check.failed_cases.iter().chain(&check.unsound) {
            suite
                .add_test_case(TestCase::new(format!("{}/{case}/run", check.study), status(false, sentence)));
        }
        let (agrees, sentence) = match &check.golden {
            Ok(differences) if differences.is_empty() => (true, String::new()),
            Ok(differences) => {
                let groups: Vec<String> = check.groups.iter().map(sentence).collect();
                let worst = differences.iter().take(MOST_NAMED).map(|one| one.name.as_str());
                let worst: Vec<&str> = worst.collect();
                (false, format!("{}. The worst: {}", groups.join(". "), worst.join("; ")))
            }
            Err(error) => (false, error.to_string()),
        };
        suite.add_test_case(TestCase::new(format!("{}/golden", check.study), status(agrees, &sentence)));
        report.add_test_suite(suite);
    }
    report.to_string()
}

/// One case a check; a known failure counts as skipped, an unexpected pass as a failure.
fn cases_of(check: &StudyCheck, judgement: &Judgement) -> Vec<TestCase> {
    let subject = judgement.subject.replacen(": ", "/", 1);
    let verdict = &judgement.verdict;
    let mut cases: Vec<TestCase> = verdict
        .checks
        .iter()
        .map(|measured| {
            let status = if !measured.pass && verdict.outcome == VerdictOutcome::KnownFailure {
                let mut skipped = TestCaseStatus::skipped();
                skipped.set_message(verdict.reason.clone());
                skipped
            } else {
                status(measured.pass, &measured.reason)
            };
            let mut case = TestCase::new(format!("{}/{subject}/{}", check.study, measured.name), status);
            if let Some(value) = measured.measured {
                case.add_property(Property::new(measured.name.clone(), format!("{value:.6e}")));
            }
            case.add_property(Property::new("class", verdict.classification.class.name()));
            case
        })
        .collect();
    if verdict.outcome == VerdictOutcome::UnexpectedPass {
        let name = format!("{}/{subject}/known failure", check.study);
        cases.push(TestCase::new(name, status(false, &verdict.reason)));
    }
    cases
}

fn status(pass: bool, sentence: &str) -> TestCaseStatus {
    if pass {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(sentence);
    status
}
