//! `oedometer plan`: lists cases with hashes and estimated times, missing cases, and the commands of shares.

use crate::campaign::runner::LongestCase;
use crate::campaign::shares::Parting;
use crate::case::Case;
use crate::case::planned::Tier;
use crate::case::work_estimate::estimated_updates;
use crate::cli::exit::{Ended, Exit};
use crate::cli::help::EXPERT;
use crate::cli::job_list::{JobList, missing_of};
use crate::cli::output::{TableFormat, json_of, of_device, print_data, print_tables, print_with, say};
use crate::cli::place::{DEFAULT_RESULTS, StudyArguments};
use crate::cli::progress::{note_on_longest, side_by_side};
use crate::cli::running::jobs_of;
use crate::cli::study_files::load;
use crate::foreign::case_file::CaseFile;
use crate::record::atomic_file::write_atomically;
use crate::render::table::{Cell, Table, columns};
use crate::study::check::Study;
use oedometer_wording::{count_of, duration};
use std::io::{self, IsTerminal};
use std::path::PathBuf;

/// Columns of the plan.
const COLUMNS: [&str; 5] = ["study", "case", "estimated_point_updates", "label", "estimated_seconds"];

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Test level of the cases
    #[arg(long, alias = "test-level", value_enum, default_value_t = Tier::Full)]
    tier: Tier,
    /// List only cases without a finished record in this results folder
    #[arg(long, value_name = "DIR")]
    missing: Option<PathBuf>,
    /// Print a job list instead: divide the cases into this many shards, and print a command for each shard with missing
    /// cases
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000), help_heading = EXPERT)]
    tasks: Option<u64>,
    /// Divide the cases by estimated time, the longest first, instead of by hash
    #[arg(long, requires = "tasks", help_heading = EXPERT)]
    balance: bool,
    /// Add `--keep-unproven` to the commands: reuse results of attached solvers that cannot be shown to come from the
    /// present program
    #[arg(long, requires = "tasks")]
    keep_unproven: bool,
    /// Results folder of the commands [default: that of `--missing`]
    #[arg(long, value_name = "DIR", requires = "tasks")]
    out: Option<PathBuf>,
    /// Output format: a table, one line per case, or the case files that attached solvers get [default: a table on
    /// terminals, else one line per case]
    #[arg(long, value_enum)]
    format: Option<PlanFormat>,
    /// Write the case file of each case into this folder, as HASH/case.json
    #[arg(long, value_name = "DIR", help_heading = EXPERT)]
    case_files: Option<PathBuf>,
}

/// How the plan is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum PlanFormat {
    /// For people
    Table,
    /// One line per case
    Csv,
    /// The case files that attached solvers receive
    Json,
}

/// Prints one line per case as CSV, the case files as JSON, or a job list; totals go to standard error.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    // Every file is checked before anything is printed.
    let chosen = arguments.studies.chosen()?;
    let studies = load(&chosen, None)?;
    let tier = arguments.tier;
    if let Some(folder) = arguments.missing.as_ref().filter(|folder| !folder.is_dir()) {
        return Err(Ended::usage(format!("there is no results folder {}", folder.display())));
    }
    let all: Vec<(&Study, Vec<&Case>)> = studies.iter().map(|study| (study, study.cases(tier))).collect();
    let wanted: Vec<(&Study, Vec<&Case>)> = match &arguments.missing {
        Some(folder) => all.iter().map(|(study, cases)| (*study, missing_of(study, cases, folder))).collect(),
        None => all.clone(),
    };
    let count: usize = wanted.iter().map(|(_, cases)| cases.len()).sum();
    if let Some(tasks) = arguments.tasks {
        let results = arguments.out.clone().or(arguments.missing.clone());
        let list = JobList {
            files: chosen,
            results: results.unwrap_or_else(|| DEFAULT_RESULTS.into()),
            tier,
            tasks,
            allow_solvers: false,
            keep_unproven: arguments.keep_unproven,
            parting: if arguments.balance { Parting::Cost } else { Parting::Hash },
        };
        list.tell_of_balance(&all);
        print_data(&list.commands(&all, &wanted))?;
    } else {
        let is_terminal = io::stdout().is_terminal();
        match arguments.format.unwrap_or(if is_terminal { PlanFormat::Table } else { PlanFormat::Csv }) {
            PlanFormat::Table => print_tables(&[plan_table(&wanted)], TableFormat::Table)?,
            PlanFormat::Csv => print_with(|out| write_plan(out, &wanted))?,
            PlanFormat::Json => print_data(&json_of(&case_files_of(&wanted))?)?,
        }
    }
    if let Some(folder) = &arguments.case_files {
        for file in case_files_of(&wanted) {
            write_atomically(&folder.join(&file.case).join("case.json"), file.text()?.as_bytes())?;
        }
    }
    if count == 0 && arguments.missing.is_some() {
        say!("no case is missing");
        return Ok(Exit::Pass);
    }
    tell_of_time(&wanted);
    Ok(if count == 0 { Exit::NothingSelected } else { Exit::Pass })
}

/// What the commands of studies are given of each case.
fn case_files_of(studies: &[(&Study, Vec<&Case>)]) -> Vec<CaseFile> {
    studies.iter().flat_map(|(_, cases)| cases).map(|case| CaseFile::of(case)).collect()
}

/// Cases of a table before the rest is only counted.
const MOST_CASES: usize = 200;

/// The cases of studies with their estimated times.
fn plan_table(studies: &[(&Study, Vec<&Case>)]) -> Table {
    let row = |study: &Study, case: &Case| {
        let seconds = study.estimated_seconds(case);
        vec![Cell::Code(study.name.clone()), case.label().into(), duration(seconds).into()]
    };
    let rows = studies.iter().flat_map(|(study, cases)| cases.iter().map(move |case| row(study, case)));
    Table::of("", columns("study | case | > about"), rows).shown(MOST_CASES)
}

/// Writes the plan as it goes, so that a million cases take no memory.
fn write_plan(out: &mut dyn std::io::Write, studies: &[(&Study, Vec<&Case>)]) -> std::io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS).map_err(of_device)?;
    for (study, cases) in studies {
        for case in cases {
            let seconds = format!("{:.1e}", study.estimated_seconds(case));
            let updates = estimated_updates(case).to_string();
            let row = [&study.name, &case.hash(), &updates, &case.label(), &seconds];
            writer.write_record(row).map_err(of_device)?;
        }
    }
    writer.flush()
}

/// Says what the cases take in all, and of each study what takes too long.
fn tell_of_time(studies: &[(&Study, Vec<&Case>)]) {
    for (study, cases) in studies {
        let by_time =
            |a: &&&Case, b: &&&Case| study.estimated_seconds(a).total_cmp(&study.estimated_seconds(b));
        // The first of those that take as long.
        let Some(slowest) = cases.iter().rev().max_by(by_time) else { continue };
        let (study, case, case_seconds) = (study.name.clone(), (*slowest).clone(), study.case_seconds);
        if let Some(note) = note_on_longest(&LongestCase { study, case, case_seconds }) {
            say!("{note}");
        }
    }
    let (count, total, longest) = seconds_of(studies);
    if count > 0 {
        let jobs = jobs_of(None);
        say!(
            "{}: about {} on one core, {} on the {jobs} here, the longest case {}",
            count_of(count, "case", "cases"),
            duration(total),
            duration(side_by_side(total, longest, jobs)),
            duration(longest)
        );
    }
}

/// Number of cases, and the estimated seconds of all of them together and of the longest.
fn seconds_of(studies: &[(&Study, Vec<&Case>)]) -> (usize, f64, f64) {
    let seconds = |(study, cases): &(&Study, Vec<&Case>)| -> Vec<f64> {
        cases.iter().map(|case| study.estimated_seconds(case)).collect()
    };
    let all = studies.iter().flat_map(seconds);
    all.fold((0, 0.0, 0.0), |(count, total, longest), seconds| {
        (count + 1, total + seconds, f64::max(longest, seconds))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::work_estimate::estimated_seconds;
    use crate::study::file::StudySource;

    #[test]
    fn the_longest_case_is_that_of_all_studies_wherever_it_stands() {
        let study = |cells: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                 integrator = ['explicit']\ncells = [{cells}]\n"
            );
            Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound")
        };
        let mut studies = [study("4"), study("64, 8"), study("2, 16")];
        let of = |studies: &[Study]| {
            let all: Vec<(&Study, Vec<&Case>)> =
                studies.iter().map(|study| (study, study.cases(Tier::Full))).collect();
            seconds_of(&all)
        };
        let cases: Vec<Case> = studies.iter().flat_map(|study| study.cases(Tier::Full)).cloned().collect();
        let seconds: Vec<f64> = cases.iter().map(estimated_seconds).collect();
        for _ in 0..3 {
            let (count, total, longest) = of(&studies);
            assert_eq!((count, longest), (5, seconds[1]));
            assert!((total / seconds.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            studies.rotate_left(1);
        }
    }
}
