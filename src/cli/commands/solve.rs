//! `oedometer solve`: one case from the command line, its errors on standard output.

use crate::campaign::case_run::{ThisProgram, all_cores};
use crate::campaign::endless::refuse_endless;
use crate::campaign::runner::LongestCase;
use crate::case::outcome::{Course, Solver};
use crate::case::planned::{PlannedCase, Tier};
use crate::case::{Case, Quantity};
use crate::cli::exit::{Ended, Exit};
use crate::cli::help::EXPERT;
use crate::cli::output::{SolveFormat, csv_of, json_of, print_data, say, table_width, terminal_width};
use crate::cli::progress::{RunningCase, note_on_solve};
use crate::cli::study_files::tell_warnings;
use crate::judge::study_results::StudyResults;
use crate::measure::record::record_of;
use crate::measure::soundness;
use crate::questions;
use crate::questions::finding::Place;
use crate::record::field_files::write_fields;
use crate::record::provenance::Provenance;
use crate::record::{Balance, ERROR_COLUMNS, ErrorRow, Groups, Record, ReferenceUse, StartChecks, Status};
use crate::report::check_page::{Terminal, text_of_answers};
use crate::report::tables::measures;
use crate::study::check::{Purpose, Study};
use crate::study::overrides::{Outputs, StudyLines, TIMING, step_rule, toml_of};
use oedometer_mpm::run::Kernel;
use oedometer_problem::outcome::{Counters, Failure, StepSizes};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Arguments of `solve`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Benchmark problem, like `terzaghi`
    scene: String,
    /// Method, as `list` names it
    #[arg(long, default_value = "GC-SRI-patch")]
    method: String,
    /// Time integrator [default: explicit; implicit if explicit would take minutes and no wave requires it]
    #[arg(long)]
    integrator: Option<String>,
    /// Cells over the height; several meshes, like 5,10,20, are compared
    #[arg(long, default_value = "10", value_delimiter = ',', allow_negative_numbers = true)]
    cells: Vec<i64>,
    /// Material points per cell and direction
    #[arg(long, default_value_t = 2, allow_negative_numbers = true)]
    points_per_cell: i64,
    /// Step rule: stable=0.8, courant=0.5, seconds=1e-6, growth=0.05 or tolerance=1e-4 [default:
    /// stable=0.8; semi-implicit: stable=0.1; implicit: growth=0.05]
    #[arg(long, value_name = "RULE")]
    time_step: Option<String>,
    #[command(flatten)]
    outputs: Outputs,
    /// Write the fields at every output for `ParaView`: VTU of the points, and a PVD that `score` reads back with the
    /// mapping beside it
    #[arg(long, value_name = "DIR")]
    fields: Option<PathBuf>,
    /// Use the point-wise step even where the assembled one gives the same result
    #[arg(long, help_heading = EXPERT)]
    point_wise: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t = SolveFormat::Table)]
    format: SolveFormat,
}

/// Solves and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let study = study_of(arguments)?;
    let kernel = if arguments.point_wise { Kernel::PointWise } else { Kernel::Fastest };
    refuse_endless(&study, Tier::Full)?;
    if let Some(folder) = &arguments.fields {
        can_write_fields(&study, folder)?;
    }
    tell_of_long(&study);
    let course = Course { threads: all_cores(), seconds: study.case_seconds, ..Course::alone() };
    let clock = RunningCase::new();
    let solved = |(place, planned): (usize, &PlannedCase)| {
        clock.tell(&planned.case.label(), place, study.planned.len());
        record_of(&planned.case, &study.references, ThisProgram { kernel }.solve(&planned.case, &course)?)
    };
    let records = study.planned.iter().enumerate().map(solved).collect::<Result<Vec<Record>, _>>();
    clock.finish();
    let records = records?;
    match records.as_slice() {
        [] => return Err(Ended::with(Exit::NothingSelected, "the command line describes no case")),
        [record] => print_run(record, arguments.format)?,
        _ => print_meshes(&study, &records, arguments.format)?,
    }
    if let Some(folder) = &arguments.fields {
        write_all_fields(&records, folder)?;
    }
    records.iter().try_fold(Exit::Pass, |_, record| end_of(record))
}

/// Makes the folder of the fields before anything is solved.
///
/// # Errors
/// A refusal where the water has points of its own, and those of the file system.
fn can_write_fields(study: &Study, folder: &Path) -> anyhow::Result<()> {
    if study.planned.iter().any(|planned| planned.case.column.points.has_two_sets()) {
        return Err(Ended::usage(
            "`--fields` writes the points of one set, but here the water has separate points: omit one of the two",
        ));
    }
    fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))
}

fn cannot_write(folder: &Path, error: &io::Error) -> anyhow::Error {
    Ended::usage(format!("`--fields`: {} cannot be written: {error}", folder.display()))
}

/// Writes the fields of every run: of several meshes each into a folder of its own.
///
/// # Errors
/// Those of the file system.
fn write_all_fields(records: &[Record], folder: &Path) -> anyhow::Result<()> {
    for record in records {
        let folder = match records {
            [_] => folder.to_owned(),
            _ => folder.join(format!("cells-{}", record.case.cells)),
        };
        let list = write_fields(record, &folder).map_err(|error| cannot_write(&folder, &error))?;
        say!("{}: {} states", list.display(), record.snapshots.len());
    }
    Ok(())
}

/// A run with its errors and checks.
fn print_run(record: &Record, format: SolveFormat) -> anyhow::Result<()> {
    match format {
        SolveFormat::Csv => print_data(&csv_of(ERROR_COLUMNS, csv_rows(record))?),
        SolveFormat::Json => print_data(&json_of(&SolveJson::of(record))?),
        SolveFormat::Table => print_data(&measures::table_of(record, table_width())?),
    }
}

/// Runs on several meshes: errors and rates, and what it takes to come within a bound.
fn print_meshes(study: &Study, records: &[Record], format: SolveFormat) -> anyhow::Result<()> {
    match format {
        SolveFormat::Csv => {
            let columns: Vec<&str> = std::iter::once("cells").chain(ERROR_COLUMNS).collect();
            let rows = records.iter().flat_map(|record| {
                let cells = record.case.cells.to_string();
                csv_rows(record).map(move |row| std::iter::once(cells.clone()).chain(row).collect::<Vec<_>>())
            });
            print_data(&csv_of(columns, rows)?)
        }
        SolveFormat::Json => print_data(&json_of(&records.iter().map(SolveJson::of).collect::<Vec<_>>())?),
        SolveFormat::Table => {
            let results = StudyResults::new(study, records, Tier::Full);
            let findings = questions::answers(&[results], Place::Terminal)?;
            let terminal = Terminal { width: terminal_width(), is_whole: false };
            print_data(&text_of_answers(&findings, terminal)?)
        }
    }
}

/// The errors of a run; of a footing the load itself is asked for, beside its error.
fn csv_rows(record: &Record) -> impl Iterator<Item = Vec<String>> + '_ {
    let is_footing = record.case.scene.measures(Quantity::LoadFactor);
    let loads = record.measures.iter().filter(move |_| is_footing).map(|row| row.csv_fields().to_vec());
    record.errors.iter().map(|row| row.csv_fields().to_vec()).chain(loads)
}

/// Warns of broken balances and bounds, and ends with a failure where the run did.
fn end_of(record: &Record) -> anyhow::Result<Exit> {
    for complaint in soundness::complaints(record).iter().filter(|_| record.status == Status::Ok) {
        say!("warning: {complaint}");
    }
    if let Status::Failed(failure) = &record.status {
        return Err(Ended::with(
            Exit::CaseFailed,
            format!(
                "the case failed ({}) at step {}, t = {:.6e} s, T_v = {:.4e}: {}",
                failure.kind.name(),
                failure.step,
                failure.time,
                failure.time / record.case.seconds_per_time_factor(),
                failure.reason
            ),
        ));
    }
    Ok(Exit::Pass)
}

/// Warns before a long run, with what takes less.
fn tell_of_long(study: &Study) {
    let Some(planned) = study.planned.first() else { return };
    let (study, case_seconds) = ("solve".to_owned(), study.case_seconds);
    let longest = LongestCase { study, case: planned.case.clone(), case_seconds };
    if let Some(note) = note_on_solve(&longest) {
        say!("{note}");
    }
}

/// The study of one case that the command line describes.
fn study_of(arguments: &Arguments) -> anyhow::Result<Study> {
    let mut lines = StudyLines::of("solve", &arguments.scene, "the scene's name")?;
    lines.give_outputs(&arguments.outputs)?;
    lines.refuse_without_effect(&[("task", "`oedometer stability` finds critical steps"), TIMING])?;
    for (key, option) in OWN_OPTIONS {
        if lines.has(key) || lines.has(&format!("sweep.{key}")) {
            return Err(Ended::usage(format!("`{key}` has a separate option: {option}")));
        }
    }
    let mut sweep = vec![
        format!("method = [{}]", toml_of(arguments.method.as_str())),
        format!("cells = {:?}", arguments.cells),
        format!("points_per_cell = [{}]", arguments.points_per_cell),
    ];
    if let Some(integrator) = &arguments.integrator {
        sweep.push(format!("integrator = [{}]", toml_of(integrator.as_str())));
    }
    if let Some(rule) = &arguments.time_step {
        sweep.push(format!("time_step = [{}]", step_rule(rule)?));
    }
    let study = lines.study(Purpose::Solving, sweep)?;
    tell_warnings(&study);
    Ok(study)
}

/// Keys of a sweep that `solve` takes as options.
const OWN_OPTIONS: [(&str, &str); 5] = [
    ("method", "--method NAME"),
    ("integrator", "--integrator NAME"),
    ("cells", "--cells NUMBER"),
    ("points_per_cell", "--points-per-cell NUMBER"),
    ("time_step", "--time-step RULE"),
];

/// The JSON of `solve`: the record without its snapshots, the essentials first.
#[derive(serde::Serialize)]
struct SolveJson<'a> {
    status: &'static str,
    #[serde(flatten)]
    counters: Counters,
    wall_seconds: Option<f64>,
    measures: &'a [ErrorRow],
    groups: Groups,
    start: Option<StartChecks>,
    balance: &'a [Balance],
    references: &'a [ReferenceUse],
    step_sizes: StepSizes,
    failure: Option<&'a Failure>,
    case: &'a Case,
    hash: &'a str,
    provenance: &'a Provenance,
}

impl<'a> SolveJson<'a> {
    fn of(record: &'a Record) -> Self {
        Self {
            status: record.status.name(),
            counters: record.counters,
            wall_seconds: record.wall.first().map(|sample| sample.seconds),
            measures: &record.errors,
            groups: record.groups,
            start: record.start,
            balance: &record.balance,
            references: &record.references,
            step_sizes: record.step_sizes,
            failure: record.status.failure(),
            case: &record.case,
            hash: &record.hash,
            provenance: &record.provenance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::WallSample;

    #[test]
    fn every_counter_of_the_json_is_that_of_its_name() {
        let mut record = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        )
        .remove(0);
        let counters = &mut record.counters;
        (counters.steps, counters.point_updates, counters.factorisations) = (3, 5, 7);
        (counters.iterations, counters.rejected_steps) = (11, 13);
        record.wall = [2.5, 0.5].map(|seconds| WallSample { seconds, ..WallSample::default() }).to_vec();
        let told = serde_json::to_value(SolveJson::of(&record)).expect("plain numbers");
        for (name, value) in [
            ("steps", 3.0),
            ("point_updates", 5.0),
            ("factorisations", 7.0),
            ("iterations", 11.0),
            ("rejected_steps", 13.0),
            ("wall_seconds", 2.5),
        ] {
            assert_eq!(told[name].as_f64(), Some(value), "{name}");
        }
    }
}
