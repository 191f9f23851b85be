//! The page of one study: its question, expectations, figures, tables and checks.

use crate::judge::proposals::proposals;
use crate::judge::study_check::diagnoses;
use crate::judge::verdict::Judgement;
use crate::render::checks::verdicts::{PROPOSED, judgements_table};
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::report::{
    StudyResults, checks, cost, layer, maps, race, refinement, setting, survival, theory_lines,
};
use crate::render::table::Mood;
use crate::render::tables::{runs, uncertainties};
use crate::study::expectation::Axis;
use oedometer_exact::exact_error::ExactError;
use std::fmt::Write;

/// Reasons in the red box before the rest is only counted.
const MOST_REASONS: usize = 5;

/// Proposed expectations that stand open on the page.
const MOST_OPEN: usize = 4;

/// The page of a study.
///
/// # Errors
/// When a reference refuses a case.
pub fn study_page(results: &StudyResults<'_>) -> Result<Page, ExactError> {
    let study = results.study;
    let mut blocks = expectations(results);
    if study.is_race {
        blocks.extend(race::blocks(results));
    } else {
        blocks.extend(survival::survival(results).map(Block::Table));
        blocks.extend(maps::cheapest_methods(results));
        blocks.extend(layer::load_settlement(results));
        blocks.extend(layer::blocks(results)?);
        blocks.extend(theory_lines::blocks(results)?);
        for axis in Axis::REFINEMENTS {
            blocks.extend(refinement::blocks(results, axis));
        }
    }
    blocks.extend(uncertainties::table_of(&results.judgements).map(Block::Table));
    blocks.extend(checks::measures(results));
    blocks.extend(maps::critical_steps(results));
    if let Some(table) = runs::attached_table(results.records) {
        blocks.push(Block::Heading("Attached solvers".to_owned()));
        blocks.push(Block::Table(table.notes(diagnoses(study, results.records))));
    }
    if results.records.iter().any(|record| record.stability.is_none()) {
        blocks.extend(cost::work_blocks(results));
        blocks.extend(cost::wall_time_blocks(results));
        blocks.push(checks::worst_checks(results));
    }
    Ok(Page {
        title: study.title.clone(),
        lead: format!(
            "{}\n\n{}[All studies](index.html). Run it again: `{}`.",
            study.summary,
            setting::sentence(results.records).map_or(String::new(), |sentence| sentence + "\n\n"),
            results.run_command()
        ),
        callout: Some(verdict(results)),
        sections: sections(blocks),
        files: Some(slug(&study.name)),
        ..Page::default()
    })
}

/// Whether everything is as expected, and the reasons if not.
fn verdict(results: &StudyResults<'_>) -> Callout {
    let judged = results.judgements.len();
    let mut text = match judged {
        0 => "The study has no expectations.".to_owned(),
        _ => format!("{} of {judged} expectations are met.", results.met()),
    };
    if let Some((case, sentence)) = results.unsound.first() {
        let _ = write!(text, " {} checks of its runs fail, first {case}: {sentence}.", results.unsound.len());
    }
    let failing = failing(results);
    for judgement in failing.iter().take(MOST_REASONS) {
        let _ = write!(text, "\n\n`{}`: {}", judgement.subject, judgement.verdict.reason);
    }
    if failing.len() > MOST_REASONS {
        let _ = write!(text, "\n\nAnd {} more, below.", failing.len() - MOST_REASONS);
    }
    let mood = if judged == 0 && results.passes() { Mood::Note } else { Mood::of(results.passes()) };
    (mood, text)
}

fn failing<'b>(results: &'b StudyResults<'_>) -> Vec<&'b Judgement> {
    results.judgements.iter().filter(|judgement| !judgement.verdict.pass).collect()
}

/// The unmet expectations, and every expectation behind a click.
fn expectations(results: &StudyResults<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
    let failing = failing(results);
    if !failing.is_empty() {
        blocks.push(Block::Table(judgements_table("Expectations that are not met", &failing)));
    }
    let proposed = proposals(results.study, &results.paths);
    if !proposed.is_empty() {
        blocks.push(Block::Paragraph(PROPOSED.to_owned()));
        let whole = Block::Code(proposed.join("\n"));
        blocks.push(if proposed.len() > MOST_OPEN {
            Block::Details { summary: format!("The {} expectations", proposed.len()), blocks: vec![whole] }
        } else {
            whole
        });
    }
    if !results.judgements.is_empty() {
        let all: Vec<_> = results.judgements.iter().collect();
        blocks.push(Block::Details {
            summary: "Every expectation, with the reason for its verdict".to_owned(),
            blocks: vec![Block::Table(judgements_table("Expectations", &all))],
        });
    }
    blocks
}

/// A section from every heading on; the blocks before the first are about the expectations.
fn sections(blocks: Vec<Block>) -> Vec<Section> {
    let mut sections = vec![Section::new("Expectations", "expectations", Vec::new())];
    for block in blocks {
        if let Block::Heading(heading) = block {
            let id = format!("{}-{}", slug(&heading), sections.len());
            sections.push(Section::new(heading, id, Vec::new()));
        } else if let Some(last) = sections.last_mut() {
            last.blocks.push(block);
        }
    }
    sections.retain(|section| !section.blocks.is_empty());
    sections
}
