//! `oedometer plan`: which cases there are, with their hashes and times, before anything runs.

use crate::campaign::run_report::LongestCase;
use crate::case::work_estimate::{estimated_seconds, estimated_updates};
use crate::cli::calibrate;
use crate::cli::commands::run::{TierArgument, jobs_of, load_or_shipped};
use crate::cli::exit::Exit;
use crate::cli::output::{csv_of, json_of};
use crate::cli::stream::{print_data, say};
use crate::cli::time_notes::{note_on_longest, side_by_side};
use crate::foreign::case_file::CaseFile;
use crate::record::whole_file::write_whole;
use crate::study::check::Study;
use crate::wording::{count_of, duration};
use std::path::PathBuf;

/// Columns of the plan.
const COLUMNS: [&str; 5] = ["study", "case", "estimated_point_updates", "label", "estimated_seconds"];

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files or names of shipped studies; every shipped one where none is named
    #[arg(value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// How much of each study
    #[arg(long, value_enum, default_value_t = TierArgument::Full)]
    tier: TierArgument,
    /// Measure on this machine what a step of each kind costs, beside the constants of the estimates
    #[arg(long, conflicts_with_all = ["studies", "tier"])]
    calibrate: bool,
    /// Output format: one line a case, or the case files that attached solvers are given
    #[arg(long, value_enum, default_value_t = PlanFormat::Csv)]
    format: PlanFormat,
    /// Write the case file of each case into this folder, as HASH/case.json
    #[arg(long, value_name = "DIR")]
    case_files: Option<PathBuf>,
}

/// How the plan is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum PlanFormat {
    /// A line a case
    Csv,
    /// The case files in one list
    Json,
}

/// Prints one line a case as CSV, or the case files as JSON; what it adds up to goes to standard error.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.calibrate {
        return calibrate::run();
    }
    // Every file is judged before anything is printed.
    let studies = load_or_shipped(&arguments.studies)?;
    let mut rows = Vec::new();
    let mut files = Vec::new();
    for study in &studies {
        for case in study.cases(arguments.tier.into()) {
            if arguments.case_files.is_some() || arguments.format == PlanFormat::Json {
                files.push(CaseFile::of(case));
            }
            rows.push(vec![
                study.name.clone(),
                case.hash(),
                estimated_updates(case).to_string(),
                case.label(),
                format!("{:.1e}", estimated_seconds(case)),
            ]);
        }
    }
    let exit = if rows.is_empty() { Exit::NothingSelected } else { Exit::Pass };
    for (folder, file) in
        arguments.case_files.iter().flat_map(|folder| files.iter().map(move |file| (folder, file)))
    {
        write_whole(&folder.join(&file.case).join("case.json"), file.text()?.as_bytes())?;
    }
    match arguments.format {
        PlanFormat::Csv => print_data(&csv_of(COLUMNS, rows)?)?,
        PlanFormat::Json => print_data(&json_of(&files)?)?,
    }
    tell_of_time(&studies, arguments.tier);
    Ok(exit)
}

/// Says what the cases take in all, and of each study what takes too long.
fn tell_of_time(studies: &[Study], tier: TierArgument) {
    let (mut cases, mut total, mut longest) = (0, 0.0, 0.0);
    for study in studies {
        let mut slowest: Option<LongestCase> = None;
        let mut most = 0.0;
        for case in study.cases(tier.into()) {
            let seconds = estimated_seconds(case);
            (cases, total) = (cases + 1, total + seconds);
            if seconds > most {
                most = seconds;
                let (study, case_seconds) = (study.name.clone(), study.case_seconds);
                slowest = Some(LongestCase { study, case: case.clone(), case_seconds });
            }
        }
        longest = f64::max(longest, most);
        if let Some(note) = slowest.as_ref().and_then(note_on_longest) {
            say!("{note}");
        }
    }
    if cases > 0 {
        let jobs = jobs_of(None);
        say!(
            "{}: about {} on one core, {} on the {jobs} here, the longest case {}",
            count_of(cases, "case", "cases"),
            duration(total),
            duration(side_by_side(total, longest, jobs)),
            duration(longest)
        );
    }
}
