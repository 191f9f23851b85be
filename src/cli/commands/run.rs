//! `oedometer run`: runs the cases of study files and writes their records and one tidy CSV per study.

use crate::campaign::runner::{RunOptions, Tally};
use crate::campaign::shares::{Parting, Shard};
use crate::campaign::stop;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::help::EXPERT;
use crate::cli::output::say;
use crate::cli::place::{DEFAULT_RESULTS, StudyArguments};
use crate::cli::running::{jobs_of, run_and_store};
use crate::cli::slurm;
use crate::cli::study_files::load;
use crate::cli::trust::{self, TrustArguments};
use crate::record::csv::TableForm;
use crate::study::check::Study;
use clap::ValueEnum;
use std::path::PathBuf;

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Results folder
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    out: PathBuf,
    /// Number of cases that run in parallel [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Test level of the cases
    #[arg(long, alias = "test-level", value_enum, default_value_t = Tier::Full)]
    tier: Tier,
    /// Run only this shard of the cases, like 2/3
    #[arg(long, value_name = "i/n", help_heading = EXPERT)]
    shard: Option<String>,
    /// Divide the cases by estimated time, the longest first, instead of by hash
    #[arg(long, requires = "shard", help_heading = EXPERT)]
    balance: bool,
    /// Run only the case whose hash begins with these digits
    #[arg(long, value_name = "HASH", conflicts_with_all = ["tier", "shard"])]
    case: Option<String>,
    /// Reuse finished records of the same version and sources, from any build
    #[arg(long, help_heading = EXPERT)]
    resume: bool,
    /// With `--resume`: also reuse results of attached solvers that cannot be shown to come from the present program
    #[arg(long, requires = "resume")]
    keep_unproven: bool,
    /// Write compressed tables, STUDY.csv.gz (pandas reads them)
    #[arg(long, help_heading = EXPERT)]
    compress: bool,
    /// Run the cases by a scheduler instead of on this machine
    #[arg(long, value_enum, conflicts_with_all = ["case", "shard", "jobs"], help_heading = EXPERT)]
    engine: Option<Engine>,
    #[command(flatten)]
    trust: TrustArguments,
    #[command(flatten, next_help_heading = EXPERT)]
    cluster: slurm::ClusterArguments,
}

/// Who runs cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// Submit an array of shards and a merge, and follow both
    Slurm,
}

/// Runs and keeps.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    // Every file is judged before any work begins.
    let chosen = arguments.studies.chosen()?;
    let mut studies = load(&chosen, None)?;
    if arguments.engine == Some(Engine::Slurm) {
        arguments.trust.mark_all(&mut studies, &chosen)?;
        return slurm::run(
            &arguments.cluster,
            &chosen,
            &studies,
            arguments.tier,
            &arguments.out,
            arguments.keep_unproven,
        );
    }
    if arguments.case.as_ref().is_some_and(|hash| hash.trim().is_empty()) {
        return Err(Ended::usage("`--case` needs a hash or its first digits, as listed by `plan`"));
    }
    let parting = if arguments.balance { Parting::Cost } else { Parting::Hash };
    let options = RunOptions {
        shard: arguments.shard.as_deref().map(|typed| shard_of(typed, parting)).transpose()?,
        resume: arguments.resume,
        keep_unproven: arguments.keep_unproven,
        only_on_disk: true,
        ..RunOptions::whole(arguments.tier, jobs_of(arguments.jobs))
    };
    arguments.trust.mark(&mut studies, &chosen);
    stop::heed_signals()?;
    let with_one: Vec<Study>;
    let selected = match &arguments.case {
        Some(hash) => {
            with_one = studies.iter().map(|study| with_case(study, hash)).collect();
            &with_one
        }
        None => &studies,
    };
    let form = if arguments.compress { TableForm::Compressed } else { TableForm::Plain };
    let reports = run_and_store(&studies, selected, &options, &arguments.out, Some(form))?;
    let mut all = Tally::default();
    for report in &reports {
        all.join(report.tally);
    }
    if all.unforeseen > 0 || reports.iter().any(|report| !report.errors.is_empty()) {
        return Ok(trust::end_with(all, Exit::CaseFailed));
    }
    if all.left > 0 {
        return Ok(Exit::IncompleteMerge);
    }
    let is_in_tier = |study: &Study| !study.cases(options.tier).is_empty();
    match options.shard {
        // A share may be empty: what waits for all of them goes on.
        Some(Shard { index, count, .. }) if all.recorded == 0 && selected.iter().any(is_in_tier) => {
            say!("shard {index} of {count} has no case");
            Ok(Exit::Pass)
        }
        _ if all.recorded == 0 => Err(Ended::with(
            Exit::NothingSelected,
            match &arguments.case {
                Some(hash) => {
                    format!("no case has a hash that begins with `{hash}`: `oedometer plan` lists them")
                }
                None => "this test level and shard contain no case".to_owned(),
            },
        )),
        _ => Ok(trust::end_with(all, Exit::Pass)),
    }
}

/// The study with only the cases whose hash begins so.
fn with_case(study: &Study, hash: &str) -> Study {
    let mut selected = study.clone();
    selected.planned.retain(|planned| planned.case.hash().starts_with(hash));
    selected
}

/// A share as it is typed, `i/n`.
pub fn shard_of(typed: &str, parting: Parting) -> anyhow::Result<Shard> {
    let parts =
        typed.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
    match parts {
        Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count, parting }),
        _ => {
            Err(Ended::usage(format!("`--shard {typed}` is not a shard: write i/n with 1 ≤ i ≤ n, like 2/3")))
        }
    }
}
