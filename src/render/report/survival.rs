//! How every case of a hard study ended, with its error where it has one.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::first_norm;
use crate::record::{Record, Status};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::table::{Cell, Mood, Table, TableColumn, columns};

/// An error as large as the answer: the run went on, and its result is none.
const MEANINGLESS: f64 = 1.0;

/// How every case of a study ended that says how its cases are to end; none for others.
pub fn block(one: &StudyResults<'_>) -> Option<Block> {
    if !is_hard(one) {
        return None;
    }
    let methods = distinct(one.records.iter().map(runner_of));
    let mut columns = columns("case");
    columns.extend(methods.iter().map(|method| TableColumn::text(method.clone())));
    let rows = distinct(one.records.iter().map(setup_of)).into_iter().map(|setup| {
        let mut row: Vec<Cell> = vec![setup.as_str().into()];
        row.extend(methods.iter().map(|method| {
            let of_setup = |record: &&Record| setup_of(record) == setup && runner_of(record) == *method;
            one.records.iter().find(of_setup).map_or(Cell::missing("not tried"), end_of)
        }));
        row
    });
    let table = Table::of("How each case ended", columns, rows).note(
        "a number is the relative L_2 error of the pressure at the points at the last output, ✗ where it is as large \
         as the answer; ✗ with the name of a failure and its step",
    );
    Some(Block::Table(table))
}

/// Names in the order of their first appearance.
fn distinct(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen: Vec<String> = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

fn is_hard(results: &StudyResults<'_>) -> bool {
    results.study.case_expectations.iter().any(|one| one.demand.status.is_some())
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
            let error =
                record.references.first().zip(record.case.time_factors.last()).and_then(|(own, at)| {
                    let norm = first_norm(Quantity::Pressure);
                    record.error(Quantity::Pressure, Sample::Points, norm, &own.name, *at)
                });
            match error.map(|row| row.value) {
                None => Cell::Verdict(Mood::Pass, "ran".to_owned()),
                Some(value) if value < MEANINGLESS => Cell::Verdict(Mood::Pass, number::error(value)),
                Some(value) => Cell::Verdict(Mood::Fail, format!("ran, error {}", number::error(value))),
            }
        }
    }
}
