//! The section of one study: what it asks, what was expected, figures, tables, checks.

use crate::exact::exact_error::ExactError;
use crate::render::checks::verdicts::judgements_table;
use crate::render::page::{Block, Section};
use crate::render::report::{
    StudyResults, critical_step_maps, error_over_time, error_over_work, plane_fields, refinement,
    theory_lines, worst_checks,
};
use crate::render::table::Mood;
use crate::render::tables::uncertainties;
use crate::study::expectation::Axis;

/// The section of a study.
pub fn of_study(results: &StudyResults<'_>) -> Result<Section, ExactError> {
    let study = results.study;
    let mut blocks = vec![Block::Paragraph(study.summary.clone())];
    if !results.judgements.is_empty() {
        let met = results.met();
        let mood = Mood::of(met == results.judgements.len());
        blocks.push(Block::Callout(
            mood,
            format!("{met} of {} expectations are met.", results.judgements.len()),
        ));
    }
    if let Some((case, sentence)) = results.unsound.first() {
        let count = results.unsound.len();
        let text = format!("{count} checks of its runs fail, the first of {case}: {sentence}.");
        blocks.push(Block::Callout(Mood::Fail, text));
    }
    blocks.extend(plane_fields::blocks(results)?);
    blocks.extend(theory_lines::blocks(results)?);
    for axis in Axis::REFINEMENTS {
        blocks.extend(refinement::blocks(results, axis));
    }
    blocks.extend(uncertainties::table_of(&results.judgements).map(Block::Table));
    let is_solved = results.records.iter().any(|record| record.stability.is_none());
    blocks.extend(critical_step_maps::blocks(results));
    if is_solved {
        blocks.extend(error_over_work::blocks(results));
        blocks.extend(error_over_time::blocks(results));
        blocks.push(worst_checks::block(results));
    }
    if !results.judgements.is_empty() {
        let all: Vec<_> = results.judgements.iter().collect();
        blocks.push(Block::Details {
            summary: "Every expectation, with the reason of its verdict".to_owned(),
            blocks: vec![Block::Table(judgements_table("Expectations", &all))],
        });
    }
    blocks.push(Block::Paragraph(format!("Run it again: `{}`.", results.run_command())));
    Ok(Section {
        heading: study.title.clone(),
        id: study.name.clone(),
        mood: Some(Mood::of(results.passes())),
        blocks,
    })
}
