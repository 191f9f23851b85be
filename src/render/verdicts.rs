//! What `check` says: verdicts and golden values of studies, as text and as Markdown.

use super::RenderError;
use super::number;
use super::table::{Cell, Column, Mood, Table};
use super::uncertainties;
use crate::assess::pareto::ParetoChange;
use crate::assess::study_check::{CaseNote, StudyCheck};
use crate::assess::summary::Judgement;
use crate::assess::verdict::Outcome;
use crate::golden::{CaseChange, Difference};
use std::fmt::Write;

/// Differences shown before the rest is only counted.
const MOST_DIFFERENCES: usize = 40;

/// A study's check as text.
///
/// # Errors
/// If a table cannot be written.
pub fn text_of(check: &StudyCheck) -> Result<String, RenderError> {
    let mut text = format!("{}: {}\n", check.study, headline(check));
    for table in tables_of(check) {
        let _ = write!(text, "\n{}\n", table.to_text()?);
    }
    for warning in &check.warnings {
        let _ = writeln!(text, "  warning: {warning}");
    }
    Ok(text)
}

/// The checks of several studies as Markdown.
///
/// # Errors
/// If a table cannot be written.
pub fn markdown_of(checks: &[StudyCheck]) -> Result<String, RenderError> {
    let mut text = "## oedometer check\n".to_owned();
    for check in checks {
        let _ = write!(text, "\n### {}: {}\n", check.study, headline(check));
        for table in tables_of(check) {
            let _ = write!(text, "\n{}\n", table.to_markdown()?);
        }
        for warning in &check.warnings {
            let _ = write!(text, "\nWarning: {warning}\n");
        }
    }
    Ok(text)
}

/// Every judgement of all studies in one table, for programs.
pub fn all_judgements(checks: &[StudyCheck]) -> Table {
    let mut whole = judgements_table("", &[]);
    whole.columns.insert(0, Column::text("study"));
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
    let count = |count: usize, what: &str| match count {
        0 => String::new(),
        count => format!(", {count} {what}"),
    };
    let failed = count(check.failed_cases.len(), "cases failed");
    let unsound = count(check.unsound.len(), "complaints about records");
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
            tables.push(Table {
                title: title.to_owned(),
                columns: vec![Column::text("case"), Column::text("how")],
                rows: notes.iter().map(row).collect(),
                notes: Vec::new(),
            });
        }
    }
    if !check.differences().is_empty() {
        tables.push(differences_table(check.differences()));
        tables.push(changes_table(&check.changes));
    }
    tables
}

/// Cases that differ from their golden values, accuracy and cost together.
fn changes_table(changes: &[CaseChange]) -> Table {
    let rows = changes.iter().take(MOST_DIFFERENCES).map(|one| {
        let (mood, word) = match one.change {
            ParetoChange::Same => (Mood::Pass, "same"),
            ParetoChange::Better => (Mood::Note, "better"),
            ParetoChange::Traded if one.is_stale() => (Mood::Note, "cost traded for accuracy"),
            ParetoChange::Traded => (Mood::Fail, "better here, worse there"),
            ParetoChange::Dominated => (Mood::Fail, "dominated by its golden values"),
            ParetoChange::NotComparable => (Mood::Fail, "values without a partner"),
        };
        vec![
            Cell::Verdict(mood, word.to_owned()),
            Cell::Code(one.case.clone()),
            Cell::Number(one.cost_ratio),
            Cell::Count(one.worse as u64),
            Cell::Count(one.better as u64),
            Cell::Count(one.unpaired as u64),
        ]
    });
    Table {
        title: "accuracy and cost together".to_owned(),
        columns: vec![
            Column::text("change"),
            Column::text("case"),
            Column::number("cost over golden"),
            Column::number("errors that grew"),
            Column::number("errors that fell"),
            Column::number("without partner"),
        ],
        rows: rows.collect(),
        notes: Vec::new(),
    }
}

/// Judgements as a table, each with its reason.
pub fn judgements_table(title: &str, judgements: &[&Judgement]) -> Table {
    let rows = judgements.iter().map(|judgement| {
        let verdict = &judgement.verdict;
        let mood = match (verdict.pass, verdict.outcome) {
            (true, Outcome::KnownFailure) => Mood::Note,
            (true, _) => Mood::Pass,
            (false, _) => Mood::Fail,
        };
        let outcome = match verdict.outcome {
            Outcome::Passed => "pass",
            Outcome::Failed => "fail",
            Outcome::KnownFailure => "known failure",
            Outcome::UnexpectedPass => "unexpected pass",
        };
        vec![
            Cell::Verdict(mood, outcome.to_owned()),
            judgement.subject.as_str().into(),
            verdict.classification.class.name().into(),
            verdict.reason.as_str().into(),
        ]
    });
    Table {
        title: title.to_owned(),
        columns: vec![
            Column::text("verdict"),
            Column::text("series"),
            Column::text("class"),
            Column::text("reason"),
        ],
        rows: rows.collect(),
        notes: Vec::new(),
    }
}

/// Values that differ from their golden ones.
pub fn differences_table(differences: &[Difference]) -> Table {
    let value = |value: Option<f64>| {
        value.map_or(Cell::Missing("no value".to_owned()), |v| number::exact(v).as_str().into())
    };
    let rows = differences.iter().take(MOST_DIFFERENCES).map(|one| {
        let change = match (one.golden, one.found) {
            (Some(golden), Some(found)) => Cell::Error(found - golden),
            _ => Cell::Missing("nothing to compare".to_owned()),
        };
        vec![
            one.change.name().into(),
            one.name.as_str().into(),
            value(one.golden),
            value(one.found),
            change,
            Cell::Error(one.tolerance),
        ]
    });
    let rest = differences.len().saturating_sub(MOST_DIFFERENCES);
    Table {
        title: "golden values that moved".to_owned(),
        columns: vec![
            Column::text("change"),
            Column::text("value"),
            Column::number("golden"),
            Column::number("now"),
            Column::number("difference"),
            Column::number("tolerance"),
        ],
        rows: rows.collect(),
        notes: if rest > 0 { vec![format!("and {rest} more")] } else { Vec::new() },
    }
}
