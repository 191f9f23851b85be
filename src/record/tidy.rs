//! One row a measure: the tidy CSV of a study.

use crate::case::Case;
use crate::case::keys::{KEYS, Key};
use crate::record::{ERROR_COLUMNS, ErrorRow, MeasureRow, Record, WallSample};
use std::io::Write;

/// First columns of the tidy CSV, before those of a measure; one with the name of a key has the value of that input.
const CASE_COLUMNS: [&str; 15] = [
    "study",
    "case",
    "method",
    "integrator",
    "drag",
    "flip",
    "mapping_back",
    "cells",
    "points_per_cell",
    "time_step",
    "largest_step_seconds",
    "steps",
    "point_updates",
    "status",
    "sources",
];

/// Columns behind those of a measure that are no input of the case.
const LAST_COLUMNS: [&str; 6] =
    ["absolute_error", "scene", "task", "cell_size", "wall_seconds", "cpu_seconds"];

/// The inputs that have no column among the first ones.
fn other_inputs() -> impl Iterator<Item = &'static Key> {
    KEYS.iter().filter(|key| !CASE_COLUMNS.contains(&key.name))
}

/// The columns of the table: those of a case, those of a measure, every other input, and what is known beside.
pub fn columns() -> Vec<&'static str> {
    let first = CASE_COLUMNS.iter().chain(&ERROR_COLUMNS).copied();
    first.chain(other_inputs().map(|key| key.name)).chain(LAST_COLUMNS).collect()
}

/// The line of the columns, with its end.
pub fn header_line() -> String {
    columns().join(",") + "\n"
}

/// The measures of a record as rows of CSV. A case that failed before its first output has one
/// row without a measure, so that it is seen.
///
/// # Errors
/// Never for plain numbers and words; the writer's own otherwise.
pub fn write_rows(out: impl Write, study: &str, record: &Record) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(out);
    let case = case_fields(study, record);
    let last = last_fields(record);
    let mut write = |measure: &[String], absolute: String| {
        writer.write_record(
            case.iter().chain(measure).chain(&last.inputs).chain([&absolute]).chain(&last.others),
        )
    };
    for row in &record.errors {
        write(&measure_fields(row), format!("{:e}", row.absolute))?;
    }
    for row in &record.measures {
        write(&fields_beside(row), format!("{:e}", (row.found - row.exact).abs()))?;
    }
    if record.errors.is_empty() && record.measures.is_empty() {
        write(&[const { String::new() }; ERROR_COLUMNS.len()], String::new())?;
    }
    Ok(writer.flush()?)
}

/// The rows of a record as text.
///
/// # Errors
/// As [`write_rows`].
pub fn rows_of(study: &str, record: &Record) -> Result<String, csv::Error> {
    let mut bytes = Vec::new();
    write_rows(&mut bytes, study, record)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// An input as the table has it: nothing where it says nothing of the case.
fn input_of(key: &Key, case: &Case) -> String {
    if key.counts_for(case) { key.get(case).to_string() } else { String::new() }
}

/// What all rows of a record begin with.
fn case_fields(study: &str, record: &Record) -> Vec<String> {
    let inputs = CASE_COLUMNS.iter().filter_map(|name| Key::named(name, "sweep"));
    let mut fields = vec![study.to_owned(), record.hash.clone()];
    fields.extend(inputs.map(|key| input_of(key, &record.case)));
    fields.extend([
        format!("{:e}", record.step_sizes.largest),
        record.counters.steps.to_string(),
        record.counters.point_updates.to_string(),
        record.status.name(),
        record.provenance.sources.clone(),
    ]);
    fields
}

/// What all rows of a record end with, but for the absolute error between the two.
struct LastFields {
    inputs: Vec<String>,
    others: [String; LAST_COLUMNS.len() - 1],
}

fn last_fields(record: &Record) -> LastFields {
    let case = &record.case;
    let wall = quickest(&record.wall);
    let seconds = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:e}"));
    LastFields {
        inputs: other_inputs().map(|key| input_of(key, case)).collect(),
        others: [
            case.scene.name().to_owned(),
            case.task.name().to_owned(),
            case.cell_size().to_string(),
            seconds(wall.map(|sample| sample.seconds)),
            seconds(wall.and_then(|sample| sample.cpu_seconds)),
        ],
    }
}

/// The shortest of the times that a case had for itself, or of all where it never was alone.
fn quickest(samples: &[WallSample]) -> Option<&WallSample> {
    let least = |alone: bool| {
        let fit = samples.iter().filter(|sample| sample.alone || !alone);
        fit.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    };
    least(true).or_else(|| least(false))
}

/// The row of what is measured beside errors of fields: its name in the place of the quantity, and no place.
fn fields_beside(row: &MeasureRow) -> [String; ERROR_COLUMNS.len()] {
    let time_factor = row.time_factor.map_or(String::new(), |factor| factor.to_string());
    let norm = if row.exact == 0.0 { "absolute" } else { "relative" };
    let words = [row.name.as_str(), "", norm, &row.reference].map(str::to_owned);
    let [quantity, sample, norm, reference] = words;
    [time_factor, quantity, sample, norm, reference, format!("{:e}", row.error())]
}

/// What a measure's row ends with.
fn measure_fields(row: &ErrorRow) -> [String; ERROR_COLUMNS.len()] {
    let [time_factor, quantity, sample, norm, reference, _] = row.csv_fields();
    [time_factor, quantity, sample, norm, reference, format!("{:e}", row.value)]
}
