//! The tables of what each method of a study converges to and how fast, and of how every case of a hard study ended.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::Path;
use crate::record::{Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::report::labels::{self, CONVERGENCE, QUOTED_CELLS, capitalised, distinct, first_measure};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::study::expectation::{Axis, Measure};
use oedometer_convergence::WINDOW;
use oedometer_soil::wording::typed;
use std::collections::HashMap;

/// Floors that are listed before the rest is only counted.
const MOST_FLOORS: usize = 20;

/// One row per path: order and error on ten cells of each measure, and the floors; empty where no mesh was refined.
pub fn findings(one: &StudyResults<'_>) -> Vec<Block> {
    let mut columns = columns("method | against");
    columns.extend(CONVERGENCE.map(|(quantity, sample)| {
        TableColumn::text(format!("{} {}", labels::quantity(quantity), labels::sample(sample)))
    }));
    let mut rows = Vec::new();
    let mut floors = Vec::new();
    let mut all = one.paths.along(Axis::Cells).to_vec();
    all.retain(|path| path.records.len() >= WINDOW);
    // The other soils of a layer are in a section of their own.
    all.retain(|path| !one.study.scene.shows_locking() || path.records[0].case.variant().is_empty());
    let labels = labels::path_labels(&all);
    for (path, label) in all.iter().zip(&labels.each) {
        let times = &path.records[0].case.time_factors;
        let Some(time_factor) = times.get((times.len() - 1) / 2) else { continue };
        for reference in &one.study.references {
            let cells = CONVERGENCE.map(|(quantity, sample)| {
                let measure =
                    path.own_measure(&first_measure(quantity, sample, reference.name(), *time_factor));
                quote(path, &measure, &mut floors)
            });
            // A run is compared with another theory than its own only where the study asks for it.
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
    let places = "an attached solver is sampled at its own places instead of the points".to_owned();
    let table = table.notes(is_attached.then_some(places));
    let mut blocks = vec![Block::Heading("What converges to what".to_owned()), Block::Table(table)];
    if !floors.is_empty() {
        let more = floors.len().saturating_sub(MOST_FLOORS);
        floors.truncate(MOST_FLOORS);
        floors
            .extend((more > 0).then(|| format!("And {more} more, of the series classified floor-limited.")));
        blocks.push(Block::Paragraph("Floors:".to_owned()));
        blocks.push(Block::List(floors));
    }
    blocks
}

/// Order and error of one series in a few characters; its floor goes to the list of floors.
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
            class.advice.as_deref().map_or_else(
                || format!("The floor is {:.2e}.", floor.value),
                |advice| format!("{}.", capitalised(advice))
            ),
        ));
    }
    let on_ten = path.records.iter().position(|record| record.case.cells == QUOTED_CELLS);
    let error = on_ten.and_then(|index| summary.series.levels().get(index)?.error);
    labels::order_and_error(class, error).into()
}

/// Why a cell is empty.
const NOT_TRIED: &str = "not tried";

/// An error as large as the result, which is then useless.
const MEANINGLESS: f64 = 1.0;

/// The ends of all cases of a study that expects how its cases end; `None` for others.
pub fn survival(one: &StudyResults<'_>) -> Option<Block> {
    if one.study.case_expectations.iter().all(|expectation| expectation.demand.status.is_none()) {
        return None;
    }
    let methods = distinct(one.records.iter().map(runner_of));
    let mut columns = columns("case");
    columns.extend(methods.iter().map(|method| TableColumn::text(method.clone())));
    // A row a setup, found by its name: there may be thousands.
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for record in one.records {
        let setup = setup_of(record);
        let place = *places.entry(setup).or_insert_with_key(|setup| {
            let not_tried = methods.iter().map(|_| Cell::missing(NOT_TRIED));
            rows.push(std::iter::once(setup.as_str().into()).chain(not_tried).collect());
            rows.len() - 1
        });
        let runner = runner_of(record);
        let column = methods.iter().position(|method| *method == runner).map(|column| column + 1);
        // Of several runs of a setup the first is shown.
        if let Some(cell) = column.and_then(|column| rows[place].get_mut(column))
            && matches!(cell, Cell::Missing(_))
        {
            *cell = end_of(record);
        }
    }
    let table = Table::of("How each case ended", columns, rows).note(
        "a number is the relative L_2 error of the pressure at the points at the last output, ✗ where it is as large \
         as the answer; ✗ with the name of a failure and its step",
    );
    Some(Block::Table(table))
}

/// Method, with the integrator where it is not the explicit one.
fn runner_of(record: &Record) -> String {
    let case = &record.case;
    if case.is_explicit() {
        case.method.to_string()
    } else {
        format!("{}, {}", case.method, case.integrator.name())
    }
}

fn setup_of(record: &Record) -> String {
    let case = &record.case;
    let variant = case.variant();
    let comma = if variant.is_empty() { "" } else { ", " };
    format!("{} cells, {} points{comma}{variant}", case.cells, case.points_per_cell)
}

fn end_of(record: &Record) -> Cell {
    match &record.status {
        Status::Failed(failure) => Cell::Verdict(Mood::Fail, failure.name_with_step()),
        Status::Ok => {
            let own = record.references.first().zip(record.case.time_factors.last());
            let error = own.and_then(|(own, at)| {
                first_measure(Quantity::Pressure, Sample::Points, &own.name, *at).error(record)
            });
            match error.map(|row| row.value) {
                None => Cell::Verdict(Mood::Pass, "ran".to_owned()),
                Some(value) if value < MEANINGLESS => Cell::Verdict(Mood::Pass, number::error(value)),
                Some(value) => Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(value))),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::tier::Tier;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\n\
        method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\n\
        time_step = [{ growth = 0.3 }, { growth = 0.6 }]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
        integrator = ['implicit']\ncells = [8]\ntime_step = [{ growth = 0.3 }]\n\
        [[expect_case]]\nmethod = 'MPM'\nstatus = 'ok'\n";

    #[test]
    fn every_setup_has_its_row_every_method_its_column_and_the_first_of_several_runs_is_shown() {
        let source = StudySource { name: "s.toml".to_owned(), text: STUDY.to_owned() };
        let study = Study::check(&source).expect("sound");
        let records = records_of(STUDY);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let Some(Block::Table(table)) = survival(&results) else { panic!("a table") };
        assert_eq!((table.columns.len(), table.rows.len()), (4, 2));
        let shown = |method: &str, cells: usize| {
            let fits = |one: &&Record| one.case.cells == cells && one.case.method.to_string() == method;
            end_of(records.iter().find(fits).expect("a record"))
        };
        for (row, cells) in table.rows.iter().zip([4, 8]) {
            assert_eq!(row[0], Cell::Text(format!("{cells} cells, 2 points")));
            assert_eq!([&row[1], &row[2]], [&shown("MPM", cells), &shown("GIMP", cells)]);
        }
        assert_eq!(
            (&table.rows[0][3], &table.rows[1][3]),
            (&Cell::missing(NOT_TRIED), &shown("GC-SRI-patch", 8))
        );
    }
}
