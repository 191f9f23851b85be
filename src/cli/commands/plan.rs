//! `oedometer plan`: which cases there are, with their hashes, before anything runs.

use crate::campaign::work_estimate::estimated_updates;
use crate::cli::commands::run::{TierArgument, load_or_shipped};
use crate::cli::exit::Exit;
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
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["study", "case", "estimated_point_updates", "label"])?;
    let mut exit = Exit::NothingSelected;
    for study in studies {
        for case in study.cases(arguments.tier.into()) {
            exit = Exit::Pass;
            let updates = estimated_updates(case).to_string();
            writer.write_record([study.name.as_str(), &case.hash(), &updates, &case.label()])?;
        }
    }
    print_data(&String::from_utf8(writer.into_inner()?)?)?;
    Ok(exit)
}
