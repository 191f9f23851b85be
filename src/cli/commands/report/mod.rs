//! `oedometer report`: run what is missing, render everything.

mod files;
mod machine;

use crate::campaign::run_options::RunOptions;
use crate::campaign::run_report::RunReport;
use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::commands::check::GOLDEN;
use crate::cli::commands::run::{DEFAULT_RESULTS, jobs_of, load_or_shipped, run_and_store};
use crate::cli::exit::{Ended, Exit};
use crate::cli::stream::say;
use crate::cli::study_files;
use crate::cli::study_tables::Beside;
use crate::golden::GoldenFile;
use crate::golden::compare::Difference;
use crate::judge::study_check::StudyCheck;
use crate::record::Record;
use crate::record::store::RecordStore;
use crate::render::answers::making::Making;
use crate::render::report::StudyResults;
use crate::study::check::Study;
use std::collections::HashSet;
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files or names of shipped studies; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Folder of the records
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    records: PathBuf,
    /// Folder of the golden values that the records are held against
    #[arg(long, value_name = "DIR", default_value = GOLDEN)]
    golden: PathBuf,
    /// Run nothing: render the records that are there, whichever program made them
    #[arg(long, conflicts_with = "jobs")]
    from_records: bool,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
}

/// Runs, renders and writes the answer page (`index.html`, `README.md`) and a page a study in `studies/`, each with
/// its figures and tables as files.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let start = Instant::now();
    let studies = load_or_shipped(&arguments.studies)?;
    let reports =
        if arguments.from_records { kept(&studies, arguments)? } else { run_missing(&studies, arguments)? };
    let results: Vec<StudyResults<'_>> = studies
        .iter()
        .zip(&reports)
        .filter(|(_, report)| !report.records.is_empty())
        .map(|(study, report)| {
            let file = study_files::file_of(&study.name, &arguments.studies);
            StudyResults::new(study, &report.records, Tier::Full).from_file(file)
        })
        .collect();
    let making = Making {
        date: machine::today(),
        processor: machine::processor(),
        command: machine::command(),
        seconds: 0.0,
        cases_run: reports.iter().map(|report| report.records.len() - report.resumed).sum(),
    };
    let changes = changes(&studies, &reports, arguments);
    let written = files::write(&arguments.out, &results, changes.as_deref(), making, start)?;
    say!("the report is {}", written.display());
    let is_whole = reports.iter().all(|report| report.errors.is_empty());
    Ok(if is_whole { Exit::Pass } else { Exit::CaseFailed })
}

fn run_missing(studies: &[Study], arguments: &Arguments) -> anyhow::Result<Vec<RunReport>> {
    let options = RunOptions { resume: true, ..RunOptions::whole(Tier::Full, jobs_of(arguments.jobs)) };
    run_and_store(studies, studies, &options, &arguments.records, Beside::Nothing)
}

/// The records there are, as they are.
fn kept(studies: &[Study], arguments: &Arguments) -> anyhow::Result<Vec<RunReport>> {
    let of_study = |study: &Study| {
        let store = RecordStore::new(&arguments.records, &study.name);
        let records: Vec<Record> =
            study.cases(Tier::Full).into_iter().filter_map(|case| store.kept(case)).collect();
        RunReport { resumed: records.len(), records, ..RunReport::default() }
    };
    let reports: Vec<RunReport> = studies.iter().map(of_study).collect();
    if reports.iter().all(|report| report.records.is_empty()) {
        let reason = format!(
            "there is no record of these studies in {}: leave `--from-records` out, and `report` makes them",
            arguments.records.display()
        );
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    Ok(reports)
}

/// How the CI tier's values differ from the golden ones, each with the name of its study; none where no study has
/// golden values.
fn changes(
    studies: &[Study],
    reports: &[RunReport],
    arguments: &Arguments,
) -> Option<Vec<(String, Difference)>> {
    let mut held = false;
    let mut changes = Vec::new();
    for (study, report) in studies.iter().zip(reports) {
        let Ok(golden) = GoldenFile::read_or_embedded(&arguments.golden, &study.name) else { continue };
        held = true;
        let of_tier: HashSet<String> = study.cases(Tier::Ci).into_iter().map(Case::hash).collect();
        let is_of_tier = |record: &&Record| of_tier.contains(&record.hash);
        let records: Vec<Record> = report.records.iter().filter(is_of_tier).cloned().collect();
        if !records.is_empty() {
            let check = StudyCheck::new(study, &records, Tier::Ci, Ok(golden));
            changes.extend(check.differences().iter().map(|one| (study.name.clone(), one.clone())));
        }
    }
    held.then_some(changes)
}
