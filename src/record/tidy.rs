//! One row a measure: the tidy CSV of a study.

use crate::case::step_label;
use crate::record::{ErrorRow, Record};

/// Columns of the tidy CSV.
const COLUMNS: [&str; 21] = [
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
    "time_factor",
    "quantity",
    "sample",
    "norm",
    "reference",
    "value",
];
/// The last of them, those of a measure.
const MEASURE_COLUMNS: usize = 6;

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
    writer.write_record(COLUMNS)?;
    for record in records {
        let case = case_fields(study, record);
        let mut write = |measure: &[String]| writer.write_record(case.iter().chain(measure));
        for row in &record.errors {
            write(&measure_fields(row))?;
        }
        if record.errors.is_empty() {
            write(&[const { String::new() }; MEASURE_COLUMNS])?;
        }
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// What all rows of a record begin with.
fn case_fields(study: &str, record: &Record) -> [String; COLUMNS.len() - MEASURE_COLUMNS] {
    let case = &record.case;
    [
        study.to_owned(),
        record.hash.clone(),
        case.method.to_string(),
        case.integrator.name().to_owned(),
        format!("{:?}", case.settings.drag).to_lowercase(),
        case.settings.flip.to_string(),
        case.settings.mapping_back.to_string(),
        case.cells.to_string(),
        case.points_per_cell.to_string(),
        step_label(&case.time_step),
        format!("{:e}", record.step_sizes.largest),
        record.counters.steps.to_string(),
        record.counters.point_updates.to_string(),
        record.status.name(),
        record.provenance.sources.clone(),
    ]
}

/// What a measure's row ends with.
fn measure_fields(row: &ErrorRow) -> [String; MEASURE_COLUMNS] {
    [
        row.time_factor.to_string(),
        row.quantity.name().to_owned(),
        row.sample.name().to_owned(),
        row.norm.name().to_owned(),
        row.reference.clone(),
        format!("{:e}", row.value),
    ]
}
