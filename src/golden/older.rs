//! Layouts 2 and 3 of golden files: a header in TOML, with tolerances, provenance and (3) inputs, and a table with all
//! norms. What is kept today is taken of them.

use crate::case::Case;
use crate::golden::file_text::{Column, HEADER_MARK, SPREAD_MARK, time_of};
use crate::golden::measure::UnknownMeasure;
use crate::golden::text_error::{CellError, GoldenTextError};
use crate::golden::{CaseMark, GoldenFile, Inputs};
use crate::study::inputs::unit_of;
use oedometer_problem::quantity::{Norm, Quantity};
use serde::Deserialize;
use serde_json::Value;
use std::sync::Arc;

/// What is read of a header.
#[derive(Deserialize)]
struct Header {
    schema: u32,
    study: String,
    reason: String,
    /// Inputs that all cases share; none in layout 2.
    #[serde(default)]
    inputs: Inputs,
}

/// The columns that say which case and time factor a row is of.
const LABELS: [&str; 2] = ["case", "T_v"];
/// What stands before the key of a column of inputs.
const INPUT_MARK: &str = "input ";

/// What a column of an older table holds.
enum Older<'a> {
    Kept(Column),
    Input(&'a str),
    /// Norms that nobody expects, and steps times points.
    Gone,
}

impl<'a> Older<'a> {
    fn of(title: &'a str) -> Result<Self, UnknownMeasure> {
        if let Some(key) = title.strip_prefix(INPUT_MARK) {
            return Ok(Self::Input(key));
        }
        if let Some(of) = title.strip_prefix(SPREAD_MARK) {
            return Ok(Self::Kept(Column::Spreads(of.parse()?)));
        }
        if title == "point updates" {
            return Ok(Self::Gone);
        }
        // An error has its norm between sample and reference.
        let words: Vec<&str> = title.split(' ').collect();
        let error = match words[..] {
            [quantity, sample, norm, reference] => Quantity::named(quantity)
                .zip(Norm::named(norm))
                .map(|(kind, norm)| (kind.first_norm() == norm, [quantity, sample, reference].join(" "))),
            _ => None,
        };
        Ok(match error {
            Some((false, _)) => Self::Gone,
            Some((true, title)) => Self::Kept(Column::Values(title.parse()?)),
            None => Self::Kept(Column::Values(title.parse()?)),
        })
    }
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
    let columns: Result<Vec<Older<'_>>, _> = titles.iter().skip(LABELS.len()).map(Older::of).collect();
    let columns = columns?;
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        take_row(&mut golden, &header.inputs, &columns, &record)
            .map_err(|source| GoldenTextError::Row { line, source })?;
    }
    Ok(golden)
}

fn take_row(
    golden: &mut GoldenFile,
    shared: &Inputs,
    columns: &[Older<'_>],
    record: &csv::StringRecord,
) -> Result<(), CellError> {
    let (case, time): (Arc<str>, _) = (record[0].into(), time_of(&record[1])?);
    let first = if shared.is_empty() { CaseMark::Unknown } else { CaseMark::Inputs(shared.clone()) };
    golden.cases.entry(case.clone()).or_insert(first);
    let cells = columns.iter().zip(record.iter().skip(LABELS.len()));
    for (column, cell) in cells.filter(|(_, cell)| !cell.is_empty()) {
        match column {
            Older::Kept(column) => golden.take(&case, time, column, cell)?,
            Older::Input(key) => {
                if let Some(CaseMark::Inputs(inputs)) = golden.cases.get_mut(&case) {
                    inputs.insert((*key).to_owned(), cell.to_owned());
                }
            }
            Older::Gone => {}
        }
    }
    Ok(())
}

/// The inputs of a case as layout 3 has them: numbers with their unit, what solves it by its name.
pub(super) fn inputs_of(case: &Case) -> Inputs {
    fn flatten(prefix: &str, value: Value, inputs: &mut Inputs) {
        let key = prefix.rsplit('.').next().unwrap_or(prefix);
        let text = match value {
            Value::Null => return,
            Value::Object(table) => {
                for (key, value) in table {
                    // The tables whose keys a sweep takes by their own name.
                    let is_plain = ["", "column", "material", "settings"].contains(&prefix);
                    let key = if is_plain { key } else { format!("{prefix}.{key}") };
                    flatten(&key, value, inputs);
                }
                return;
            }
            Value::String(word) => word,
            Value::Number(number) if number.is_f64() => {
                let number = crate::golden::inputs::shortest(number.as_f64().unwrap_or(f64::NAN));
                unit_of(key).map_or(number.clone(), |unit| format!("{number} {unit}"))
            }
            other => other.to_string(),
        };
        inputs.insert(prefix.to_owned(), text);
    }
    let mut inputs = Inputs::new();
    if let Ok(Value::Object(mut table)) = serde_json::to_value(case) {
        for (key, value) in [("method", case.method.to_string()), ("time_step", case.time_step.to_string())] {
            table.insert(key.to_owned(), value.into());
        }
        flatten("", Value::Object(table), &mut inputs);
    }
    inputs
}
