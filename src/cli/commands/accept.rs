//! `oedometer accept`: the present values of a study become its golden values.

use crate::case::planned::Tier;
use crate::cli::commands::check::run_quietly;
use crate::cli::commands::run::{jobs_of, load};
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{is_on, say};
use crate::cli::place::{golden_folder, named};
use crate::cli::trust::TrustArguments;
use crate::golden::tolerance::{LastDigit, spread_by_group};
use crate::golden::{GoldenFile, values_of};
use crate::judge::study_check::StudyCheck;
use crate::record::Record;
use crate::record::provenance::Provenance;
use crate::render::checks::verdicts::objections_of;
use crate::study::check::Study;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Arguments of `accept`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files, folders of them, or names of shipped studies
    #[arg(required = true, value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Take the values although expectations or cases of their study fail
    #[arg(long)]
    despite_failing: bool,
    /// Why the new values are right
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of the golden values [default: `golden` beside the study or above]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Cases at the same time [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    #[command(flatten)]
    trust: TrustArguments,
}

/// Runs the CI tier, as it is and with last digits changed, and writes values and tolerances.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.reason.trim().is_empty() {
        return Err(Ended::usage("a golden value needs a reason: --reason \"why the new values are right\""));
    }
    refuse_without_origin()?;
    let reason = arguments.reason.trim();
    let chosen = named(&arguments.studies)?;
    let mut studies = load(&chosen)?;
    arguments.trust.mark_all(&mut studies, &chosen)?;
    let records = run_quietly(&studies, jobs_of(arguments.jobs))?;
    refuse_failing(&studies, &records, arguments.despite_failing)?;
    let folder_of = |study: &str| golden_folder(arguments.golden.as_deref(), study, &chosen);
    let mut perturbed = Vec::new();
    for digit in LastDigit::ALL {
        let studies: Vec<Study> = studies.iter().map(|study| study.perturbed(digit)).collect();
        perturbed.push(run_quietly(&studies, jobs_of(arguments.jobs))?);
    }
    for (number, study) in studies.iter().enumerate() {
        let golden = GoldenFile::of(&study.name, &records[number], reason);
        let others: Vec<&[Record]> = perturbed.iter().map(|records| &records[number][..]).collect();
        let spread = spread_over(&golden, &others);
        keep(golden.widened_by(spread), &folder_of(&study.name))?;
    }
    Ok(Exit::Pass)
}

/// What the last digits of every input move.
fn spread_over(golden: &GoldenFile, others: &[&[Record]]) -> BTreeMap<String, f64> {
    let values: Vec<_> = others.iter().map(|records| values_of(records)).collect();
    spread_by_group(&golden.values, &values)
}

/// Says which expectations and cases fail, and refuses to take values of their studies unless told.
fn refuse_failing(studies: &[Study], records: &[Vec<Record>], despite: bool) -> anyhow::Result<()> {
    let mut fails = false;
    for (study, records) in studies.iter().zip(records) {
        let as_found = GoldenFile::of(&study.name, records, "as found");
        let check = StudyCheck::new(study, records, Tier::Ci, Ok(as_found));
        if let Some(objections) = objections_of(&check) {
            say!("{}", objections.trim_end());
            fails = true;
        }
    }
    if fails && !despite {
        return Err(Ended::with(
            Exit::VerdictFailed,
            "nothing is taken, for these fail: mend the code or the expectations first, or take the values all the \
             same with --despite-failing",
        ));
    }
    Ok(())
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

/// Writes golden values; those that agree with what is there stay as they are.
fn keep(golden: GoldenFile, folder: &Path) -> anyhow::Result<()> {
    let golden = match GoldenFile::read(folder, &golden.study) {
        Ok(older) => golden.keeping(&older),
        // What is missing or damaged is written anew.
        Err(_) => golden,
    };
    let path = golden.write(folder)?;
    say!("{}: {} values in {}", golden.study, golden.values.len(), path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::file::StudySource;

    #[test]
    fn values_of_a_study_whose_expectations_fail_are_taken_only_when_told() {
        let refused = |below: &str, despite: bool| {
            let text = format!(
                "title = \"short\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[[sweep]]\n\
                 method = [\"MPM\"]\nintegrator = [\"implicit\"]\ncells = [3, 6]\n\n[[expect]]\n\
                 time_factor = 0.1\nat = {{ cells = 6, below = {below} }}\n"
            );
            let source = StudySource { name: "short.toml".to_owned(), text };
            let studies = [Study::check(&source).expect("sound")];
            let records = run_quietly(&studies, 1).expect("records");
            refuse_failing(&studies, &records, despite).err()
        };
        let error = refused("1e-9", false).expect("it is refused");
        assert_eq!(Exit::of(&error), Exit::VerdictFailed);
        assert!(error.to_string().contains("--despite-failing"), "{error}");
        assert!(refused("1e-9", true).is_none(), "somebody said so");
        assert!(refused("0.5", false).is_none(), "nothing fails");
    }

    #[test]
    fn a_spread_is_the_largest_change_by_any_of_the_digits() {
        let records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        );
        let golden = GoldenFile::of("t", &records, "a reason");
        let moved = |change: f64| {
            let mut records = records.clone();
            records[0].errors[0].value += change;
            records
        };
        for changes in [[3e-6, 1e-6], [1e-6, 3e-6]] {
            let others = changes.map(moved);
            let spread = spread_over(&golden, &others.each_ref().map(Vec::as_slice));
            assert_eq!(spread.len(), 1);
            assert!(spread.values().all(|one| (one / 3e-6 - 1.0).abs() < 1e-6), "{changes:?}: {spread:?}");
        }
    }
}
