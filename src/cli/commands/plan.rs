//! `oedometer plan`: which cases there are, with their hashes, before anything runs.

use crate::campaign::work_estimate::estimated_updates;
use crate::cli::commands::run::{TierArgument, load_or_shipped};
use crate::cli::exit::Exit;
use crate::cli::output::csv_of;
use crate::cli::stream::print_data;
use std::path::PathBuf;

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// How much of each study
    #[arg(long, value_enum, default_value_t = TierArgument::Full)]
    tier: TierArgument,
}

/// Prints one line a case as CSV.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    // Every file is judged before anything is printed.
    let studies = load_or_shipped(&arguments.studies)?;
    let rows: Vec<Vec<String>> = studies
        .iter()
        .flat_map(|study| study.cases(arguments.tier.into()).into_iter().map(move |case| (study, case)))
        .map(|(study, case)| {
            vec![study.name.clone(), case.hash(), estimated_updates(case).to_string(), case.label()]
        })
        .collect();
    let exit = if rows.is_empty() { Exit::NothingSelected } else { Exit::Pass };
    print_data(&csv_of(["study", "case", "estimated_point_updates", "label"], rows)?)?;
    Ok(exit)
}
