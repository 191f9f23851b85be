//! `oedometer check`: the CI tier again, judged by its expectations and by its golden values.

use super::exit::{Ended, Exit};
use super::progress::StudyBar;
use super::run::{jobs_of, load_or_shipped};
use crate::assess::study_check::StudyCheck;
use crate::golden::{Change, GoldenFile};
use crate::record::{Record, write_whole};
use crate::render::{junit, verdicts};
use crate::study::{RunOptions, Study, Tier, run_study};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Folder of the golden values.
pub const GOLDEN: &str = "golden";

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder of the golden values
    #[arg(long, value_name = "DIR", default_value = GOLDEN)]
    golden: PathBuf,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Write a `JUnit` report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Append a summary in Markdown, as for $`GITHUB_STEP_SUMMARY`
    #[arg(long, value_name = "FILE")]
    summary: Option<PathBuf>,
}

/// Runs, judges, compares and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let studies = load_or_shipped(&arguments.studies)?;
    let mut exit = Exit::NothingSelected;
    let mut checks = Vec::new();
    let mut out = std::io::stdout().lock();
    for study in &studies {
        let records = run_quietly(study, jobs_of(arguments.jobs))?;
        if records.is_empty() {
            continue;
        }
        let check =
            StudyCheck::new(study, &records, Tier::Ci, GoldenFile::read(&arguments.golden, &study.name));
        write!(out, "{}", verdicts::text_of(&check)?)?;
        exit = worse(exit, exit_of(&check));
        checks.push(check);
    }
    if let Some(path) = &arguments.junit {
        write_whole(path, junit::report_of(&checks)?.as_bytes())?;
    }
    if let Some(path) = &arguments.summary {
        append(path, &verdicts::markdown_of(&checks)?)?;
    }
    if exit == Exit::NothingSelected {
        return Err(Ended::with(exit, "no study has a case in the CI tier"));
    }
    Ok(exit)
}

/// Runs the CI tier of a study and keeps nothing.
///
/// # Errors
/// When a case cannot be set up.
pub fn run_quietly(study: &Study, jobs: usize) -> anyhow::Result<Vec<Record>> {
    let options = RunOptions { jobs, tier: Tier::Ci, shard: None, resume: false };
    let bar = StudyBar::new(&study.name);
    let mut report = run_study(study, &options, None, &|progress| bar.tell(progress));
    bar.finish();
    match report.errors.pop() {
        Some(error) => Err(error.into()),
        None => Ok(report.records),
    }
}

/// How a study came out, the worst first: a verdict or a value that moved, a failed case, a
/// golden that is missing or stale.
fn exit_of(check: &StudyCheck) -> Exit {
    let moved = check.differences().iter().any(|one| one.change == Change::Moved);
    if moved || check.judgements.iter().any(|judgement| !judgement.verdict.pass) {
        Exit::VerdictFailed
    } else if !check.failed_cases.is_empty() {
        Exit::CaseFailed
    } else if check.golden.is_err() || !check.differences().is_empty() {
        Exit::Golden
    } else {
        Exit::Pass
    }
}

/// The worse of two ends, in the order verdict, case, golden, pass, nothing.
fn worse(a: Exit, b: Exit) -> Exit {
    const RANK: [Exit; 4] = [Exit::VerdictFailed, Exit::CaseFailed, Exit::Golden, Exit::Pass];
    let rank = |exit: Exit| RANK.iter().position(|one| *one == exit).unwrap_or(RANK.len());
    if rank(b) < rank(a) { b } else { a }
}

fn append(path: &Path, text: &str) -> anyhow::Result<()> {
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).map_err(|error| {
        Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display()))
    })?;
    file.write_all(text.as_bytes())?;
    Ok(())
}
