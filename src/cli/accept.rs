//! `oedometer accept`: the present values of a study become its golden values.

use super::check::run_quietly;
use super::destination::is_on;
use super::exit::{Ended, Exit};
use super::run::{jobs_of, load};
use super::stream::say;
use crate::golden::{GoldenFile, spread_by_group, values_of};
use crate::record::Provenance;
use crate::study::{LastDigit, Study};
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

/// Runs the CI tier, as it is and with last digits changed, and writes values and tolerances.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.reason.trim().is_empty() {
        return Err(Ended::usage("a golden value needs a reason: --reason \"why the new values are right\""));
    }
    refuse_without_origin()?;
    let reason = arguments.reason.trim();
    let studies = load(&arguments.studies)?;
    if arguments.references {
        keep(&GoldenFile::of_references(reason)?, arguments)?;
    }
    let records = run_quietly(&studies, jobs_of(arguments.jobs))?;
    let mut perturbed = Vec::new();
    for digit in LastDigit::ALL {
        let studies: Vec<Study> = studies.iter().map(|study| study.perturbed(digit)).collect();
        perturbed.push(run_quietly(&studies, jobs_of(arguments.jobs))?);
    }
    for (number, study) in studies.iter().enumerate() {
        let golden = GoldenFile::of(&study.name, &records[number], reason);
        let others: Vec<_> = perturbed.iter().map(|records| values_of(&records[number])).collect();
        let spread = spread_by_group(&golden.values, &others);
        keep(&golden.with_spread(spread), arguments)?;
    }
    Ok(Exit::Pass)
}

/// Refuses to write golden files in CI, and from sources that no commit has.
///
/// # Errors
/// A sentence that says which.
pub fn refuse_without_origin() -> anyhow::Result<()> {
    if is_on("CI") {
        return Err(Ended::usage(
            "golden values are never taken in CI: look at them first, on your own machine",
        ));
    }
    if Provenance::of_this_program().dirty {
        return Err(Ended::usage(
            "the sources differ from their commit: commit and build first, so that golden values have an origin",
        ));
    }
    Ok(())
}

fn keep(golden: &GoldenFile, arguments: &Arguments) -> anyhow::Result<()> {
    let path = golden.write(&arguments.golden)?;
    say!("{}: {} values in {}", golden.study, golden.values.len(), path.display());
    Ok(())
}
