//! The expectations of a study on its page: the verdict in its box, those that are not met, and all with their reasons.

use crate::judge::verdict::Judgement;
use crate::questions::study_findings::StudyFindings;
use crate::render::page::{Block, Callout};
use crate::render::table::Mood;
use crate::report::check_page::judgements_table;
use oedometer_soil::wording::count_of;
use std::fmt::Write;

/// Reasons in the red box before the rest is only counted.
const MOST_REASONS: usize = 5;

/// Whether everything is as expected, and the reasons if not.
pub fn verdict(study: &StudyFindings) -> Callout {
    let judged = study.judgements.len();
    let mut text = String::new();
    for sentence in &study.diagnoses {
        let _ = write!(text, "Diagnosis: {sentence}\n\n");
    }
    let _ = match judged {
        0 => write!(text, "The study has no expectations."),
        _ => write!(text, "{} of {judged} expectations are met.", study.met),
    };
    if let Some((case, sentence)) = study.unsound.first() {
        let fail = count_of(study.unsound.len(), "check of its runs fails", "checks of its runs fail");
        let _ = write!(text, " {fail}, first {case}: {sentence}.");
    }
    let failing = failing(study);
    for judgement in failing.iter().take(MOST_REASONS) {
        let _ = write!(text, "\n\n`{}`: {}", judgement.subject, judgement.verdict.reason);
    }
    if failing.len() > MOST_REASONS {
        let _ = write!(text, "\n\nAnd {} more, below.", failing.len() - MOST_REASONS);
    }
    let mood = if judged == 0 && study.passes { Mood::Note } else { Mood::of(study.passes) };
    (mood, text)
}

fn failing(study: &StudyFindings) -> Vec<&Judgement> {
    study.judgements.iter().filter(|judgement| !judgement.verdict.pass).collect()
}

/// The expectations that are not met, under a heading; nothing where all are.
pub fn unmet(study: &StudyFindings) -> Vec<Block> {
    let failing = failing(study);
    if failing.is_empty() {
        return Vec::new();
    }
    let table = judgements_table("Expectations that are not met", &failing);
    vec![Block::Heading("Not as expected".to_owned()), Block::Table(table)]
}

/// Every expectation of the study behind a click.
pub fn all(study: &StudyFindings) -> Vec<Block> {
    let all: Vec<_> = study.judgements.iter().collect();
    let each = (!all.is_empty()).then(|| Block::Details {
        summary: "Every expectation, with the reason for its verdict".to_owned(),
        blocks: vec![Block::Table(judgements_table("Expectations", &all))],
    });
    std::iter::once(Block::Heading("Expectations".to_owned())).chain(each).collect()
}
