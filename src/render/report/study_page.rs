//! The page of one study: what it asks, what was expected, figures, tables, checks.

use crate::judge::judgement::Judgement;
use crate::render::checks::verdicts::judgements_table;
use crate::render::page::{Block, Callout, Page, Section, slug};
use crate::render::report::figures::{
    cheapest_method_map, critical_step_maps, error_over_time, error_over_work, plane_fields, theory_lines,
};
use crate::render::report::{StudyResults, findings, other_measures, refinement, survival, worst_checks};
use crate::render::table::Mood;
use crate::render::tables::{attached_runs, uncertainties};
use crate::study::expectation::Axis;
use oedometer_exact::exact_error::ExactError;
use std::fmt::Write;

/// Reasons that the red box names before the rest is only counted.
const MOST_REASONS: usize = 5;

/// The page of a study.
///
/// # Errors
/// When a reference refuses a case.
pub fn study_page(results: &StudyResults<'_>) -> Result<Page, ExactError> {
    let study = results.study;
    let mut blocks = expectations(results);
    blocks.extend(survival::block(results));
    blocks.extend(findings::blocks(results));
    blocks.extend(cheapest_method_map::blocks(results));
    blocks.extend(plane_fields::blocks(results)?);
    blocks.extend(theory_lines::blocks(results)?);
    for axis in Axis::REFINEMENTS {
        blocks.extend(refinement::blocks(results, axis));
    }
    blocks.extend(uncertainties::table_of(&results.judgements).map(Block::Table));
    let is_solved = results.records.iter().any(|record| record.stability.is_none());
    blocks.extend(other_measures::blocks(results));
    blocks.extend(critical_step_maps::blocks(results));
    if let Some(table) = attached_runs::table_of(results.records) {
        blocks.push(Block::Heading("Attached solvers".to_owned()));
        blocks.push(Block::Table(table));
    }
    if is_solved {
        blocks.extend(error_over_work::blocks(results));
        blocks.extend(error_over_time::blocks(results));
        blocks.push(worst_checks::block(results));
    }
    Ok(Page {
        title: study.title.clone(),
        lead: format!(
            "{}\n\n[All studies](index.html). Run it again: `{}`.",
            study.summary,
            results.run_command()
        ),
        callout: Some(verdict(results)),
        sections: sections(blocks),
        files: Some(slug(&study.name)),
        ..Page::default()
    })
}

/// Whether everything is as expected; where not, why, in the box itself.
fn verdict(results: &StudyResults<'_>) -> Callout {
    let judged = results.judgements.len();
    let mut text = match judged {
        0 => "The study expects nothing.".to_owned(),
        _ => format!("{} of {judged} expectations are met.", results.met()),
    };
    if let Some((case, sentence)) = results.unsound.first() {
        let _ = write!(
            text,
            " {} checks of its runs fail, the first of {case}: {sentence}.",
            results.unsound.len()
        );
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

/// What is not met openly, and every expectation behind a click.
fn expectations(results: &StudyResults<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
    let failing = failing(results);
    if !failing.is_empty() {
        blocks.push(Block::Table(judgements_table("Expectations that are not met", &failing)));
    }
    if !results.judgements.is_empty() {
        let all: Vec<_> = results.judgements.iter().collect();
        blocks.push(Block::Details {
            summary: "Every expectation, with the reason of its verdict".to_owned(),
            blocks: vec![Block::Table(judgements_table("Expectations", &all))],
        });
    }
    blocks
}

/// A section from every heading on; what stands before the first is of the expectations.
fn sections(blocks: Vec<Block>) -> Vec<Section> {
    let mut sections = vec![Section {
        heading: "Expectations".to_owned(),
        id: "expectations".to_owned(),
        ..Section::default()
    }];
    for block in blocks {
        match (block, sections.last_mut()) {
            (Block::Heading(heading), _) => {
                let id = format!("{}-{}", slug(&heading), sections.len());
                sections.push(Section { heading, id, ..Section::default() });
            }
            (block, Some(last)) => last.blocks.push(block),
            (_, None) => {}
        }
    }
    sections.retain(|section| !section.blocks.is_empty());
    sections
}
