//! What `check` says: verdicts and golden values of studies, as text and as Markdown.

use crate::golden::compare::Change;
use crate::judge::judgement::Judgement;
use crate::judge::study_check::{CaseNote, CheckEnd, StudyCheck};
use crate::judge::verdict::VerdictOutcome;
use crate::render::checks::failures;
use crate::render::checks::items::{items_of, wrapped};
use crate::render::render_error::RenderError;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::render::tables::{golden_changes, uncertainties};
use std::fmt::Write;

/// A study's check as text, what failed in lines of a terminal's width. `file` is the study's own.
pub fn text_of(check: &StudyCheck, file: Option<&str>) -> String {
    let mut text = wrapped(&format!("{}: {}", check.study, headline(check)), "", "  ");
    text += &failures::text_of(check);
    if let Some(table) = uncertainties::table_of(&check.judgements) {
        text += &items_of(&table);
    }
    for warning in &check.warnings {
        text += &wrapped(&format!("warning: {warning}"), "  ", "    ");
    }
    if let Some(command) = next_command(check, file) {
        let _ = writeln!(text, "\nnext: {command}");
    }
    text
}

/// The checks of several studies as Markdown. `file_of` knows the file of a study.
///
/// # Errors
/// If a table cannot be written.
pub fn markdown_of(
    checks: &[StudyCheck],
    file_of: impl Fn(&str) -> Option<String>,
) -> Result<String, RenderError> {
    let mut text = "## oedometer check\n".to_owned();
    // Those that did not pass lead: a forge cuts a long summary at its end.
    let (sound, unsound): (Vec<_>, Vec<_>) = checks.iter().partition(|check| check.end() == CheckEnd::Pass);
    for check in unsound.into_iter().chain(sound) {
        let _ = write!(text, "\n### {}: {}\n", check.study, headline(check));
        for group in &check.groups {
            let _ = write!(text, "\n{}\n", golden_changes::sentence(group));
        }
        if let Some(command) = next_command(check, file_of(&check.study).as_deref()) {
            let _ = write!(text, "\nNext: `{command}`\n");
        }
        for table in tables_of(check) {
            let _ = write!(text, "\n{}\n", table.to_markdown()?);
        }
        for warning in &check.warnings {
            let _ = write!(text, "\nWarning: {warning}\n");
        }
    }
    Ok(text)
}

/// What stands against taking the values of a study as golden: expectations that fail, cases that fail,
/// records that cannot be right; `None` where nothing does.
pub fn objections_of(check: &StudyCheck) -> Option<String> {
    let unmet = check.judgements.iter().any(|judgement| !judgement.verdict.pass);
    let stands = unmet || !check.failed_cases.is_empty() || !check.unsound.is_empty();
    stands.then(|| format!("{}\n{}", check.study, failures::text_of_failures(check)))
}

/// What to type next where something failed: what explains the worst of it.
pub fn next_command(check: &StudyCheck, file: Option<&str>) -> Option<String> {
    let file = file?;
    let explain = |what: &str| Some(format!("oedometer explain \"{what}\" {file}"));
    let failed = check.failed_cases.first().or(check.unsound.first());
    let unmet = check.judgements.iter().any(|judgement| !judgement.verdict.pass);
    match check.groups.first() {
        Some(group) if group.change == Change::Moved => explain(&group.worst.name),
        _ if failed.is_some() => explain(&failed?.case),
        _ if unmet => Some(format!("oedometer report {file}")),
        None if check.golden.is_ok() => None,
        _ => Some(format!("oedometer accept {file} --reason \"why the new values are right\"")),
    }
}

/// Every judgement of all studies in one table, for programs.
pub fn all_judgements(checks: &[StudyCheck]) -> Table {
    let mut whole = judgements_table("", &[]);
    whole.columns.insert(0, TableColumn::text("study"));
    for check in checks {
        let judgements: Vec<&Judgement> = check.judgements.iter().collect();
        for mut row in judgements_table("", &judgements).rows {
            row.insert(0, check.study.as_str().into());
            whole.rows.push(row);
        }
        let agrees = check.golden.is_ok() && check.differences().is_empty();
        let (mood, word) = if agrees { (Mood::Pass, "pass") } else { (Mood::Fail, "fail") };
        whole.rows.push(vec![
            check.study.as_str().into(),
            Cell::Verdict(mood, word.to_owned()),
            "golden values".into(),
            "".into(),
            Cell::Text(headline(check)),
        ]);
    }
    whole
}

fn headline(check: &StudyCheck) -> String {
    let passed = check.judgements.iter().filter(|judgement| judgement.verdict.pass).count();
    let golden = match &check.golden {
        Ok(differences) if differences.is_empty() => format!("{} golden values agree", check.agreeing),
        Ok(differences) => format!("{} golden values agree, {} do not", check.agreeing, differences.len()),
        Err(error) => error.to_string(),
    };
    let count = |count: usize, one: &str, several: &str| match count {
        0 => String::new(),
        count => format!(", {}", golden_changes::count_of(count, one, several)),
    };
    let failed = count(check.failed_cases.len(), "case failed", "cases failed");
    let unsound = count(check.unsound.len(), "complaint about records", "complaints about records");
    format!("{passed} of {} expectations met{failed}{unsound}, {golden}", check.judgements.len())
}

fn tables_of(check: &StudyCheck) -> Vec<Table> {
    let mut tables = Vec::new();
    let unmet: Vec<_> = check.judgements.iter().filter(|judgement| !judgement.verdict.pass).collect();
    if !unmet.is_empty() {
        tables.push(judgements_table("expectations not met", &unmet));
    }
    tables.extend(uncertainties::table_of(&check.judgements));
    for (title, notes) in
        [("failed cases", &check.failed_cases), ("records that cannot be right", &check.unsound)]
    {
        if !notes.is_empty() {
            let row = |note: &CaseNote| vec![Cell::Code(note.case.clone()), note.sentence.as_str().into()];
            tables.push(Table::of(title, columns("case | how"), notes.iter().map(row)));
        }
    }
    if !check.differences().is_empty() {
        tables.push(golden_changes::differences_table(check.differences()));
        tables.push(golden_changes::changes_table(&check.changes));
    }
    tables
}

/// Judgements as a table, each with its reason.
pub fn judgements_table(title: &str, judgements: &[&Judgement]) -> Table {
    let rows = judgements.iter().map(|judgement| {
        let verdict = &judgement.verdict;
        let mood = match (verdict.pass, verdict.outcome) {
            (true, VerdictOutcome::KnownFailure) => Mood::Note,
            (true, _) => Mood::Pass,
            (false, _) => Mood::Fail,
        };
        let outcome = match verdict.outcome {
            VerdictOutcome::Passed => "pass",
            VerdictOutcome::Failed => "fail",
            VerdictOutcome::KnownFailure => "known failure",
            VerdictOutcome::UnexpectedPass => "unexpected pass",
        };
        vec![
            Cell::Verdict(mood, outcome.to_owned()),
            judgement.subject.as_str().into(),
            verdict.classification.class.name().into(),
            verdict.reason.as_str().into(),
        ]
    });
    Table::of(title, columns("verdict | series | class | reason"), rows)
}
