//! How every case of a hard study ended: one row per setup, one column per method.

use crate::case::quantity::{Quantity, Sample};
use crate::record::{Record, Status};
use crate::render::number;
use crate::render::report::StudyResults;
use crate::render::report::labels::{distinct, first_measure};
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use std::collections::HashMap;

/// Why a cell is empty.
const NOT_TRIED: &str = "not tried";

/// An error as large as the result, which is then useless.
const MEANINGLESS: f64 = 1.0;

/// The ends of all cases of a study that expects how its cases end; `None` for others.
pub fn survival(one: &StudyResults<'_>) -> Option<Table> {
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
    Some(Table::of("How each case ended", columns, rows).note(
        "a number is the relative L_2 error of the pressure at the points at the last output, ✗ where it is as large \
         as the answer; ✗ with the name of a failure and its step",
    ))
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
    use crate::case::planned::Tier;
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
        let table = survival(&results).expect("a table");
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

    #[test]
    fn a_run_is_told_by_its_error_at_the_last_output() {
        let text = STUDY.replace("[0.05]", "[0.05, 0.1, 0.4]");
        let mut record = records_of(&text).remove(0);
        for row in &mut record.errors {
            row.value = if row.time_factor == 0.4 { 0.25 } else { 3.0 };
        }
        assert_eq!(end_of(&record), Cell::Verdict(Mood::Pass, number::error(0.25)));
        record.errors.iter_mut().for_each(|row| row.value = 1.0);
        assert_eq!(end_of(&record), Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(1.0))));
    }
}
