//! `oedometer check`: the CI tier again, judged by its expectations and by its golden values.

use super::exit::{Ended, Exit};
use super::output::{TableFormat, coloured};
use super::progress::StudyBar;
use super::run::{jobs_of, load_or_shipped};
use crate::assess::study_check::{CaseNote, CheckEnd, StudyCheck};
use crate::assess::summary::Judgement;
use crate::golden::{CaseChange, Difference, GoldenFile, REFERENCES};
use crate::record::{Record, write_whole};
use crate::render::annotations::annotations_of;
use crate::render::{junit, verdicts};
use crate::study::{RunOptions, RunReport, Selected, Study, Tier, run_studies};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Folder of the golden values.
pub const GOLDEN: &str = "golden";

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files; every shipped one and the exact solutions where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder of the golden values
    #[arg(long, value_name = "DIR", default_value = GOLDEN)]
    golden: PathBuf,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Hold the exact solutions against their golden values too; done by itself where no study is named
    #[arg(long)]
    references: bool,
    /// Write a `JUnit` report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Append a summary in Markdown; $`GITHUB_STEP_SUMMARY` where that is set
    #[arg(long, value_name = "FILE", env = "GITHUB_STEP_SUMMARY", hide_env = true)]
    summary: Option<PathBuf>,
    /// Annotate the lines of the studies on standard error, as GitHub reads it; done by itself in its
    /// workflows
    #[arg(long, env = "GITHUB_ACTIONS", hide_env = true)]
    annotate: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    format: TableFormat,
}

/// Runs, judges, compares and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let studies = load_or_shipped(&arguments.studies)?;
    let checks = checks_of(arguments, &studies)?;
    if checks.is_empty() {
        return Err(Ended::with(Exit::NothingSelected, "no study has a case in the CI tier"));
    }
    print(&checks, arguments.format)?;
    if let Some(path) = &arguments.junit {
        write_whole(path, junit::report_of(&checks)?.as_bytes())?;
    }
    if let Some(path) = &arguments.summary {
        append(path, &verdicts::markdown_of(&checks)?)?;
    }
    if arguments.annotate {
        for line in annotations_of(&checks, |study| file_of(study, &arguments.studies)) {
            eprintln!("{line}");
        }
    }
    Ok(checks.iter().map(|check| exit_of(check.end())).fold(Exit::Pass, worse))
}

/// The studies that have cases in the CI tier, and the exact solutions where they are wanted.
fn checks_of(arguments: &Arguments, studies: &[Study]) -> anyhow::Result<Vec<StudyCheck>> {
    let read = |name: &str| GoldenFile::read(&arguments.golden, name);
    let mut checks = Vec::new();
    if arguments.references || arguments.studies.is_empty() {
        checks.push(StudyCheck::of_references(read(REFERENCES))?);
    }
    for (study, report) in studies.iter().zip(&run_all(studies, jobs_of(arguments.jobs))) {
        if !(report.records.is_empty() && report.errors.is_empty()) {
            let check = StudyCheck::new(study, &report.records, Tier::Ci, read(&study.name));
            checks.push(check.with_errors(&report.errors));
        }
    }
    Ok(checks)
}

/// Runs the CI tier of studies and keeps nothing; the records of each study.
///
/// # Errors
/// When a case has no record.
pub fn run_quietly(studies: &[Study], jobs: usize) -> anyhow::Result<Vec<Vec<Record>>> {
    let of_study = |(study, report): (&Study, RunReport)| match report.errors.into_iter().next() {
        Some(error) => Err(anyhow::Error::from(error).context(study.name.clone())),
        None => Ok(report.records),
    };
    studies.iter().zip(run_all(studies, jobs)).map(of_study).collect()
}

/// The same with what went wrong in each study.
fn run_all(studies: &[Study], jobs: usize) -> Vec<RunReport> {
    let name = match studies {
        [study] => study.name.as_str(),
        _ => "check",
    };
    let bar = StudyBar::new(name);
    let selected: Vec<Selected<'_>> = studies.iter().map(|study| Selected { study, store: None }).collect();
    let options = RunOptions::whole(Tier::Ci, jobs);
    let reports = run_studies(&selected, &options, &|progress| bar.tell(progress));
    bar.finish();
    reports
}

fn exit_of(end: CheckEnd) -> Exit {
    match end {
        CheckEnd::Pass => Exit::Pass,
        CheckEnd::Failed => Exit::VerdictFailed,
        CheckEnd::CaseFailed => Exit::CaseFailed,
        CheckEnd::Golden => Exit::Golden,
    }
}

/// The worse of two ends, in the order verdict, case, golden, pass.
fn worse(a: Exit, b: Exit) -> Exit {
    const RANK: [Exit; 4] = [Exit::VerdictFailed, Exit::CaseFailed, Exit::Golden, Exit::Pass];
    let rank = |exit: Exit| RANK.iter().position(|one| *one == exit).unwrap_or(RANK.len());
    if rank(b) < rank(a) { b } else { a }
}

/// What the JSON of `check` has of a study.
#[derive(serde::Serialize)]
struct CheckJson<'a> {
    study: &'a str,
    end: CheckEnd,
    judgements: &'a [Judgement],
    failed_cases: &'a [CaseNote],
    unsound_records: &'a [CaseNote],
    golden_values_that_agree: usize,
    golden_problem: Option<String>,
    differences: &'a [Difference],
    accuracy_and_cost: &'a [CaseChange],
    warnings: &'a [String],
}

fn print(checks: &[StudyCheck], format: TableFormat) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match format {
        TableFormat::Table => {
            for check in checks {
                write!(out, "{}", coloured(&verdicts::text_of(check)?))?;
            }
        }
        TableFormat::Markdown => write!(out, "{}", verdicts::markdown_of(checks)?)?,
        TableFormat::Csv => write!(out, "{}", verdicts::all_judgements(checks).to_csv()?)?,
        TableFormat::Json => {
            let all: Vec<CheckJson<'_>> = checks.iter().map(CheckJson::of).collect();
            writeln!(out, "{}", serde_json::to_string_pretty(&all)?)?;
        }
    }
    Ok(())
}

impl<'a> CheckJson<'a> {
    fn of(check: &'a StudyCheck) -> Self {
        Self {
            study: &check.study,
            end: check.end(),
            judgements: &check.judgements,
            failed_cases: &check.failed_cases,
            unsound_records: &check.unsound,
            golden_values_that_agree: check.agreeing,
            golden_problem: check.golden.as_ref().err().map(ToString::to_string),
            differences: check.differences(),
            accuracy_and_cost: &check.changes,
            warnings: &check.warnings,
        }
    }
}

/// The file that a study came from, as a repository knows it.
fn file_of(study: &str, named: &[PathBuf]) -> Option<String> {
    if study == REFERENCES {
        return None;
    }
    let stem = |path: &PathBuf| path.file_stem().is_some_and(|stem| stem.to_string_lossy() == study);
    let named = named.iter().find(|path| stem(path)).map(|path| path.display().to_string());
    Some(named.unwrap_or_else(|| format!("studies/{study}.toml")))
}

fn append(path: &Path, text: &str) -> anyhow::Result<()> {
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).map_err(|error| {
        Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display()))
    })?;
    file.write_all(text.as_bytes())?;
    Ok(())
}
