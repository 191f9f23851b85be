//! `oedometer records`: lists the records of a folder of results, or prints them whole.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, print_tables, print_with, say};
use crate::record::Record;
use crate::record::csv::long_tables::LongTable;
use crate::record::printed::PrintedRecord;
use crate::record::store::RecordStore;
use crate::render::table::{Align, Cell, Table, TableColumn};
use std::io::{self, Write};
use std::path::PathBuf;

/// A row of the list.
#[derive(serde::Serialize)]
struct Row {
    case: String,
    status: &'static str,
    method: String,
    integrator: &'static str,
    cells: usize,
    node: Option<String>,
    processor: Option<String>,
    cpu_seconds: Option<f64>,
    sources: String,
    compiler: String,
}

impl Row {
    fn of(record: Record) -> Self {
        let sample = record.wall.into_iter().next().unwrap_or_default();
        let (node, processor) = sample.machine.map(|machine| (machine.node, machine.processor)).unzip();
        Self {
            case: record.hash,
            status: record.status.name(),
            method: record.case.method.to_string(),
            integrator: record.case.integrator.name(),
            cells: record.case.cells,
            node,
            processor,
            cpu_seconds: sample.cpu_seconds,
            sources: record.provenance.sources,
            compiler: record.provenance.compiler,
        }
    }
}

/// Arguments of `records`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Results folder of a study, like out/terzaghi-mesh
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Cases to print, by the first digits of their hashes [default: all]
    #[arg(value_name = "HASH")]
    cases: Vec<String>,
    /// Output format: a list of cases; `json` prints their whole records [default: csv for all cases, json for named
    /// ones]
    #[arg(long, value_enum, conflicts_with_all = ["profiles", "history"])]
    format: Option<TableFormat>,
    /// Print the fields over the height of every case as CSV
    #[arg(long, conflicts_with_all = ["cases", "history"])]
    profiles: bool,
    /// Print the settlement over time of every case as CSV
    #[arg(long, conflicts_with = "cases")]
    history: bool,
}

/// Prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let folder = &arguments.folder;
    let store = match (folder.parent(), folder.file_name()) {
        (Some(results), Some(study)) if folder.is_dir() => {
            RecordStore::new(results, &study.to_string_lossy())
        }
        _ => {
            return Err(Ended::usage(format!(
                "there is no results folder of a study at {}",
                folder.display()
            )));
        }
    };
    for sentence in store.passed_over() {
        say!("{sentence}");
    }
    let mut hashes = store.hashes();
    hashes.retain(|hash| is_asked(hash, &arguments.cases));
    if hashes.is_empty() {
        let reason = format!("{} has no such record", folder.display());
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    let records = hashes.iter().filter_map(|hash| store.read(hash));
    let long = LongTable::ALL.into_iter().zip([arguments.profiles, arguments.history]);
    let default = if arguments.cases.is_empty() { TableFormat::Csv } else { TableFormat::Json };
    if let Some((table, _)) = long.into_iter().find(|(_, is_wanted)| *is_wanted) {
        print_with(|out| write_long(out, table, records))?;
    } else {
        match arguments.format.unwrap_or(default) {
            TableFormat::Json => print_with(|out| write_json(out, records, arguments.cases.is_empty()))?,
            TableFormat::Csv => print_with(|out| write_list(out, records))?,
            format => print_tables(&[table_of(records)?], format)?,
        }
    }
    Ok(Exit::Pass)
}

/// Writes a table with rows of every record, one record after the other: a million of them take no memory.
fn write_long(
    out: &mut dyn Write,
    table: LongTable,
    records: impl Iterator<Item = Record>,
) -> io::Result<()> {
    out.write_all(table.header_line().as_bytes())?;
    for record in records {
        out.write_all(table.rows_of(&record)?.as_bytes())?;
    }
    Ok(())
}

/// Writes whole records as JSON, one behind the other or as an array.
fn write_json(out: &mut dyn Write, records: impl Iterator<Item = Record>, is_array: bool) -> io::Result<()> {
    let [begin, between, end] = if is_array { ["[\n", ",\n", "\n]\n"] } else { ["", "\n", "\n"] };
    out.write_all(begin.as_bytes())?;
    for (place, record) in records.enumerate() {
        out.write_all(if place > 0 { between } else { "" }.as_bytes())?;
        serde_json::to_writer_pretty(&mut *out, &PrintedRecord::of(&record))?;
    }
    out.write_all(end.as_bytes())
}

/// Writes the list as CSV.
fn write_list(out: &mut dyn Write, records: impl Iterator<Item = Record>) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    for record in records {
        writer.serialize(Row::of(record))?;
    }
    writer.flush()
}

/// The list as a table for people.
fn table_of(records: impl Iterator<Item = Record>) -> anyhow::Result<Table> {
    let mut text = Vec::new();
    write_list(&mut text, records)?;
    let mut reader = csv::Reader::from_reader(text.as_slice());
    let is_number = |header: &str| ["cells", "cpu_seconds"].contains(&header);
    let column = |header: &str| TableColumn {
        align: if is_number(header) { Align::Right } else { Align::Left },
        ..TableColumn::text(header)
    };
    let columns = reader.headers()?.iter().map(column).collect();
    let row = |row: csv::Result<csv::StringRecord>| {
        Ok(row?.iter().map(|field| Cell::Text(field.to_owned())).collect())
    };
    let rows = reader.records().map(row).collect::<csv::Result<_>>()?;
    Ok(Table { columns, rows, ..Table::default() })
}

/// Whether a record is asked for by the first digits of its hash; where none are given, all are.
fn is_asked(hash: &str, first_digits: &[String]) -> bool {
    first_digits.is_empty() || first_digits.iter().any(|first| hash.starts_with(first.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_any_of_the_digits_are_shown() {
        let asked = |digits: &[&str]| -> Vec<&str> {
            let digits: Vec<String> = digits.iter().map(|one| (*one).to_owned()).collect();
            ["aa1", "ab2", "ba3"].into_iter().filter(|hash| is_asked(hash, &digits)).collect()
        };
        assert_eq!(asked(&[]), ["aa1", "ab2", "ba3"]);
        assert_eq!(asked(&["a"]), ["aa1", "ab2"]);
        assert_eq!(asked(&["ba", "aa1"]), ["aa1", "ba3"]);
        assert!(asked(&["1"]).is_empty());
    }

    #[test]
    fn a_row_of_the_list_has_what_its_columns_say() {
        use crate::record::WallSample;
        use crate::record::provenance::Machine;

        let mut record = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        )
        .remove(0);
        record.hash = "abc".to_owned();
        record.provenance.sources = "of".to_owned();
        record.provenance.compiler = "rustc".to_owned();
        let row = |record: &Record| {
            let mut writer = csv::Writer::from_writer(Vec::new());
            writer.serialize(Row::of(record.clone())).expect("a row");
            String::from_utf8(writer.into_inner().expect("memory")).expect("words")
        };
        let header = "case,status,method,integrator,cells,node,processor,cpu_seconds,sources,compiler\n";
        let sample = |name: &str, cpu_seconds| WallSample {
            machine: Some(Machine { node: format!("{name} node"), processor: format!("{name} processor") }),
            cpu_seconds,
            ..WallSample::default()
        };
        record.wall = vec![sample("first", Some(2.5)), sample("last", Some(3.5))];
        let first = "abc,ok,MPM,implicit,3,first node,first processor,2.5,of,rustc\n";
        assert_eq!(row(&record), format!("{header}{first}"));
        record.wall.clear();
        assert_eq!(row(&record), format!("{header}abc,ok,MPM,implicit,3,,,,of,rustc\n"));
    }
}
