//! `check` as blocks: the verdict first, each failure once, what changed, what the study answers, and the command that goes on
//! from there; as text for a terminal, and as Markdown.

use crate::campaign::taken_over::TakenOver;
use crate::golden::GoldenError;
use crate::golden::compare::Change;
use crate::judge::proposals::{ROOM_OF_ERROR, ROOM_OF_ORDER};
use crate::judge::study_check::{CheckEnd, Objection, StudyCheck};
use crate::judge::verdict::{Judgement, VerdictOutcome};
use crate::questions::finding::{Finding, Place};
use crate::questions::sentence::filled;
use crate::render::RenderError;
use crate::render::marked_text::wrapped;
use crate::render::page::{self, Block};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::report::sections;
use crate::report::tables::golden_changes::sentence;
use oedometer_wording::{count_of, first_few};
use std::fmt::Write as _;

/// How a terminal shows a check.
#[derive(Clone, Copy, Debug)]
pub struct Terminal {
    /// Letters of a line.
    pub width: usize,
    /// Whether all is shown, or what fits a screen.
    pub is_whole: bool,
}

/// Lines of a check without failures.
const LINES: usize = 25;
/// Rows of a table.
const ROWS: usize = 12;
/// Points of a list before the rest is only counted.
const MOST: usize = 10;

/// A study's check as text: the verdict, what failed, what the study answers. `file` is the study's own.
///
/// # Errors
/// If a table or a sentence cannot be written.
pub fn text_of(
    check: &StudyCheck,
    file: Option<&str>,
    answers: &[Finding],
    terminal: Terminal,
) -> Result<String, RenderError> {
    let Terminal { width, is_whole } = terminal;
    let text = |blocks: &[Block]| page::text_of(blocks, width, is_whole);
    let (before, after) = (text(&before(check, is_whole))?, text(&after(check, file))?);
    let mut whole = verdict_on(check, width);
    let mut add = |part: &str| {
        if !part.is_empty() {
            whole.extend(["\n", part]);
        }
    };
    add(&before);
    let room = LINES.saturating_sub(3 + before.lines().count() + after.lines().count());
    let (answers, mut more) = answers_within(answers, room, terminal)?;
    add(&answers);
    more.extend(proposed(check).map(|(summary, _)| summary));
    if !more.is_empty() && !is_whole {
        add(&wrapped(&format!("--verbose adds: {}", more.join("; ")), "", "  ", width));
    }
    add(&after);
    Ok(whole)
}

/// The answers of a study as text.
///
/// # Errors
/// If a table or a sentence cannot be written.
pub fn text_of_answers(answers: &[Finding], terminal: Terminal) -> Result<String, RenderError> {
    Ok(answers_within(answers, LINES, terminal)?.0)
}

/// The answers that have room in so many lines, the first in any case, and the headings of the others.
fn answers_within(
    answers: &[Finding],
    room: usize,
    terminal: Terminal,
) -> Result<(String, Vec<String>), RenderError> {
    let Terminal { width, is_whole } = terminal;
    let (mut text, mut others) = (String::new(), Vec::new());
    for finding in answers {
        let shown = page::text_of(&answer(finding, is_whole)?, width, is_whole)?;
        let lines = text.lines().count() + 1 + shown.lines().count();
        if is_whole || text.is_empty() || lines <= room {
            text.extend([if text.is_empty() { "" } else { "\n" }, &shown]);
        } else {
            others.push(finding.question.heading.to_owned());
        }
    }
    Ok((text, others))
}

/// An answer on a terminal: its tables, or its sentence where it has none.
fn answer(finding: &Finding, is_whole: bool) -> Result<Vec<Block>, RenderError> {
    if is_whole {
        return sections::blocks(finding, Place::Terminal);
    }
    let table = |block: &Block| match block {
        Block::Table(table) => Some(Block::Table(table.clone().shown(ROWS))),
        _ => None,
    };
    let tables: Vec<Block> = finding.parts.iter().filter_map(table).collect();
    Ok(if tables.is_empty() { vec![Block::Paragraph(finding.sentence()?)] } else { tables })
}

/// The verdict on a study in one line: as expected, not as expected, or not compared with golden values.
pub fn verdict_on(check: &StudyCheck, width: usize) -> String {
    wrapped(&verdict(check), "", "  ", width)
}

fn verdict(check: &StudyCheck) -> String {
    format!("{} {}: {}", mood_of(check).mark(), check.study, headline(check))
}

fn mood_of(check: &StudyCheck) -> Mood {
    match check.end() {
        CheckEnd::Pass => Mood::Pass,
        CheckEnd::Golden if check.groups.is_empty() && check.other_inputs.is_empty() => Mood::Note,
        CheckEnd::HeldBack => Mood::Note,
        _ => Mood::Fail,
    }
}

/// Points of a list, the rest counted unless the whole is wanted.
fn list(points: Vec<String>, is_whole: bool) -> Option<Block> {
    let points = if is_whole { points } else { first_few(points, MOST) };
    (!points.is_empty()).then_some(Block::List(points))
}

/// What stands between the verdict and the answers: what seems to be wrong, what failed, what changed.
fn before(check: &StudyCheck, is_whole: bool) -> Vec<Block> {
    let diagnoses = check.diagnoses.iter().map(|sentence| format!("diagnosis: {sentence}")).collect();
    let failed = check.objections().iter().map(objection).collect();
    let inputs: Vec<String> = check.sentence_on_inputs().into_iter().collect();
    let groups = check.groups.iter().map(|group| format!("golden values: {}", sentence(group))).collect();
    let lists = [
        list(diagnoses, is_whole),
        list(TakenOver::sentences(&check.taken_over), is_whole),
        list(failed, is_whole),
        list(inputs, is_whole),
        list(groups, is_whole),
    ];
    lists.into_iter().flatten().collect()
}

/// A failure in one sentence: the line that asks for it, the first series or case, how many others, and why.
pub(crate) fn objection(one: &Objection<'_>) -> String {
    let line = one.line.map_or(String::new(), |line| format!("line {line}, "));
    let alike = if one.alike > 0 { format!(" and {} more", one.alike) } else { String::new() };
    format!("✗ {line}{}{alike}: {}", one.subject, one.reasons.join("; "))
}

/// Expectations that could be asked, with a summary, for a reader to open.
fn proposed(check: &StudyCheck) -> Option<(String, Vec<Block>)> {
    let count = Some(check.proposals.len()).filter(|count| *count > 0)?;
    let room = serde_json::json!({ "errors": ROOM_OF_ERROR, "orders": ROOM_OF_ORDER });
    let words = filled(include_str!("proposed.md"), &room).map(Block::Paragraph).into_iter();
    let blocks = words.chain([Block::Code(check.proposals.join("\n"))]).collect();
    Some((format!("{} that the results meet", count_of(count, "expectation", "expectations")), blocks))
}

/// What stands below the answers.
fn after(check: &StudyCheck, file: Option<&str>) -> Vec<Block> {
    let details = proposed(check).map(|(summary, blocks)| Block::Details { summary, blocks });
    let warnings = list(check.warnings.iter().map(|sentence| format!("warning: {sentence}")).collect(), true);
    let next = next_command(check, file).map(|command| Block::Paragraph(format!("next: `{command}`")));
    details.into_iter().chain(warnings).chain(next).collect()
}

/// The checks of several studies as Markdown, those that did not pass first: a forge cuts a long summary at its end. `file_of`
/// knows the file of a study.
///
/// # Errors
/// If a table cannot be written.
pub fn markdown_of(
    checks: &[StudyCheck],
    file_of: impl Fn(&str) -> Option<String>,
) -> Result<String, RenderError> {
    let mut text = "## oedometer check\n".to_owned();
    let (sound, unsound): (Vec<_>, Vec<_>) = checks.iter().partition(|check| check.end() == CheckEnd::Pass);
    for check in unsound.into_iter().chain(sound) {
        let mut blocks = vec![Block::Heading(verdict(check))];
        blocks.extend(before(check, true));
        blocks.extend(after(check, file_of(&check.study).as_deref()));
        let _ = write!(text, "\n{}", page::markdown_of(&blocks)?);
    }
    Ok(text)
}

/// Why the values of a study cannot be golden: unmet expectations, failed cases, records that break a balance or a bound. `None`
/// where there is no reason.
pub fn objections_of(check: &StudyCheck, width: usize) -> Option<String> {
    let lines = check
        .objections()
        .iter()
        .map(|one| wrapped(&objection(one), "  ", "    ", width))
        .collect::<String>();
    (!lines.is_empty()).then(|| format!("{}\n{lines}", check.study))
}

/// The command that explains the worst failure, if anything failed.
pub fn next_command(check: &StudyCheck, file: Option<&str>) -> Option<String> {
    let file = file?;
    let explain = |what: &str| Some(format!("oedometer explain \"{what}\" {file}"));
    // What cannot be read says itself what to do, and what was not run cannot be accepted.
    let is_unreadable = check.golden_problem.as_ref().is_some_and(|error| !error.is_missing());
    match (check.groups.first(), check.failed_cases.first().or(check.unsound.first())) {
        (Some(group), _) if group.change == Change::Moved => explain(&group.worst.key.to_string()),
        (_, Some(note)) => explain(&note.case),
        _ if check.unmet().next().is_some() => Some(format!("oedometer report {file}")),
        (None, _) if check.golden_problem.is_none() && check.other_inputs.is_empty() => None,
        _ if check.held_back > 0 || is_unreadable => None,
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
                Cell::Verdict(Mood::Note, "reused".to_owned()),
                one.case.as_str().into(),
                "".into(),
                Cell::Text(reason),
            ]);
        }
        let agrees =
            check.golden_problem.is_none() && check.differences.is_empty() && check.other_inputs.is_empty();
        let (mood, word) = match (agrees, check.end()) {
            (true, _) => (Mood::Pass, "pass"),
            (false, CheckEnd::HeldBack) => (Mood::Note, "not run"),
            (false, _) => (Mood::Fail, "fail"),
        };
        let reason: Vec<String> =
            std::iter::once(headline(check)).chain(check.sentence_on_inputs()).collect();
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

/// The verdict in words.
fn headline(check: &StudyCheck) -> String {
    let [failed, unsound] = [&check.failed_cases, &check.unsound].map(Vec::len);
    let expectations = match check.judgements.len() {
        0 if check.expected > 0 => {
            format!("none of {} judged", count_of(check.expected, "expectation", "expectations"))
        }
        0 => "no expectations".to_owned(),
        // Those of cases that were not run count as well.
        judged => {
            let met = check.met();
            match check.unjudged {
                0 => format!("{met} of {judged} expectations met"),
                left => format!("{met} of {} expectations met, {left} not judged", judged + left),
            }
        }
    };
    let golden = match &check.golden_problem {
        _ if check.end() == CheckEnd::HeldBack => {
            let cases = count_of(check.held_back, "case", "cases");
            return format!("{expectations}: {cases} not run, because their programs need --allow-solvers");
        }
        None if !check.compares_golden => ", no golden values, as the study says".to_owned(),
        None if check.differences.is_empty() => format!(", {} golden values agree", check.agreeing),
        None => format!(", {} golden values agree, {} do not", check.agreeing, check.differences.len()),
        // What fails comes first; values that are wrong are not worth accepting.
        Some(error) if error.is_missing() && check.met() < check.judgements.len() || failed + unsound > 0 => {
            String::new()
        }
        Some(GoldenError::Missing(path)) => format!(", no golden values yet ({})", path.display()),
        Some(error) => format!(", {error}"),
    };
    let count = |count: usize, one: &str, several: &str| match count {
        0 => String::new(),
        count => format!(", {}", count_of(count, one, several)),
    };
    let failed = count(failed, "case failed", "cases failed");
    let unsound = count(unsound, "record fails its checks", "records fail their checks");
    format!("{expectations}{failed}{unsound}{golden}")
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::study_check::CaseNote;
    use crate::render::table::columns;
    use crate::report::tests::{check, group};

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let points = |count: usize| (0..count).map(|number| number.to_string()).collect::<Vec<_>>();
        let last = |count: usize, is_whole: bool| match list(points(count), is_whole) {
            Some(Block::List(points)) => points.last().cloned(),
            _ => None,
        };
        assert_eq!(list(points(0), false), None);
        assert_eq!(last(MOST, false).as_deref(), Some("9"));
        assert_eq!(last(MOST + 3, false).as_deref(), Some("and 3 more"));
        assert_eq!(last(MOST + 3, true).as_deref(), Some("12"));
    }

    #[test]
    fn answers_fill_a_screen_and_the_others_are_named() {
        let table = |rows: usize| {
            Table::of("title", columns("a"), (0..rows).map(|row| vec![Cell::Count(row as u64)]))
        };
        let finding = |question: &'static crate::questions::finding::Question, rows: usize| {
            question.answer(["s"], &()).with(Block::Table(table(rows)))
        };
        let answers = [
            finding(&crate::questions::within::WITHIN, 30),
            finding(&crate::questions::convergence::CONVERGENCE, 20),
            finding(&crate::questions::time_step::TIME_STEP, 2),
        ];
        let terminal = Terminal { width: 80, is_whole: false };
        let (text, others) = answers_within(&answers, 22, terminal).expect("tables");
        // A title, heads, twelve rows and how many more; a blank; a title, heads and two rows.
        assert_eq!(
            (text.lines().count(), others),
            (15 + 1 + 4, vec![answers[1].question.heading.to_owned()])
        );
        assert!(text.contains("and 18 more rows\n"), "{text}");
        let (text, others) = answers_within(&answers, 5, terminal).expect("tables");
        assert_eq!((text.lines().count(), others.len()), (15, 2), "the first is shown in any case");
    }

    #[test]
    fn one_failure_is_told_once_with_the_number_of_those_that_fail_alike() {
        let found = crate::judge::verdict::Check::failed("order", "no order to compare with");
        let told = |reasons: &[&str]| {
            let one = Objection { line: Some(7), subject: "MPM", alike: 2, reasons: reasons.to_vec() };
            objection(&one)
        };
        assert_eq!(told(&[&found.reason, "b"]), "✗ line 7, MPM and 2 more: no order to compare with; b");
        let alone = Objection { line: None, subject: "MPM cells=4", alike: 0, reasons: vec!["a"] };
        assert_eq!(objection(&alone), "✗ MPM cells=4: a");
        // Cases that fail alike are one objection.
        let lines = objections_of(&check(3), 80).expect("three cases");
        assert_eq!(lines.lines().count(), 2, "{lines}");
    }

    #[test]
    fn golden_values_pass_in_the_table_for_programs_only_where_nothing_is_to_be_accepted() {
        let differing = |change: Change| {
            let group = group(change);
            StudyCheck { differences: vec![group.worst.clone()], groups: vec![group], ..check(0) }
        };
        let accept = "oedometer accept s.toml --reason \"why the new values are right\"";
        let missing = GoldenError::Missing("study.csv".into());
        let note = CaseNote { case: "case".to_owned(), sentence: "water is lost".to_owned() };
        for (check, word, reason, next) in [
            (check(0), "pass", "0 golden values agree", None),
            (
                StudyCheck { other_inputs: vec!["MPM".to_owned()], ..check(0) },
                "fail",
                "agree. 1 case has other inputs than its golden values, like `MPM`",
                Some(accept),
            ),
            (
                StudyCheck { golden_problem: Some(missing), ..check(0) },
                "fail",
                "no golden values yet (study.csv)",
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
            let failures = check.unmet().count() + check.failed_cases.len() + check.unsound.len();
            assert_eq!(word == "pass" && failures == 0, check.end() == CheckEnd::Pass, "{check:?}");
            let csv = all_judgements(&[check]).to_csv().expect("a table");
            let row = csv.lines().last().expect("a row of golden values");
            assert!(row.starts_with(&format!("study,{word},golden values,,")), "{csv}");
            assert!(row.contains(reason), "{csv}");
        }
    }
}
