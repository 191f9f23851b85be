//! What do more points per cell, or stiffer water, change? Errors along both end in that of the mesh, and have no order.

use crate::case::Quantity;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::series::{SeriesTable, name_of_level};
use crate::questions::series_figure::figure;
use crate::render::page::Block;
use crate::study::expectation::Axis;
use serde::Serialize;

/// What do more points per cell change?
pub static POINTS: Question = Question {
    id: "points-per-cell",
    heading: "What do more points per cell change?",
    template: include_str!("points.md"),
    places: &[Place::Terminal, Place::Study],
    ask: |studies| Ok(ask(studies, &POINTS, Axis::PointsPerCell)),
};

/// What does stiffer water change?
pub static WATER: Question = Question {
    id: "stiffness-of-water",
    heading: "What does stiffer water change?",
    template: include_str!("points.md"),
    places: &[Place::Terminal, Place::Study],
    ask: |studies| Ok(ask(studies, &WATER, Axis::WaterBulkModulus)),
};

/// Every number and name of the sentence.
#[derive(Serialize)]
struct Facts {
    /// Time factor.
    time_factor: f64,
    /// Reference.
    reference: String,
    /// Label of the first run.
    run: String,
    /// What its errors are of.
    quantity: Quantity,
    /// The first and the last level.
    levels: [String; 2],
    /// The errors there.
    errors: [f64; 2],
}

fn ask(studies: &[StudyResults<'_>], question: &'static Question, axis: Axis) -> Option<Finding> {
    let [one] = studies else { return None };
    let found = SeriesTable::new(one, axis)?;
    let first = &found.series[0];
    let ends = first.ends()?;
    let facts = Facts {
        time_factor: found.time_factor,
        reference: found.reference.to_owned(),
        run: first.label.clone(),
        quantity: first.measured.0,
        levels: ends.map(|(place, _)| name_of_level(found.levels[place].1, axis)),
        errors: ends.map(|(_, error)| error),
    };
    let drawn = figure(&found, first.measured).into_iter().collect();
    let finding = question.answer([one.study.name.as_str()], &facts);
    Some(finding.with(Block::Table(found.table(question.id))).with(Block::Figures(drawn)))
}
