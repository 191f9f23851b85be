//! What each method of a study converges to and how fast, in one table.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::Path;
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::labels::first_measure;
use crate::render::report::{StudyResults, labels};
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::{Class, WINDOW};
use oedometer_soil::wording::typed;

/// Cells at which an error is quoted.
const QUOTED_CELLS: usize = 10;

/// Floors that are told before the rest is only counted.
const MOST_FLOORS: usize = 20;

/// What is quoted of every path.
const QUOTED: [(Quantity, Sample); 4] = [
    (Quantity::Pressure, Sample::Points),
    (Quantity::Pressure, Sample::Centres),
    (Quantity::EffectiveStress, Sample::Points),
    (Quantity::Settlement, Sample::Surface),
];

/// One row a path: order and error on ten cells of each measure, and the floors there are; nothing where
/// no mesh was refined.
pub fn blocks(one: &StudyResults<'_>) -> Vec<Block> {
    let mut columns = columns("method | against");
    columns.extend(QUOTED.map(|(quantity, sample)| {
        TableColumn::text(format!("{} {}", labels::quantity(quantity), labels::sample(sample)))
    }));
    let mut rows = Vec::new();
    let mut floors = Vec::new();
    let mut all = one.paths.along(Axis::Cells).to_vec();
    all.retain(|path| path.records.len() >= WINDOW);
    // A layer's other soils have their place in its own section.
    all.retain(|path| !one.study.scene.shows_locking() || path.records[0].case.variant().is_empty());
    let labels = labels::path_labels(&all);
    for (path, label) in all.iter().zip(&labels.each) {
        let times = &path.records[0].case.time_factors;
        let Some(time_factor) = times.get((times.len() - 1) / 2) else { continue };
        for reference in &one.study.references {
            let cells = QUOTED.map(|(quantity, sample)| {
                let measure =
                    path.own_measure(&first_measure(quantity, sample, reference.name(), *time_factor));
                quote(path, &measure, &mut floors)
            });
            // Against another theory than its own a run is quoted where that is the question.
            if *reference == one.study.references[0] || one.asks_for(reference.name()) {
                let mut row: Vec<Cell> = vec![Cell::Code(label.clone()), reference.name().into()];
                row.extend(cells);
                rows.push(row);
            }
        }
    }
    if rows.is_empty() {
        return Vec::new();
    }
    let title = "Order on the finest three meshes, error on ten cells";
    let table = Table::of(title, columns, rows)
        .note(format!("at the middle output time; relative L_2 norm over the volume. {}", labels::CLASSES));
    let is_attached = all.iter().any(|path| path.records.iter().any(|record| record.attached.is_some()));
    let places = "of an attached solver its own places stand for the points".to_owned();
    let table = table.notes(is_attached.then_some(places));
    let mut blocks = vec![Block::Heading("What converges to what".to_owned()), Block::Table(table)];
    if !floors.is_empty() {
        let more = floors.len().saturating_sub(MOST_FLOORS);
        floors.truncate(MOST_FLOORS);
        floors.extend((more > 0).then(|| format!("And {more} more, of the series whose class says so.")));
        blocks.push(Block::Paragraph("Floors:".to_owned()));
        blocks.push(Block::List(floors));
    }
    blocks
}

/// Order and error of one series in a few characters; its floor, where there is one, is told at
/// length.
fn quote(path: &Path<'_>, measure: &Measure, floors: &mut Vec<String>) -> Cell {
    let summary = path.summary(measure);
    let class = &summary.classification;
    let is_pressure = (measure.quantity, measure.sample) == (Quantity::Pressure, Sample::Points);
    if let Some(floor) = class.floor.as_ref().filter(|_| is_pressure) {
        floors.push(format!(
            "**{}**, {} at T_v = {} against `{}`: {}. {}",
            path.label(),
            labels::measure(measure),
            typed(measure.time_factor),
            measure.reference,
            class.reason,
            capitalised(class.advice.as_deref())
                .unwrap_or_else(|| format!("The floor is {:.2e}.", floor.value)),
        ));
    }
    let on_ten = path.records.iter().position(|record| record.case.cells == QUOTED_CELLS);
    let error = on_ten.and_then(|index| summary.series.levels().get(index)?.error);
    let error =
        error.map_or(String::new(), |error| format!(", {}", number::error(error).replace('-', "\u{2011}")));
    let head = match (class.order, class.class) {
        (Some(order), Class::Asymptotic | Class::Superconvergent) => number::order(order),
        (Some(order), other) => format!("{} ({other})", number::order(order)),
        (None, other) => other.name().to_owned(),
    };
    Cell::Text(head + &error)
}

/// Advice as a sentence of its own.
fn capitalised(advice: Option<&str>) -> Option<String> {
    let mut letters = advice?.chars();
    let first = letters.next()?;
    Some(format!("{}{}.", first.to_uppercase(), letters.as_str()))
}
