//! Verdicts and golden values of studies, as text in lines that fit a terminal and as Markdown.

use crate::campaign::taken_over::TakenOver;
use crate::golden::GoldenError;
use crate::golden::compare::{CaseChange, Change, Difference};
use crate::judge::study_check::{CheckEnd, StudyCheck};
use crate::judge::verdict::{Judgement, VerdictOutcome};
use crate::questions::finding::{Finding, Part, Place};
use crate::questions::findings::study_answers::StudyAnswers;
use crate::questions::sentence;
use crate::questions::uncertainty;
use crate::render::marked_text::paragraphs;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::blocks::answers::within;
use crate::report::checks::{TITLES, failures_of};
use crate::report::tables::convergence;
use crate::report::tables::golden_changes::{self, judgement_of, summary};
use oedometer_soil::wording::count_of;
use std::fmt::Write;

/// A study's check as text, what failed in lines of a terminal's width, with what it answers by itself. `file` is the study's own.
///
/// # Errors
/// If a table cannot be written.
pub fn text_of(check: &StudyCheck, file: Option<&str>, answers: &str) -> Result<String, RenderError> {
    let mut text = String::new();
    if let Some(why) = why_it_fails(check) {
        text += &wrapped(&format!("✗ {}: {why}", check.study), "", "  ");
    }
    for diagnosis in &check.diagnoses {
        text += &wrapped(&format!("diagnosis: {diagnosis}"), "  ", "    ");
    }
    text += &wrapped(&format!("{}: {}", check.study, headline(check)), "", "  ");
    for sentence in TakenOver::sentences(&check.taken_over) {
        text += &wrapped(&sentence, "  ", "    ");
    }
    text += &text_of_inputs(check);
    text += &text_of_failures(check);
    text += &text_of_changes(check);
    text += answers;
    if let Some(table) = uncertainty::table_of(&check.judgements) {
        text += &items_of(&table);
    }
    text += &text_of_proposals(check, file)?;
    for warning in &check.warnings {
        text += &wrapped(&format!("warning: {warning}"), "  ", "    ");
    }
    if let Some(command) = next_command(check, file) {
        let _ = writeln!(text, "\nnext: {command}");
    }
    Ok(text)
}

/// The verdict on a study in one line: as expected, not as expected, or not compared with golden values.
pub fn verdict_on(check: &StudyCheck) -> String {
    let mood = match check.end() {
        CheckEnd::Pass => Mood::Pass,
        CheckEnd::Golden if check.groups.is_empty() && check.other_inputs.is_empty() => Mood::Note,
        CheckEnd::HeldBack => Mood::Note,
        _ => Mood::Fail,
    };
    wrapped(&format!("{} {}: {}", mood.mark(), check.study, headline(check)), "", "  ")
}

/// Errors over the meshes with their rates, what it takes to come within a bound, and the answers of the questions.
///
/// # Errors
/// If a table cannot be written.
pub fn text_of_answers(answers: &StudyAnswers, findings: &[Finding]) -> Result<String, RenderError> {
    let mut text = String::new();
    for table in &answers.convergence {
        let heading = wrapped(&convergence::heading(table), "", "  ");
        let classes = wrapped(&convergence::classes(table), "", "  ");
        let _ = write!(text, "\n{heading}\n{}\n{classes}", convergence::table_of(table).to_text()?);
    }
    if let Some(finest) = &answers.finest {
        let heading = wrapped(&convergence::heading_of_finest(finest), "", "  ");
        let _ = write!(text, "\n{heading}\n{}", convergence::table_of_finest(finest).to_text()?);
    }
    text += &plain_paragraphs(&within(&answers.within)?);
    for finding in findings.iter().filter(|finding| finding.question.stands_at(Place::Terminal)) {
        text += &plain_paragraphs(&finding.sentence()?);
        text += &text_of_parts(finding, &finding.parts)?;
    }
    Ok(text)
}

/// The tables and sentences of an answer; figures and details stand on pages alone.
fn text_of_parts(finding: &Finding, parts: &[Part]) -> Result<String, RenderError> {
    let mut text = String::new();
    for part in parts {
        match part {
            Part::Sentence(template) => text += &plain_paragraphs(&finding.words(template)?),
            Part::Table(table) => text.extend(["\n", &table.to_text()?]),
            Part::Views(views) => {
                let first = views.first().map(|(_, parts)| text_of_parts(finding, parts)).transpose()?;
                text += &first.unwrap_or_default();
            }
            Part::Figures(_) | Part::Details(..) => {}
        }
    }
    Ok(text)
}

/// Paragraphs without their marks, in lines of a terminal's width.
fn plain_paragraphs(sentences: &str) -> String {
    let plain = |paragraph: &str| wrapped(&paragraph.replace(['*', '`'], ""), "", "  ");
    let mut text = String::new();
    for paragraph in paragraphs(sentences) {
        let _ = write!(text, "\n{}", plain(&paragraph));
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
        if let Some(why) = why_it_fails(check) {
            let _ = write!(text, "\n**Fails: {}**\n", markdown(&why));
        }
        for diagnosis in &check.diagnoses {
            let _ = write!(text, "\n**Diagnosis:** {}\n", markdown(diagnosis));
        }
        for sentence in TakenOver::sentences(&check.taken_over) {
            let _ = write!(text, "\n{sentence}\n");
        }
        if let Some(told) = check.told_inputs() {
            let _ = write!(text, "\n{}\n", markdown(&told));
        }
        for group in &check.groups {
            let _ = write!(text, "\n{}\n", golden_changes::sentence(group));
        }
        if let Some(command) = next_command(check, file_of(&check.study).as_deref()) {
            let _ = write!(text, "\nNext: `{command}`\n");
        }
        for table in tables_of(check) {
            let _ = write!(text, "\n{}\n", table.to_markdown()?);
        }
        if !check.proposals.is_empty() {
            let proposed = sentence::sentence("proposed", &())?;
            let _ = write!(text, "\n{proposed}\n\n```toml\n{}```\n", check.proposals.join("\n"));
        }
        for warning in &check.warnings {
            let _ = write!(text, "\nWarning: {warning}\n");
        }
    }
    Ok(text)
}

/// Why the values of a study cannot be golden: unmet expectations, failed cases, records that break a balance or a bound. `None`
/// where there is no reason.
pub fn objections_of(check: &StudyCheck) -> Option<String> {
    let text = text_of_failures(check);
    (!text.is_empty()).then(|| format!("{}\n{text}", check.study))
}

/// The command that explains the worst failure, if anything failed.
pub fn next_command(check: &StudyCheck, file: Option<&str>) -> Option<String> {
    let file = file?;
    let explain = |what: &str| Some(format!("oedometer explain \"{what}\" {file}"));
    let [unmet, failed, unsound] = failures_of(check);
    match (check.groups.first(), failed.first().or(unsound.first())) {
        (Some(group), _) if group.change == Change::Moved => explain(&group.worst.key.to_string()),
        (_, Some(failure)) => explain(failure.subject),
        _ if !unmet.is_empty() => Some(format!("oedometer report {file}")),
        (None, _) if check.golden.is_ok() && check.other_inputs.is_empty() => None,
        // What cannot be read says itself what to do, and what was not run cannot be accepted.
        _ if matches!(&check.golden, Err(error) if !error.is_missing()) || check.held_back > 0 => None,
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
        for one in &check.taken_over {
            let reason = TakenOver::sentences(std::slice::from_ref(one)).concat();
            whole.rows.push(vec![
                check.study.as_str().into(),
                Cell::Verdict(Mood::Note, "taken over".to_owned()),
                one.case.as_str().into(),
                "".into(),
                Cell::Text(reason),
            ]);
        }
        let agrees = check.golden.is_ok() && check.differences().is_empty() && check.other_inputs.is_empty();
        let (mood, word) = match (agrees, check.end()) {
            (true, _) => (Mood::Pass, "pass"),
            (false, CheckEnd::HeldBack) => (Mood::Note, "not run"),
            (false, _) => (Mood::Fail, "fail"),
        };
        let reason: Vec<String> = std::iter::once(headline(check)).chain(check.told_inputs()).collect();
        whole.rows.push(vec![
            check.study.as_str().into(),
            Cell::Verdict(mood, word.to_owned()),
            "golden values".into(),
            "".into(),
            Cell::Text(reason.join(". ")),
        ]);
    }
    whole
}

/// Text without what Markdown would take for markup of its own.
fn markdown(text: &str) -> String {
    text.replace('*', "\\*").replace('_', "\\_").replace('\n', " ")
}

/// What fails in a check, and why: the first failure with its reason. `None` where nothing does.
pub fn why_it_fails(check: &StudyCheck) -> Option<String> {
    if check.end() == CheckEnd::Pass {
        return None;
    }
    let failures: Vec<_> = failures_of(check).into_iter().flatten().collect();
    let more =
        |count: usize| if count > 1 { format!(" (and {} more below)", count - 1) } else { String::new() };
    let first =
        failures.first().map(|one| format!("{}: {}{}", one.subject, one.sentence, more(failures.len())));
    let group = || {
        check.groups.first().map(|group| format!("golden values {}: {}", group.change.name(), summary(group)))
    };
    // That golden values are missing stands in the headline.
    first.or_else(|| check.told_inputs()).or_else(group)
}

fn headline(check: &StudyCheck) -> String {
    let [unmet, failed, unsound] = failures_of(check).map(|failures| failures.len());
    let expectations = match check.judgements.len() {
        0 if check.expected > 0 => {
            format!("none of {} judged", count_of(check.expected, "expectation", "expectations"))
        }
        0 => "no expectations".to_owned(),
        // Those of cases that were not run count as well.
        judged => {
            let met = judged - unmet;
            match check.unjudged {
                0 => format!("{met} of {judged} expectations met"),
                left => format!("{met} of {} expectations met, {left} not judged", judged + left),
            }
        }
    };
    let golden = match &check.golden {
        _ if check.end() == CheckEnd::HeldBack => {
            let cases = count_of(check.held_back, "case", "cases");
            return format!("{expectations}: {cases} not run, because their programs need --allow-solvers");
        }
        Ok(_) if !check.compares_golden => ", no golden values, as the study says".to_owned(),
        Ok(differences) if differences.is_empty() => format!(", {} golden values agree", check.agreeing),
        Ok(differences) => format!(", {} golden values agree, {} do not", check.agreeing, differences.len()),
        // What fails comes first; values that are wrong are not worth accepting.
        Err(error) if error.is_missing() && unmet + failed + unsound > 0 => String::new(),
        Err(GoldenError::Missing(path)) => {
            format!(", no golden values yet ({}): accept these if they look right", path.display())
        }
        Err(error) => format!(", {error}"),
    };
    let count = |count: usize, one: &str, several: &str| match count {
        0 => String::new(),
        count => format!(", {}", count_of(count, one, several)),
    };
    let failed = count(failed, "case failed", "cases failed");
    let unsound = count(unsound, "record fails its checks", "records fail their checks");
    format!("{expectations}{failed}{unsound}{golden}")
}

fn tables_of(check: &StudyCheck) -> Vec<Table> {
    let mut tables: Vec<Table> = Vec::new();
    for (title, failures) in TITLES.into_iter().zip(failures_of(check)).filter(|(_, all)| !all.is_empty()) {
        let rows =
            failures.into_iter().map(|one| vec![Cell::Code(one.subject.to_owned()), one.sentence.into()]);
        tables.push(Table::of(title, columns("subject | how"), rows));
    }
    tables.extend(uncertainty::table_of(&check.judgements));
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

/// Columns of a terminal.
const WIDTH: usize = 80;
/// Items of a list before the rest is only counted.
const MOST: usize = 10;

/// A text in lines that fit a terminal; a longer word stays whole.
fn wrapped(text: &str, first: &str, others: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut line = first.to_owned();
    let mut is_empty = true;
    for word in text.split_whitespace() {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(std::mem::replace(&mut line, others.to_owned()));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.extend(word.chars().filter(|c| !c.is_control()));
        is_empty = false;
    }
    lines.push(line);
    lines.join("\n") + "\n"
}

/// A subject, and the words on it below.
fn item(subject: &str, words: &str) -> String {
    wrapped(subject, "  ", "    ") + &wrapped(words, "    ", "    ")
}

/// A list under its title; empty without items.
fn section(title: &str, items: Vec<String>) -> String {
    if items.is_empty() {
        return String::new();
    }
    let rest = items.len().saturating_sub(MOST);
    let mut text = format!("\n{title}\n");
    text.extend(items.into_iter().take(MOST));
    if rest > 0 {
        let _ = writeln!(text, "  and {rest} more");
    }
    text
}

/// A table that is wider than a terminal as a list: the first cell of a row, and below it the others with their headings.
fn items_of(table: &Table) -> String {
    let mut text = format!("\n{}\n", table.title);
    for row in &table.rows {
        let Some((subject, others)) = row.split_first() else { continue };
        let others = table.columns.iter().skip(1).zip(others).map(|(column, cell)| match cell {
            Cell::Missing(why) => format!("no {}: {why}", column.heading()),
            cell => format!("{} {}", column.heading(), cell.show()),
        });
        text += &item(&subject.show(), &others.collect::<Vec<_>>().join("; "));
    }
    for note in &table.notes {
        text += &wrapped(&format!("({note})"), "  ", "  ");
    }
    text
}

/// Unmet expectations, failed cases and records that break a balance or a bound.
fn text_of_failures(check: &StudyCheck) -> String {
    let sections = TITLES.iter().zip(failures_of(check)).map(|(title, failures)| {
        let items = failures.iter().map(|one| item(&format!("✗ {}", one.subject), &one.sentence)).collect();
        section(title, items)
    });
    sections.collect()
}

/// That inputs are not those of the golden values.
fn text_of_inputs(check: &StudyCheck) -> String {
    check.told_inputs().map_or(String::new(), |told| wrapped(&told, "  ", "    "))
}

/// Expectations to paste into the file of a study; the report has those that are only counted.
fn text_of_proposals(check: &StudyCheck, file: Option<&str>) -> Result<String, RenderError> {
    if check.proposals.is_empty() {
        return Ok(String::new());
    }
    let mut text = format!("\n{}\n", wrapped(&sentence::sentence("proposed", &())?, "", ""));
    text += &check.proposals.iter().take(MOST).map(String::as_str).collect::<Vec<_>>().join("\n");
    let rest = check.proposals.len().saturating_sub(MOST);
    if rest > 0 {
        let whole = file
            .map_or(String::new(), |file| format!(": `oedometer check {file} --format markdown` has all"));
        let _ = writeln!(text, "\nand {rest} more{whole}");
    }
    Ok(text)
}

/// Golden values that differ: kinds, the worst values, and cases.
fn text_of_changes(check: &StudyCheck) -> String {
    if check.groups.is_empty() {
        return String::new();
    }
    let groups: String = check.groups.iter().map(|group| wrapped(&summary(group), "  ", "    ")).collect();
    let (differences, cases) = worth_naming(check.differences(), &check.changes);
    [
        format!("\ngolden values that differ\n{groups}"),
        section("the worst of them", differences.into_iter().map(difference).collect()),
        section("accuracy and cost together", cases.into_iter().map(case_change).collect()),
    ]
    .concat()
}

/// Values and cases that are named one by one. Many values without a partner come from an input that changed, which
/// their kind has told already: then only what moved is named.
fn worth_naming<'a>(
    differences: &'a [Difference],
    cases: &'a [CaseChange],
) -> (Vec<&'a Difference>, Vec<&'a CaseChange>) {
    let has_partner = |one: &&Difference| one.golden.is_some() && one.found.is_some();
    if differences.len() <= MOST + differences.iter().filter(has_partner).count() {
        return (differences.iter().collect(), cases.iter().collect());
    }
    let moved = cases.iter().filter(|case| case.worse + case.better > 0).collect();
    (differences.iter().filter(has_partner).collect(), moved)
}

fn difference(one: &Difference) -> String {
    let change = match one.growth() {
        Some(times) => Some(format!("{} times as large", number::number(times))),
        None => one.relative_change().map(|change| format!("a relative change of {}", number::error(change))),
    };
    let how = match (one.golden, one.found, change) {
        (Some(golden), Some(found), Some(change)) => format!(
            "{} was {}, {change}, {} times its tolerance",
            number::exact(found),
            number::exact(golden),
            number::number((found - golden).abs() / one.tolerance)
        ),
        (Some(golden), None, _) => format!("was {}", number::exact(golden)),
        (_, found, _) => found.map_or(String::new(), number::exact),
    };
    item(&one.key.to_string(), &format!("{}: {how}", one.change.name()))
}

fn case_change(one: &CaseChange) -> String {
    let (mood, word) = judgement_of(one);
    let counts = format!(
        "{word}: {} times the golden cost, {}, {} fell, {} on one side only",
        number::number(one.cost_ratio),
        count_of(one.worse, "error rose", "errors rose"),
        one.better,
        one.unpaired
    );
    item(&format!("{} {}", mood.mark(), one.case), &counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::compare::Change;
    use crate::golden::measure::key;
    use crate::judge::study_check::CaseNote;
    use crate::render::table::columns;
    use crate::report::checks::tests::{check, group};
    use oedometer_convergence::ParetoChange;

    #[test]
    fn values_of_an_input_that_changed_are_told_by_their_kind_and_hide_nothing_that_moved() {
        let difference = |golden: Option<f64>, found: Option<f64>| Difference {
            key: key("MPM", 0.1, "pressure points terzaghi"),
            change: if golden.is_some() && found.is_some() { Change::Moved } else { Change::Missing },
            golden,
            found,
            tolerance: 1e-9,
        };
        let case = |worse: usize| CaseChange {
            case: "MPM".to_owned(),
            change: ParetoChange::NotComparable,
            cost_ratio: 1.0,
            worse,
            better: 0,
            unpaired: 1,
        };
        let named = |missing: usize| {
            let mut differences = vec![difference(Some(1.0), None); missing];
            differences.insert(missing / 2, difference(Some(1.0), Some(2.0)));
            let cases = [case(0), case(1)];
            let (values, cases) = worth_naming(&differences, &cases);
            assert!(values.contains(&&differences[missing / 2]), "what moved is always named");
            (values.len(), cases.len())
        };
        assert_eq!(named(MOST), (MOST + 1, 2));
        assert_eq!(named(MOST + 1), (1, 1));
    }

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let items = |count: usize| (0..count).map(|number| format!("  {number}\n")).collect::<Vec<_>>();
        assert_eq!(section("title", items(0)), "");
        assert!(section("title", items(MOST)).ends_with("  9\n"));
        assert!(section("title", items(MOST + 3)).ends_with("  9\n  and 3 more\n"));
    }

    #[test]
    fn lines_fit_a_terminal_and_lose_no_word() {
        let text = "order 1.01 outside 1.90 … 2.10, ".repeat(20);
        let lines = wrapped(&text, "  ", "    ");
        assert!(lines.lines().count() > 5 && lines.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(lines.starts_with("  order") && lines.lines().skip(1).all(|line| line.starts_with("    ")));
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&lines), words(&text));
        let long = "x".repeat(100);
        assert_eq!(wrapped(&long, "", "  "), format!("{long}\n"), "a name stays whole");
        assert_eq!(wrapped("a\u{1b}[31m", "", ""), "a[31m\n", "nothing steers the terminal");
    }

    #[test]
    fn a_wide_table_becomes_items_that_lose_nothing() {
        let rows = [vec!["a value".into(), Cell::Count(5), Cell::missing("fewer than four levels")]];
        let table =
            Table::of("values", columns("value | > levels | > least squares"), rows).note("of a study");
        let text = items_of(&table);
        for part in
            ["values", "a value", "levels 5", "no least squares: fewer than four levels", "(of a study)"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
    }

    #[test]
    fn a_value_that_moved_is_told_by_how_many_tolerances() {
        let moved = Difference {
            key: key("MPM", 0.1, "pressure points terzaghi"),
            change: Change::Moved,
            golden: Some(0.5),
            found: Some(0.75),
            tolerance: 0.0625,
        };
        let of = |golden: Option<f64>, found: Option<f64>, change: Change| {
            difference(&Difference { change, golden, found, ..moved.clone() }).replace("\n    ", " ")
        };
        let name = "  MPM | pressure points terzaghi T_v=0.1";
        let start = format!("{name} moved: ");
        let told = of(Some(0.5), Some(0.75), Change::Moved);
        assert_eq!(
            told,
            format!("{start}0.75 was 0.5, a relative change of 3.33e-1, 4 times its tolerance\n")
        );
        let told = of(Some(0.5), Some(1.25), Change::Moved);
        assert_eq!(told, format!("{start}1.25 was 0.5, 2.5 times as large, 12 times its tolerance\n"));
        assert_eq!(of(Some(0.5), None, Change::Missing), format!("{name} missing: was 0.5\n"));
        assert_eq!(of(None, Some(0.5), Change::Extra), format!("{name} not in the golden: 0.5\n"));
    }

    #[test]
    fn ten_proposals_are_shown_and_the_file_leads_to_the_others() {
        let told = |count: usize, file: Option<&str>| {
            let proposals = (0..count).map(|number| format!("line {number}")).collect();
            text_of_proposals(&StudyCheck { proposals, ..check(0) }, file).expect("filled")
        };
        assert_eq!(told(0, Some("s.toml")), "");
        assert!(told(10, Some("s.toml")).ends_with("line 8\nline 9"));
        assert!(told(12, None).ends_with("line 9\nand 2 more\n"));
        let whole = "line 9\nand 2 more: `oedometer check s.toml --format markdown` has all\n";
        assert!(told(12, Some("s.toml")).ends_with(whole));
    }

    #[test]
    fn golden_values_pass_in_the_table_for_programs_only_where_nothing_is_to_be_accepted() {
        let differing = |change: Change| {
            let group = group(change);
            StudyCheck { golden: Ok(vec![group.worst.clone()]), groups: vec![group], ..check(0) }
        };
        let accept = "oedometer accept s.toml --reason \"why the new values are right\"";
        let missing = GoldenError::Missing("study.csv".into());
        let note = CaseNote { case: "case".to_owned(), sentence: "water is lost".to_owned() };
        for (check, word, reason, next) in [
            (check(0), "pass", "0 golden values agree", None),
            (
                StudyCheck { other_inputs: vec!["MPM".to_owned()], ..check(0) },
                "fail",
                "agree. 1 case is of other inputs than its golden values, like `MPM`",
                Some(accept),
            ),
            (
                StudyCheck { golden: Err(missing), ..check(0) },
                "fail",
                "no golden values yet (study.csv): accept these if they look right",
                Some(accept),
            ),
            (differing(Change::Stale), "fail", "1 do not", Some(accept)),
            (differing(Change::Extra), "fail", "1 do not", Some(accept)),
            (
                differing(Change::Moved),
                "fail",
                "1 do not",
                Some("oedometer explain \"MPM | pressure points terzaghi T_v=0.1\" s.toml"),
            ),
            (check(2), "pass", "2 cases failed", Some("oedometer explain \"case 0\" s.toml")),
            (
                StudyCheck { unsound: vec![note], ..check(0) },
                "pass",
                "1 record fails its checks",
                Some("oedometer explain \"case\" s.toml"),
            ),
        ] {
            assert_eq!(next_command(&check, Some("s.toml")).as_deref(), next, "{check:?}");
            let failures: usize = failures_of(&check).iter().map(Vec::len).sum();
            assert_eq!(word == "pass" && failures == 0, check.end() == CheckEnd::Pass, "{check:?}");
            let csv = all_judgements(&[check]).to_csv().expect("a table");
            let row = csv.lines().last().expect("a row of golden values");
            assert!(row.starts_with(&format!("study,{word},golden values,,")), "{csv}");
            assert!(row.contains(reason), "{csv}");
        }
    }
}
