//! `oedometer records`: what a store of results holds, and single records out of it.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::json_of;
use crate::cli::stream::{print_data, print_with, say};
use crate::record::csv::long_tables::LongTable;
use crate::record::store::RecordStore;
use std::io::Write;
use std::path::PathBuf;

/// Columns of the list.
const COLUMNS: [&str; 8] =
    ["case", "status", "method", "integrator", "cells", "node", "cpu_seconds", "sources"];

/// Arguments of `records`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Folder of a study's results, like out/terzaghi-mesh
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Cases to print as JSON: hashes, or the first digits of them; a list of all where none is named
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
    hashes.retain(|hash| {
        arguments.cases.is_empty() || arguments.cases.iter().any(|first| hash.starts_with(first.as_str()))
    });
    if hashes.is_empty() {
        let reason = format!("{} has no such record", folder.display());
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    let long = LongTable::ALL.into_iter().zip([arguments.profiles, arguments.history]);
    if let Some((table, _)) = long.into_iter().find(|(_, is_wanted)| *is_wanted) {
        print_with(|out| {
            out.write_all(table.header_line().as_bytes())?;
            for record in hashes.iter().filter_map(|hash| store.read(hash)) {
                table.write_rows(&mut *out, &record)?;
            }
            Ok(())
        })?;
    } else if arguments.cases.is_empty() {
        print_with(|out| list(out, &store, &hashes))?;
    } else {
        for record in hashes.iter().filter_map(|hash| store.read(hash)) {
            print_data(&json_of(&record)?)?;
        }
    }
    Ok(Exit::Pass)
}

fn list(out: &mut dyn Write, store: &RecordStore, hashes: &[String]) -> std::io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    for record in hashes.iter().filter_map(|hash| store.read(hash)) {
        let sample = record.wall.first();
        let node = sample.and_then(|sample| sample.machine.as_ref()).map(|machine| machine.node.as_str());
        let seconds = sample.and_then(|sample| sample.cpu_seconds);
        writer.write_record([
            &record.hash,
            &record.status.name(),
            &record.case.method.to_string(),
            record.case.integrator.name(),
            &record.case.cells.to_string(),
            node.unwrap_or_default(),
            &seconds.map_or(String::new(), |seconds| format!("{seconds:e}")),
            &record.provenance.sources,
        ])?;
    }
    writer.flush()
}
