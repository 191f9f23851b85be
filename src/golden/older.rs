//! Layouts 2 and 3 of golden files: a header in TOML, with tolerances, provenance and (3) inputs, and a table with all
//! norms. What is kept today is taken of them.

use crate::golden::GoldenFile;
use crate::golden::file_text::{Column, HEADER_MARK, SPREAD_MARK, time_of};
use crate::golden::measure::UnknownMeasure;
use crate::golden::text_error::{CellError, GoldenTextError};
use oedometer_problem::quantity::{Norm, Quantity};
use serde::Deserialize;
use std::sync::Arc;

/// What is read of a header.
#[derive(Deserialize)]
struct Header {
    schema: u32,
    study: String,
    reason: String,
}

/// The columns that say which case and time factor a row is of.
const LABELS: [&str; 2] = ["case", "T_v"];
/// What stands before the key of a column of inputs.
const INPUT_MARK: &str = "input ";
/// Steps times points.
const POINT_UPDATES: &str = "point updates";

/// What a column of an older table holds; none of inputs, of norms that nobody expects, and of steps times points.
fn column_of(title: &str) -> Result<Option<Column>, UnknownMeasure> {
    if title.starts_with(INPUT_MARK) || title == POINT_UPDATES {
        return Ok(None);
    }
    if let Some(of) = title.strip_prefix(SPREAD_MARK) {
        return of.parse().map(|of| Some(Column::Spreads(of)));
    }
    // An error has its norm between sample and reference.
    let words: Vec<&str> = title.split(' ').collect();
    if let [quantity, sample, norm, reference] = words[..]
        && let (Some(kind), Some(norm)) = (Quantity::named(quantity), Norm::named(norm))
    {
        let title = [quantity, sample, reference].join(" ");
        let is_kept = kind.first_norm() == norm;
        return is_kept.then(|| title.parse().map(Column::Values)).transpose();
    }
    title.parse().map(|measure| Some(Column::Values(measure)))
}

/// Reads a file of layout 2 or 3.
pub(super) fn from_text(text: &str) -> Result<GoldenFile, GoldenTextError> {
    let header = text.lines().take_while(|line| line.starts_with(HEADER_MARK));
    let header: Vec<&str> = header.map(|line| line[1..].strip_prefix(' ').unwrap_or(&line[1..])).collect();
    let header = header.join("\n");
    let header: Header = toml::from_str(&header).map_err(|source| {
        let before = source.span().map_or("", |span| header.get(..span.start).unwrap_or_default());
        GoldenTextError::Header { line: before.matches('\n').count() + 1, source }
    })?;
    if !(2..=3).contains(&header.schema) {
        return Err(GoldenTextError::Layout(header.schema.to_string()));
    }
    let mut golden = GoldenFile::of(&header.study, &[], &header.reason);
    let mut reader = csv::ReaderBuilder::new().comment(Some(HEADER_MARK as u8)).from_reader(text.as_bytes());
    let titles = reader.headers()?.clone();
    if !titles.iter().take(LABELS.len()).eq(LABELS) {
        return Err(GoldenTextError::Columns(&LABELS));
    }
    let columns: Result<Vec<Option<Column>>, _> = titles.iter().skip(LABELS.len()).map(column_of).collect();
    let columns = columns?;
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        take_row(&mut golden, &columns, &record).map_err(|source| GoldenTextError::Row { line, source })?;
    }
    Ok(golden)
}

fn take_row(
    golden: &mut GoldenFile,
    columns: &[Option<Column>],
    record: &csv::StringRecord,
) -> Result<(), CellError> {
    let (case, time): (Arc<str>, _) = (record[0].into(), time_of(&record[1])?);
    golden.cases.entry(case.clone()).or_default();
    let cells = columns.iter().zip(record.iter().skip(LABELS.len()));
    for (column, cell) in cells.filter(|(_, cell)| !cell.is_empty()) {
        if let Some(column) = column {
            golden.take(&case, time, column, cell)?;
        }
    }
    Ok(())
}
