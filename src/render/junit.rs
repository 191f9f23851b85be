//! `JUnit`, in the Jenkins dialect: one suite a study, one case an expectation and one for its
//! golden values.

use crate::assess::study_check::StudyCheck;
use quick_junit::{NonSuccessKind, Property, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;

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
            let name = format!("{}/{}", check.study, judgement.subject);
            // Two expectations of one series are told apart by their place in the file.
            let count = seen.entry(name.clone()).or_default();
            *count += 1;
            let name = if *count > 1 { format!("{name} (line {})", judgement.line) } else { name };
            let mut case = TestCase::new(name, status(judgement.verdict.pass, &judgement.verdict.reason));
            for measured in &judgement.verdict.checks {
                if let Some(value) = measured.measured {
                    case.add_property(Property::new(measured.name.clone(), format!("{value:.6e}")));
                }
            }
            suite.add_test_case(case);
        }
        for (label, sentence) in &check.failed_cases {
            suite.add_test_case(TestCase::new(
                format!("{}/{label}/run", check.study),
                status(false, sentence),
            ));
        }
        let (agrees, sentence) = match &check.golden {
            Ok(differences) if differences.is_empty() => (true, String::new()),
            Ok(differences) => {
                let names: Vec<&str> = differences.iter().map(|one| one.name.as_str()).collect();
                (false, format!("{} values: {}", differences.len(), names.join("; ")))
            }
            Err(error) => (false, error.to_string()),
        };
        suite.add_test_case(TestCase::new(format!("{}/golden", check.study), status(agrees, &sentence)));
        report.add_test_suite(suite);
    }
    report.to_string()
}

fn status(pass: bool, sentence: &str) -> TestCaseStatus {
    if pass {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(sentence);
    status
}
