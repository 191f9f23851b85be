//! `oedometer history`: golden values over the commits that changed them; nothing is run.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{TableFormat, json_of, print_data, print_tables, say};
use crate::cli::place::repository_with;
use crate::history::timeline::timelines;
use crate::report::history_tables::{timeline_summary, timeline_table};
use oedometer_wording::first_few;
use std::path::PathBuf;

/// Files that cannot be read, named before the rest is counted.
const MOST_NOTES: usize = 3;

/// Arguments of `history`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Names of studies [default: all with golden values, one row each]
    #[arg(value_name = "STUDY")]
    studies: Vec<String>,
    /// Folder of the golden values in the repository [default: `golden` here or above]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Output format; csv and json have every commit of every study
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Reads the history and prints it.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let (repository, folder) = repository_with(arguments.golden.as_deref(), &arguments.studies)?;
    if repository.is_shallow() {
        say!(
            "the clone is shallow: commits before its first one are not shown; `git fetch --unshallow` fetches them"
        );
    }
    let (lines, notes) = timelines(&repository, &folder, &arguments.studies)
        .map_err(|error| Ended::usage(error.to_string()))?;
    for note in first_few(notes, MOST_NOTES) {
        say!("{note}");
    }
    if lines.is_empty() {
        let what = format!("no commit has golden values of these studies in {folder}/");
        return Err(Ended::with(Exit::NothingSelected, what));
    }
    match arguments.format {
        TableFormat::Json => print_data(&json_of(&lines)?)?,
        TableFormat::Table | TableFormat::Markdown if arguments.studies.is_empty() => {
            print_tables(&[timeline_summary(&lines)], arguments.format)?;
        }
        format => print_tables(&[timeline_table(&lines)], format)?,
    }
    Ok(Exit::Pass)
}
