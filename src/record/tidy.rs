//! One row a measure: the tidy CSV of a study.

use super::{ErrorRow, Record};
use crate::study::step_label;

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

/// The measures of a study's records as CSV. A case that failed before its first output has one
/// row without a measure, so that it is seen.
///
/// # Errors
/// Never for plain numbers and words; the writer's own otherwise.
pub fn tidy_csv(study: &str, records: &[Record]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for record in records {
        for row in &record.errors {
            writer.write_record(fields(study, record, Some(row)))?;
        }
        if record.errors.is_empty() {
            writer.write_record(fields(study, record, None))?;
        }
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn fields(study: &str, record: &Record, row: Option<&ErrorRow>) -> Vec<String> {
    let case = &record.case;
    let mut fields = vec![
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
    ];
    match row {
        Some(row) => fields.extend([
            row.time_factor.to_string(),
            row.quantity.name().to_owned(),
            row.sample.name().to_owned(),
            row.norm.name().to_owned(),
            row.reference.clone(),
            format!("{:e}", row.value),
        ]),
        None => fields.extend((0..6).map(|_| String::new())),
    }
    fields
}
