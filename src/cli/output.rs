//! Output formats: tables, CSV and JSON; colour on terminals only.

use crate::cli::stream::{print_as_it_is, print_data};
use crate::render::escape::{csv_field, document};
use crate::render::table::Table;
use clap::ValueEnum;
use std::io::IsTerminal;

/// How a table is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// For people
    Table,
    /// For GitHub
    Markdown,
    /// For programs, numbers with all digits
    Csv,
    /// For programs, everything
    Json,
}

/// Prints tables separated by empty lines; JSON as an array with a list of rows per table.
pub fn print_tables(tables: &[Table], format: TableFormat) -> anyhow::Result<()> {
    let write = match format {
        TableFormat::Table => Table::to_text,
        TableFormat::Markdown => Table::to_markdown,
        TableFormat::Csv => Table::to_csv,
        TableFormat::Json => {
            return print_data(&json_of(&tables.iter().map(rows_of).collect::<anyhow::Result<Vec<_>>>()?)?);
        }
    };
    let text = tables.iter().map(write).collect::<Result<Vec<_>, _>>()?.join("\n");
    if format == TableFormat::Table { print_coloured(&text) } else { print_data(&text) }
}

/// A CSV of a header and rows.
pub fn csv_of<F: AsRef<[u8]>>(
    header: impl IntoIterator<Item = F>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in rows {
        writer.write_record(row.iter().map(|field| csv_field(field).into_owned()))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// A value as indented JSON with a line break at the end.
pub fn json_of(value: &impl serde::Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// The rows of a table by their headers, as in its CSV.
fn rows_of(table: &Table) -> anyhow::Result<Vec<serde_json::Map<String, serde_json::Value>>> {
    let text = table.to_plain_csv()?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers()?.clone();
    reader
        .records()
        .map(|record| {
            let record = record?;
            let fields = header.iter().zip(&record).map(|(name, field)| {
                let number = field.parse::<f64>().ok().filter(|number| number.is_finite());
                let value = number.map_or_else(|| field.into(), |number| serde_json::json!(number));
                (name.to_owned(), value)
            });
            Ok(fields.collect())
        })
        .collect()
}

/// Prints text for people, the marks of verdicts in colour.
///
/// # Errors
/// When the device fails.
pub fn print_coloured(text: &str) -> anyhow::Result<()> {
    print_as_it_is(&coloured(&document(text)))
}

/// Colours the marks of verdicts if standard output is a terminal that wants it.
fn coloured(text: &str) -> String {
    if wants_colour(std::io::stdout().is_terminal(), |name| std::env::var(name).ok()) {
        text.replace('✓', "\x1b[32m✓\x1b[0m").replace('✗', "\x1b[31m✗\x1b[0m")
    } else {
        text.to_owned()
    }
}

/// Whether colours are wanted: on a terminal, unless `NO_COLOR` is set or the terminal is dumb.
fn wants_colour(is_terminal: bool, variable: impl Fn(&str) -> Option<String>) -> bool {
    is_terminal
        && variable("NO_COLOR").is_none_or(|value| value.is_empty())
        && variable("TERM").as_deref() != Some("dumb")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::table::{Cell, TableColumn};

    #[test]
    fn colours_are_for_terminals_that_want_them() {
        let none = |_: &str| None;
        assert!(wants_colour(true, none));
        assert!(!wants_colour(false, none));
        assert!(!wants_colour(true, |name| (name == "NO_COLOR").then(|| "1".to_owned())));
        assert!(wants_colour(true, |name| (name == "NO_COLOR").then(String::new)));
        assert!(!wants_colour(true, |name| (name == "TERM").then(|| "dumb".to_owned())));
    }

    #[test]
    fn a_row_in_json_has_numbers_as_numbers_and_words_as_words() {
        let table = Table {
            rows: vec![vec!["GIMP".into(), Cell::Error(1.5e-3)], vec!["nan".into(), Cell::Error(f64::NAN)]],
            ..Table::of("t", vec![TableColumn::text("method"), TableColumn::number("error")], [])
        };
        let rows = rows_of(&table).expect("rows");
        assert_eq!(serde_json::to_string(&rows[0]).expect("JSON"), r#"{"error":0.0015,"method":"GIMP"}"#);
        assert!(rows[1]["error"].is_string(), "what is no number is written as such: {:?}", rows[1]);
    }
}
