//! How did each case end? Of a study that expects how its cases end.

use crate::case::grouping::{distinct, grouped};
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_error;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};

/// How did each case end?
pub static ENDS: Question = Question {
    id: "ends",
    heading: "How did each case end?",
    template: include_str!("ends.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cases with a record.
    cases: usize,
    /// Those that reached their last output.
    ended: usize,
    /// Those of them with an error as large as the answer.
    useless: usize,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let mut expected = one.study.case_expectations.iter();
    if expected.all(|expectation| expectation.demand.status.is_none()) {
        return None;
    }
    let ended = || one.records.iter().filter(|record| record.status == Status::Ok);
    let useless = ended().filter(|record| error_of(record).is_some_and(|error| !is_useful(error)));
    let facts = Facts { cases: one.records.len(), ended: ended().count(), useless: useless.count() };
    let each = Block::Details {
        summary: "Every case by its method".to_owned(),
        blocks: vec![Block::Table(table(one.records))],
    };
    Some(ENDS.answer([one.study.name.as_str()], &facts).with(each))
}

/// Whether an error is smaller than the answer.
fn is_useful(error: f64) -> bool {
    error < 1.0
}

/// Error of the pressure at the points at the last output.
fn error_of(record: &Record) -> Option<f64> {
    let (own, at) = record.references.first().zip(record.case.time_factors.last())?;
    first_error(record, Quantity::Pressure, Sample::Points, &own.name, *at)
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

/// A row a setup, a column a method; of several runs of both the first is shown.
fn table(records: &[Record]) -> Table {
    let runners = distinct(records.iter().map(runner_of));
    let mut columns = columns("case");
    columns.extend(runners.iter().map(|runner| TableColumn::text(runner.as_str())));
    let mut setups = grouped(records, |record| {
        let case = &record.case;
        (case.cells, case.points_per_cell, case.variant())
    });
    setups.sort_by_key(|((cells, points, _), _)| (*cells, *points));
    let rows = setups.into_iter().map(|((cells, points, variant), runs)| {
        let comma = if variant.is_empty() { "" } else { ", " };
        let setup = format!("{cells} cells, {points} points{comma}{variant}");
        let end = |runner: &String| {
            let first = runs.iter().find(|record| runner_of(record) == *runner);
            first.map_or_else(|| Cell::missing("not tried"), |record| end_cell(record))
        };
        std::iter::once(setup.into()).chain(runners.iter().map(end)).collect()
    });
    Table::of("How each case ended", columns, rows).file("ends").note(
        "a number is the relative L_2 error of the pressure at the points at the last output, with ✗ if it \
         is as large as the solution; a failed case has ✗, the name of the failure and its step",
    )
}

fn end_cell(record: &Record) -> Cell {
    match (record.status.failure(), error_of(record)) {
        (Some(failure), _) => Cell::Verdict(Mood::Fail, failure.name_with_step()),
        (None, None) => Cell::Verdict(Mood::Pass, "ran".to_owned()),
        (None, Some(error)) if is_useful(error) => Cell::Verdict(Mood::Pass, number::error(error)),
        (None, Some(error)) => Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};
    use crate::case::planned::Tier;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.4]\n[[sweep]]\n\
        method = ['MPM', 'GIMP']\nintegrator = ['implicit']\ncells = [8, 4]\n\
        time_step = [{ growth = 0.3 }, { growth = 0.6 }]\n[[sweep]]\nmethod = ['GC-SRI-patch']\n\
        integrator = ['implicit']\ncells = [8]\ntime_step = [{ growth = 0.3 }]\n\
        [[expect_case]]\nmethod = 'MPM'\nstatus = 'ok'\n";

    #[test]
    fn every_setup_has_its_row_every_method_its_column_and_the_first_of_several_runs_is_shown() {
        let (study, mut records) = solved("s", STUDY);
        for (place, record) in records.iter_mut().enumerate() {
            let last = 0.125 * (place + 1) as f64;
            record
                .errors
                .iter_mut()
                .for_each(|row| row.value = if row.time_factor == 0.4 { last } else { 3.0 });
        }
        records[2].status = failed_at(7);
        let place = |method: &str, cells: usize| {
            let mut first = records.iter();
            first.position(|one| one.case.cells == cells && one.case.method.to_string() == method)
        };
        let shown = |method: &str, cells: usize| match place(method, cells) {
            None => "–".to_owned(),
            Some(2) => "✗ unstable at step 7".to_owned(),
            Some(place) if place < 7 => format!("✓ {}", number::error(0.125 * (place + 1) as f64)),
            Some(place) => format!("✗ ran, error {}", number::error(0.125 * (place + 1) as f64)),
        };
        let table = table(&records);
        for (row, cells) in table.rows.iter().zip([4, 8]) {
            let told: Vec<String> = row.iter().map(Cell::show).collect();
            let of = |method: &str| shown(method, cells);
            let wanted = [format!("{cells} cells, 2 points"), of("MPM"), of("GIMP"), of("GC-SRI-patch")];
            assert_eq!(told, wanted);
        }
        let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("it expects ends");
        let told = "8 of 9 cases reached the last output, 2 of them with an error as large as the solution.";
        assert_eq!(found.sentence().expect("a sentence"), told);
    }
}
