//! One row a measure: the tidy CSV of a study.

use crate::case::keys::Key;
use crate::record::{ERROR_COLUMNS, ErrorRow, Record};

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

/// The measures of a study's records as CSV. A case that failed before its first output has one
/// row without a measure, so that it is seen.
///
/// # Errors
/// Never for plain numbers and words; the writer's own otherwise.
pub fn tidy_csv<'a>(
    study: &str,
    records: impl IntoIterator<Item = &'a Record>,
) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(CASE_COLUMNS.iter().chain(&ERROR_COLUMNS))?;
    for record in records {
        let case = case_fields(study, record);
        let mut write = |measure: &[String]| writer.write_record(case.iter().chain(measure));
        for row in &record.errors {
            write(&measure_fields(row))?;
        }
        if record.errors.is_empty() {
            write(&[const { String::new() }; ERROR_COLUMNS.len()])?;
        }
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// What all rows of a record begin with.
fn case_fields(study: &str, record: &Record) -> Vec<String> {
    let inputs = CASE_COLUMNS.iter().filter_map(|name| Key::named(name, "sweep"));
    let mut fields = vec![study.to_owned(), record.hash.clone()];
    fields.extend(inputs.map(|key| key.get(&record.case).to_string()));
    fields.extend([
        format!("{:e}", record.step_sizes.largest),
        record.counters.steps.to_string(),
        record.counters.point_updates.to_string(),
        record.status.name(),
        record.provenance.sources.clone(),
    ]);
    fields
}

/// What a measure's row ends with.
fn measure_fields(row: &ErrorRow) -> [String; ERROR_COLUMNS.len()] {
    let [time_factor, quantity, sample, norm, reference, _] = row.csv_fields();
    [time_factor, quantity, sample, norm, reference, format!("{:e}", row.value)]
}
