//! The answer page: what a reader asks of the records of all studies, each question with a sentence,
//! a short table or a figure, and the study that carries it.
//!
//! Every sentence is made from records. A question whose studies are not among them says so.

pub mod audit;
pub mod changes;
pub mod choice;
pub mod converges;
pub mod cost;
pub mod making;
pub mod matrix;
pub mod one_layer_or_two;
pub mod paper;
pub mod question;
pub mod regime;

use crate::golden::compare::Difference;
use crate::judge::comparison::situation::Ended;
use crate::render::answers::making::Making;
use crate::render::answers::question::{Answer, Links};
use crate::render::page::{Block, Callout, Page, Section};
use crate::render::report::StudyResults;
use crate::render::table::Mood;
use crate::render::tables::golden_changes::count_of;
use oedometer_exact::exact_error::ExactError;
use std::fmt::Write;

/// What the answer page is made of.
pub struct Answers<'a> {
    /// The studies with their records and judgements.
    pub results: &'a [StudyResults<'a>],
    /// Differences from the golden values with the name of their study; none where there were no golden
    /// values to hold against.
    pub changes: Option<&'a [(String, Difference)]>,
    /// When, where and by which command.
    pub making: &'a Making,
    /// Where the page of a study is.
    pub links: Links<'a>,
    /// Where the list of all studies is.
    pub index: &'a str,
    /// How every method came out of every situation.
    pub ends: &'a [Ended<'a>],
    /// Where every study of every situation stands.
    pub situations: &'a str,
}

/// The answer page.
///
/// # Errors
/// When a reference refuses a case.
pub fn answer_page(answers: &Answers<'_>) -> Result<Page, ExactError> {
    let (results, links) = (answers.results, answers.links);
    let small = regime::small_strain(results);
    let large = regime::large_strain(results);
    let all = vec![
        choice::answer(results, small.as_ref(), large.as_ref(), links)?,
        converges::answer(results, small.as_ref(), large.as_ref(), links),
        paper::answer(results, links)?,
        cost::answer(results, links),
        matrix::answer(answers.ends, links, answers.situations),
        audit::answer(results, links),
        one_layer_or_two::answer(results, links),
        changes::answer(answers.changes),
    ];
    let mut sections = Vec::new();
    let mut open = Vec::new();
    for answer in all {
        match answer {
            Answer::Told(section) => sections.push(section),
            Answer::Open { question, needed } => open.push(format!("**{}** {needed}.", question.heading)),
        }
    }
    sections.extend(open_questions(open));
    Ok(Page {
        title: "Convergence report".to_owned(),
        lead: format!(
            "**{MADE}** {}\n\n[All studies, with every table and figure]({}){}",
            answers.making.words(results),
            answers.index,
            names_of_few(results, links)
        ),
        callout: Some(verdict(results)),
        sections,
        is_wide: true,
        ..Page::default()
    })
}

/// Studies up to which the head of the page names each.
const FEW_STUDIES: usize = 6;

/// The studies of a small report by name, as no question may lead to them.
fn names_of_few(results: &[StudyResults<'_>], links: &dyn Fn(&str) -> String) -> String {
    let link = |one: &StudyResults<'_>| format!("[`{}`]({})", one.study.name, links(&one.study.name));
    match results.len() {
        1..=FEW_STUDIES => format!(": {}", results.iter().map(link).collect::<Vec<_>>().join(", ")),
        _ => String::new(),
    }
}

/// The question that the first lines of the page answer.
const MADE: &str = "How was it made?";

/// What these records do not answer, and what would.
fn open_questions(open: Vec<String>) -> Option<Section> {
    let lead = "What the studies of this report do not have, and would answer:";
    (!open.is_empty()).then(|| Section {
        heading: "Not in these records".to_owned(),
        id: "open".to_owned(),
        mood: None,
        blocks: vec![Block::Paragraph(lead.to_owned()), Block::List(open)],
    })
}

/// Whether everything is as expected, in one sentence; what is not is named.
fn verdict(results: &[StudyResults<'_>]) -> Callout {
    let judged: usize = results.iter().map(|one| one.judgements.len()).sum();
    let met: usize = results.iter().map(StudyResults::met).sum();
    let runs: usize = results.iter().map(|one| one.records.len()).sum();
    let unsound: usize = results.iter().map(|one| one.unsound.len()).sum();
    let failing: Vec<&str> =
        results.iter().filter(|one| !one.passes()).map(|one| one.study.name.as_str()).collect();
    let mut text = format!(
        "**{met} of {judged} expectations met** in {} of {runs} runs.",
        count_of(results.len(), "study", "studies")
    );
    if unsound > 0 {
        let _ = write!(text, " {unsound} checks of runs fail.");
    }
    if !failing.is_empty() {
        let _ = write!(text, " Not as expected: `{}`.", failing.join("`, `"));
    }
    (Mood::of(failing.is_empty()), text)
}
