//! `oedometer accept`: the present values of a study become its golden values.

use super::check::run_quietly;
use super::exit::{Ended, Exit};
use super::run::{jobs_of, load};
use crate::golden::GoldenFile;
use crate::record::Provenance;
use std::path::PathBuf;

/// Arguments of `accept`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files
    #[arg(required_unless_present = "references", value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Take the present values of the exact solutions too
    #[arg(long)]
    references: bool,
    /// Why the new values are right
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of the golden values
    #[arg(long, value_name = "DIR", default_value = super::check::GOLDEN)]
    golden: PathBuf,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
}

/// Runs the CI tier and writes the golden files.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.reason.trim().is_empty() {
        return Err(Ended::usage("a golden value needs a reason: --reason \"why the new values are right\""));
    }
    if std::env::var_os("CI").is_some() {
        return Err(Ended::usage(
            "golden values are never taken in CI: look at them first, on your own machine",
        ));
    }
    if Provenance::of_this_program().dirty {
        return Err(Ended::usage(
            "the sources differ from their commit: commit and build first, so that golden values have an origin",
        ));
    }
    let reason = arguments.reason.trim();
    let studies = load(&arguments.studies)?;
    if arguments.references {
        keep(&GoldenFile::of_references(reason)?, arguments)?;
    }
    let records = run_quietly(&studies, jobs_of(arguments.jobs))?;
    for (study, records) in studies.iter().zip(&records) {
        keep(&GoldenFile::of(&study.name, records, reason), arguments)?;
    }
    Ok(Exit::Pass)
}

fn keep(golden: &GoldenFile, arguments: &Arguments) -> anyhow::Result<()> {
    let path = golden.write(&arguments.golden)?;
    eprintln!("{}: {} values in {}", golden.study, golden.values.len(), path.display());
    Ok(())
}
