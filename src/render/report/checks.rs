//! How every case of a hard study ended, and what a study measures beside errors of fields: peaks, quantities that must not
//! move, start checks and balances.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::distinct;
use crate::judge::study_results::StudyResults;
use crate::measure::record_checks;
use crate::record::{MeasureRow, Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::labels::first_measure;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};
use crate::render::tables::measures::{bound_cell, groups_of};
use std::collections::HashMap;

/// One row per case and measure, of its worst output; empty where nothing is measured so.
pub fn measures(results: &StudyResults<'_>) -> Vec<Block> {
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for record in results.records {
        let case = record.case.label();
        rows.extend(worst_of(record).into_iter().map(|row| cells_of(&case, row)));
    }
    if rows.is_empty() {
        return Vec::new();
    }
    let header = "case | measure | > T_v | > found | > exact | > error";
    let table = Table::of("Measures beside the errors", columns(header), rows)
        .note("the worst output of each run; `T_v` is empty where a measure is of the whole run")
        .note(
            "spurious_velocity: largest nodal velocity over the hydraulic conductivity; pore_water: water in the soil over \
             its pores, less one; largest_pressure: of any water point since the start, over the load, where 1 is what \
             consolidation begins with at most; the error is relative where the exact value is not zero",
        );
    vec![Block::Heading("Measures".to_owned()), Block::Table(table)]
}

/// The worst of every check over the runs of a study, and the largest of every dimensionless group.
pub fn worst_checks(results: &StudyResults<'_>) -> Block {
    // Runs that failed have no result to check.
    let sound = results.records.iter().filter(|record| record.status == Status::Ok);
    let mut rows: Vec<Vec<Cell>> = record_checks::worst_of(sound)
        .iter()
        .map(|check| vec![check.what.into(), Cell::Error(check.value.abs()), bound_cell(check)])
        .collect();
    let largest = results.records.iter().map(groups_of).reduce(|mut largest, groups| {
        for (largest, group) in largest.iter_mut().zip(groups) {
            largest.1 = largest.1.max(group.1);
        }
        largest
    });
    let groups = largest.into_iter().flatten();
    rows.extend(groups.map(|(what, value)| vec![what.into(), Cell::Error(value), "".into()]));
    let table =
        Table::of("Start checks, balances and groups", columns("what | > worst of all runs | bound"), rows)
            .note(
                "Pressures recovered over a patch of cells (`-patch`) do not conserve the stored water exactly: the imbalance \
                 falls with the mesh. An equilibrium residual of zero proves nothing: with one value per cell both stresses \
                 can be wrong by the same amount.",
            );
    Block::Details {
        summary: "Start checks, balances and dimensionless groups".to_owned(),
        blocks: vec![Block::Table(table)],
    }
}

/// A measure as a row: found, exact, and the error.
fn cells_of(case: &str, row: &MeasureRow) -> Vec<Cell> {
    let number =
        |value: f64| if row.exact == 0.0 { Cell::Error(value) } else { Cell::Text(format!("{value:.7}")) };
    vec![
        case.into(),
        Cell::Code(row.name.clone()),
        row.time_factor.map_or(String::new(), |factor| factor.to_string()).into(),
        number(row.found),
        number(row.exact),
        Cell::Error(row.error()),
    ]
}

/// The row with the largest error of every measure of a record, in the order of the record; NaN is worst.
fn worst_of(record: &Record) -> Vec<&MeasureRow> {
    let mut worst: Vec<&MeasureRow> = Vec::new();
    for row in &record.measures {
        match worst.iter_mut().find(|other| other.name == row.name) {
            Some(other) if row.error().is_nan() || row.error().abs() > other.error().abs() => *other = row,
            Some(_) => {}
            None => worst.push(row),
        }
    }
    worst
}

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
    let mut rows: Vec<([usize; 2], Vec<Cell>)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for record in one.records {
        let setup = setup_of(record);
        let place = *places.entry(setup).or_insert_with_key(|setup| {
            let not_tried = methods.iter().map(|_| Cell::missing(NOT_TRIED));
            let mesh = [record.case.cells, record.case.points_per_cell];
            rows.push((mesh, std::iter::once(setup.as_str().into()).chain(not_tried).collect()));
            rows.len() - 1
        });
        let runner = runner_of(record);
        let column = methods.iter().position(|method| *method == runner).map(|column| column + 1);
        // Of several runs of a setup the first is shown.
        if let Some(cell) = column.and_then(|column| rows[place].1.get_mut(column))
            && matches!(cell, Cell::Missing(_))
        {
            *cell = end_of(record);
        }
    }
    rows.sort_by_key(|(mesh, _)| *mesh);
    let rows = rows.into_iter().map(|(_, row)| row);
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
    use crate::campaign::runner::{records_of, solved};
    use crate::case::planned::Tier;

    #[test]
    fn a_peak_stands_beside_the_exact_one_and_of_outputs_the_worst() {
        let text = "title = \"t\"\nscene = \"mandel\"\noutput = { time_factors = [0.0645, 0.068, 0.0717] }\n[[sweep]]\n\
                    method = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\ncells = [10]\ntime_step = [{ growth = 0.02 }]\n";
        let (study, mut records) = solved("s", text);
        let told = |records: &[Record]| {
            let blocks = measures(&StudyResults::new(&study, records, Tier::Full));
            let Some(Block::Table(table)) = blocks.last() else { return String::new() };
            table.to_text().expect("a table")
        };
        let text = told(&records);
        // 0.54606 at T = 0.06802, less the error of ten cells.
        assert!(text.contains("| peak_pressure    |     | 0.54") && text.contains("| 0.5460597 |"), "{text}");
        assert!(text.contains("| peak_time_factor |     | 0.06") && text.contains("| 0.0680287 |"), "{text}");
        let at = |time_factor: f64, found: f64| MeasureRow {
            name: "spurious_velocity".to_owned(),
            time_factor: Some(time_factor),
            reference: "at-rest".to_owned(),
            found,
            exact: 0.0,
        };
        records[0].measures = vec![at(0.1, 1e-14), at(0.2, -3e-13), at(0.3, 2e-13)];
        assert!(told(&records).contains("| 0.2 | -3.00e-13 |     0 |"), "{}", told(&records));
        records[0].measures[0].found = f64::NAN;
        assert!(told(&records).contains("| 0.1 |"), "{}", told(&records));
        records[0].measures.clear();
        assert_eq!(told(&records), "");
    }

    #[test]
    fn each_group_of_all_runs_is_the_largest_wherever_it_stands() {
        let text = "title = \"t\"\nscene = \"terzaghi\"\noutput = { time_factors = [0.2] }\n[[sweep]]\n\
                    method = [\"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [2, 3, 4]\n";
        let (study, mut records) = solved("s", text);
        for (record, [storage, strain, inertia]) in
            records.iter_mut().zip([[0.3, 0.02, 0.001], [0.1, 0.05, 0.004], [0.2, 0.03, 0.007]])
        {
            let groups = &mut record.groups;
            (groups.storage, groups.finite_strain, groups.inertia) = (storage, strain, inertia);
        }
        let block = worst_checks(&StudyResults::new(&study, &records, Tier::Full));
        let Block::Details { blocks, .. } = block else { panic!("what the reader opens") };
        let [Block::Table(table)] = &blocks[..] else { panic!("one table") };
        let last: Vec<&Cell> = table.rows.iter().rev().take(3).map(|row| &row[1]).collect();
        assert_eq!(last, [&Cell::Error(0.007), &Cell::Error(0.05), &Cell::Error(0.3)]);
    }

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05]\n[[sweep]]\n\
        method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\n\
        time_step = [{ growth = 0.3 }, { growth = 0.6 }]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
        integrator = ['implicit']\ncells = [8]\ntime_step = [{ growth = 0.3 }]\n\
        [[expect_case]]\nmethod = 'MPM'\nstatus = 'ok'\n";

    #[test]
    fn every_setup_has_its_row_every_method_its_column_and_the_first_of_several_runs_is_shown() {
        let (study, records) = solved("s", STUDY);
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
