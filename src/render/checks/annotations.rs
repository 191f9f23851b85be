//! Annotations of GitHub's workflows: what is wrong, at the line of the study that asked for it.

use crate::golden::compare::Change;
use crate::judge::study_check::StudyCheck;
use crate::render::tables::golden_changes::sentence;

/// Annotations before the rest is only counted: GitHub shows ten a step.
const MOST: usize = 9;

/// One annotation before it is written.
struct Annotation {
    level: &'static str,
    file: Option<String>,
    line: usize,
    title: String,
    message: String,
}

/// The annotations of checks, failures first, at most nine and one that counts the others.
/// `file_of` knows the file of a study.
pub fn annotations_of(checks: &[StudyCheck], file_of: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let mut all: Vec<Annotation> =
        checks.iter().flat_map(|check| of_check(check, file_of(&check.study).as_deref())).collect();
    all.sort_by_key(|annotation| annotation.level != "error");
    let mut lines: Vec<String> = all.iter().take(MOST).map(Annotation::line).collect();
    if all.len() > MOST {
        lines.push(format!("::notice title=oedometer check::{} more: see the summary", all.len() - MOST));
    }
    lines
}

fn of_check(check: &StudyCheck, file: Option<&str>) -> Vec<Annotation> {
    let at = |level, line, title: String, message: String| Annotation {
        level,
        file: file.map(str::to_owned),
        line,
        title: format!("{}: {title}", check.study),
        message,
    };
    let mut all = Vec::new();
    for judgement in check.judgements.iter().filter(|judgement| !judgement.verdict.pass) {
        let reason = judgement.verdict.reason.clone();
        all.push(at("error", judgement.line, judgement.subject.clone(), reason));
    }
    for note in check.failed_cases.iter().chain(&check.unsound) {
        all.push(at("error", 1, note.case.clone(), note.sentence.clone()));
    }
    match &check.golden {
        Err(error) => all.push(at("error", 1, "golden values".to_owned(), error.to_string())),
        Ok(_) => {
            for group in &check.groups {
                let level = if group.change == Change::Stale { "warning" } else { "error" };
                all.push(at(level, 1, format!("golden values {}", group.change.name()), sentence(group)));
            }
        }
    }
    all.extend(
        check.warnings.iter().map(|warning| at("warning", 1, "wall time".to_owned(), warning.clone())),
    );
    all
}

impl Annotation {
    /// The workflow command.
    fn line(&self) -> String {
        let place = match &self.file {
            Some(file) => format!("file={},line={},", property(file), self.line),
            None => String::new(),
        };
        format!("::{} {place}title={}::{}", self.level, property(&self.title), data(&self.message))
    }
}

/// Text as the message of a command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// Text as a property of a command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::study_check::CaseNote;

    fn check(failures: usize) -> StudyCheck {
        let note =
            |number| CaseNote { case: format!("case {number}"), sentence: "unstable: 5 %,\nsoon".to_owned() };
        StudyCheck {
            study: "study".to_owned(),
            failed_cases: (0..failures).map(note).collect(),
            unsound: Vec::new(),
            judgements: Vec::new(),
            golden: Ok(Vec::new()),
            groups: Vec::new(),
            changes: Vec::new(),
            agreeing: 0,
            warnings: vec!["slow".to_owned()],
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
    }
}
