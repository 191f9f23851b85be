//! The tidy CSV of a study: one row per measure.

use crate::case::{Case, KEYS, Key};
use crate::record::csv::lines_of;
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

/// Columns after those of a measure that are not inputs of the case.
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

/// The measures of a record as rows of CSV. A case that failed before its first output has one row without a measure, so
/// that it is seen.
///
/// # Errors
/// Never for words in memory; the writer's own otherwise.
pub fn rows_of(study: &str, record: &Record) -> Result<String, csv::Error> {
    let first = case_fields(study, record);
    let inputs: Vec<String> = other_inputs().map(|key| input_of(key, &record.case)).collect();
    let last = last_fields(record);
    let measures = measures_of(record);
    lines_of(measures.iter().map(|(measure, absolute)| {
        first.iter().chain(measure).chain(&inputs).chain(std::iter::once(absolute)).chain(&last)
    }))
}

/// The fields of every measure in the order of [`ERROR_COLUMNS`], each with its absolute error.
fn measures_of(record: &Record) -> Vec<([String; ERROR_COLUMNS.len()], String)> {
    let errors = record.errors.iter().map(|row| {
        let [time_factor, quantity, sample, norm, reference, _] = row.csv_fields();
        let value = format!("{:e}", row.value);
        ([time_factor, quantity, sample, norm, reference, value], format!("{:e}", row.absolute))
    });
    // What is measured beside errors of fields has its name in the place of the quantity, and no place.
    let others = record.measures.iter().map(|row| {
        let time_factor = row.time_factor.map_or(String::new(), |factor| factor.to_string());
        let norm = if row.exact == 0.0 { "absolute" } else { "relative" }.to_owned();
        let [value, absolute] =
            [row.error(), (row.found - row.exact).abs()].map(|error| format!("{error:e}"));
        ([time_factor, row.name.clone(), String::new(), norm, row.reference.clone(), value], absolute)
    });
    let mut measures: Vec<_> = errors.chain(others).collect();
    if measures.is_empty() {
        measures.push(Default::default());
    }
    measures
}

/// An input as the table has it, empty if it has no effect on the case.
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
        record.status.name().to_owned(),
        record.provenance.sources.clone(),
    ]);
    fields
}

/// What all rows of a record end with, in the order of [`LAST_COLUMNS`] from the second on.
fn last_fields(record: &Record) -> [String; LAST_COLUMNS.len() - 1] {
    let case = &record.case;
    let wall = quickest(&record.wall);
    let seconds = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:e}"));
    [
        case.scene.name.to_owned(),
        case.task.name().to_owned(),
        case.cell_size().to_string(),
        seconds(wall.map(|sample| sample.seconds)),
        seconds(wall.and_then(|sample| sample.cpu_seconds)),
    ]
}

/// The shortest of the times that a case had for itself, or of all where it never was alone.
fn quickest(samples: &[WallSample]) -> Option<&WallSample> {
    let least = |alone: bool| {
        let fit = samples.iter().filter(|sample| sample.alone || !alone);
        fit.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    };
    least(true).or_else(|| least(false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quickest_time_is_the_shortest_alone_wherever_it_stands() {
        let sample = |seconds, alone| WallSample { seconds, alone, ..WallSample::default() };
        let mut samples = vec![sample(3.0, true), sample(2.0, true), sample(1.0, false), sample(4.0, true)];
        for _ in 0..samples.len() {
            assert_eq!(quickest(&samples).map(|found| found.seconds), Some(2.0));
            samples.rotate_left(1);
        }
        samples.retain(|sample| !sample.alone);
        assert_eq!(quickest(&samples).map(|found| found.seconds), Some(1.0), "never alone");
        assert!(quickest(&[]).is_none());
    }

    #[test]
    fn times_that_a_case_had_for_itself_are_those_alone() {
        let mut record = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\ncells = [2]\n\
             integrator = ['implicit']\ntime_step = [{ growth = 0.5 }]\n",
        )
        .remove(0);
        let sample = |(seconds, alone)| WallSample { seconds, alone, ..WallSample::default() };
        record.wall = [(3.0, true), (1.0, false), (2.0, true)].map(sample).to_vec();
        assert_eq!(record.wall_alone(), [3.0, 2.0]);
    }
}
