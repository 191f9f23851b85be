//! The first screen: what each method converges to and how fast, in one table.

use super::{StudyResults, labels};
use crate::assess::orders::WINDOW;
use crate::assess::summary::{Path, first_norm, paths};
use crate::record::{Quantity, Sample};
use crate::render::page::{Block, Section};
use crate::render::table::{Cell, Column, Mood, Table};
use crate::study::{Axis, Measure};

/// Cells at which an error is quoted.
const QUOTED_CELLS: usize = 10;

/// What a reader should know first.
pub fn lead(results: &[StudyResults<'_>]) -> String {
    let judged: usize = results.iter().map(|one| one.judgements.len()).sum();
    let met = results.iter().flat_map(|one| &one.judgements).filter(|judgement| judgement.verdict.pass).count();
    let runs: usize = results.iter().map(|one| one.records.len()).sum();
    format!(
        "{} studies, {runs} runs, {met} of {judged} expectations met. Every error is held against an exact solution \
         whose own truncation is bounded, and names its norm, its place and its time; no order is quoted before the \
         series has been given a class.",
        results.len()
    )
}

/// One row a method and measure: class, order, error on ten cells, and the floor where there is
/// one.
pub fn section(results: &[StudyResults<'_>]) -> Section {
    let columns = vec![
        Column::text("study"),
        Column::text("method"),
        Column::text("error of"),
        Column::text("against"),
        Column::number("order, finest 3"),
        Column::number("error on 10 cells"),
        Column::text("class"),
    ];
    let mut rows = Vec::new();
    let mut floors = Vec::new();
    for one in results {
        for path in paths(one.records, Axis::Cells).iter().filter(|path| path.records.len() >= WINDOW) {
            let times = &path.records[0].case.time_factors;
            let Some(time_factor) = times.get((times.len() - 1) / 2) else { continue };
            for (index, reference) in one.study.references.iter().enumerate() {
                for (quantity, sample) in quoted(index) {
                    let measure = Measure {
                        quantity,
                        sample,
                        norm: first_norm(quantity),
                        reference: reference.name().to_owned(),
                        time_factor: *time_factor,
                    };
                    rows.push(row(one, path, &measure, &mut floors));
                }
            }
        }
    }
    let table = Table {
        title: "What converges to what".to_owned(),
        columns,
        rows,
        notes: vec!["the middle output time of each study; relative L_2 norm over the volume".to_owned()],
    };
    let unmet = results.iter().flat_map(|one| &one.judgements).filter(|judgement| !judgement.verdict.pass).count();
    let mut blocks = Vec::new();
    if unmet > 0 {
        blocks.push(Block::Callout(Mood::Fail, format!("{unmet} expectations are not met: see their studies.")));
    }
    blocks.push(Block::Table(table));
    if !floors.is_empty() {
        blocks.push(Block::List(floors));
    }
    Section {
        heading: "Findings".to_owned(),
        id: "findings".to_owned(),
        mood: Some(if unmet == 0 { Mood::Pass } else { Mood::Fail }),
        blocks,
    }
}

/// What is quoted against the scene's own reference, and against others.
fn quoted(reference: usize) -> Vec<(Quantity, Sample)> {
    let all = [
        (Quantity::Pressure, Sample::Points),
        (Quantity::Pressure, Sample::Centres),
        (Quantity::EffectiveStress, Sample::Points),
        (Quantity::Settlement, Sample::Surface),
    ];
    all[..if reference == 0 { all.len() } else { 1 }].to_vec()
}

fn row(results: &StudyResults<'_>, path: &Path<'_>, measure: &Measure, floors: &mut Vec<String>) -> Vec<Cell> {
    let summary = path.summary(measure);
    if let Some(floor) = &summary.classification.floor {
        floors.push(format!(
            "**{}**, {} against `{}`: {}. {}",
            path.label(),
            labels::measure(measure),
            measure.reference,
            summary.classification.reason,
            summary.classification.advice.clone().unwrap_or_else(|| format!("The floor is {:.2e}.", floor.value)),
        ));
    }
    let on_ten = path.records.iter().position(|record| record.case.cells == QUOTED_CELLS);
    let error = on_ten.and_then(|index| summary.series.levels().get(index)?.error);
    vec![
        results.study.name.as_str().into(),
        Cell::Code(path.label()),
        labels::measure(measure).as_str().into(),
        measure.reference.as_str().into(),
        summary.classification.order.map_or(Cell::Missing("the class allows no order".to_owned()), Cell::Order),
        error.map_or(Cell::Missing("not run on ten cells".to_owned()), Cell::Error),
        summary.classification.class.name().into(),
    ]
}
