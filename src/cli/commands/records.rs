//! `oedometer records`: lists the records of a folder of results, or prints single ones.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{json_of, print_data, print_with, say};
use crate::record::Record;
use crate::record::csv::long_tables::LongTable;
use crate::record::store::RecordStore;
use std::path::PathBuf;

/// A row of the list.
#[derive(serde::Serialize)]
struct Row {
    case: String,
    status: String,
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
    /// Folder of a study's results, like out/terzaghi-mesh
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Cases to print as JSON, by the first digits of their hashes [default: a list of all]
    #[arg(value_name = "HASH")]
    cases: Vec<String>,
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
                "there is no folder of a study's results {}",
                folder.display()
            )));
        }
    };
    for damage in store.damages() {
        say!("{damage}");
    }
    let mut hashes = store.hashes();
    hashes.retain(|hash| is_asked(hash, &arguments.cases));
    if hashes.is_empty() {
        let reason = format!("{} has no such record", folder.display());
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    let long = LongTable::ALL.into_iter().zip([arguments.profiles, arguments.history]);
    if let Some((table, _)) = long.into_iter().find(|(_, is_wanted)| *is_wanted) {
        print_with(|out| {
            out.write_all(table.header_line().as_bytes())?;
            for record in hashes.iter().filter_map(|hash| store.read(hash)) {
                out.write_all(table.rows_of(&record)?.as_bytes())?;
            }
            Ok(())
        })?;
    } else if arguments.cases.is_empty() {
        print_with(|out| {
            let mut writer = csv::Writer::from_writer(out);
            for record in hashes.iter().filter_map(|hash| store.read(hash)) {
                writer.serialize(Row::of(record))?;
            }
            writer.flush()
        })?;
    } else {
        for record in hashes.iter().filter_map(|hash| store.read(hash)) {
            print_data(&json_of(&record)?)?;
        }
    }
    Ok(Exit::Pass)
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
