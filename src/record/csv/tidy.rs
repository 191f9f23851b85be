//! One row a measure: the tidy CSV of a study.

use crate::case::Case;
use crate::case::keys::{KEYS, Key};
use crate::record::{ERROR_COLUMNS, Record, WallSample};

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
/// What all rows of a record have in common is written once and copied: of sixty columns a measure changes seven.
pub fn rows_of(study: &str, record: &Record) -> String {
    let first = fields_line(&case_fields(study, record));
    let LastFields { inputs, others } = last_fields(record);
    let (inputs, others) = (fields_line(&inputs), fields_line(&others));
    let mut rows = String::new();
    let mut write = |measure: [&str; ERROR_COLUMNS.len()], absolute: &str| {
        rows.push_str(&first);
        for field in measure {
            rows.push(',');
            push_field(&mut rows, field);
        }
        for part in [&inputs, absolute, &others] {
            rows.push(',');
            rows.push_str(part);
        }
        rows.push('\n');
    };
    for row in &record.errors {
        let [quantity, sample, norm] = [row.quantity.name(), row.sample.name(), row.norm.name()];
        let [time_factor, value] = [row.time_factor.to_string(), format!("{:e}", row.value)];
        write([&time_factor, quantity, sample, norm, &row.reference, &value], &format!("{:e}", row.absolute));
    }
    // What is measured beside errors of fields has its name in the place of the quantity, and no place.
    for row in &record.measures {
        let time_factor = row.time_factor.map_or(String::new(), |factor| factor.to_string());
        let norm = if row.exact == 0.0 { "absolute" } else { "relative" };
        let [value, absolute] =
            [row.error(), (row.found - row.exact).abs()].map(|error| format!("{error:e}"));
        write([&time_factor, &row.name, "", norm, &row.reference, &value], &absolute);
    }
    if record.errors.is_empty() && record.measures.is_empty() {
        write([""; ERROR_COLUMNS.len()], "");
    }
    rows
}

/// Fields as a part of a line.
fn fields_line(fields: &[String]) -> String {
    let mut line = String::new();
    for (place, field) in fields.iter().enumerate() {
        if place > 0 {
            line.push(',');
        }
        push_field(&mut line, field);
    }
    line
}

/// Appends a field as CSV has it (RFC 4180): in quotes where it would be read as more than one.
fn push_field(line: &mut String, field: &str) {
    if field.contains([',', '"', '\r', '\n']) {
        line.push('"');
        line.push_str(&field.replace('"', "\"\""));
        line.push('"');
    } else {
        line.push_str(field);
    }
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
