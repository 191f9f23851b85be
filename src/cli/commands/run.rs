//! `oedometer run`: the cases of study files, their records and one tidy CSV a study.

use crate::campaign::run_options::{RunOptions, Selected, Shard};
use crate::campaign::run_report::{RunError, RunReport};
use crate::campaign::runner::run_studies;
use crate::campaign::timing::time_study;
use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::progress::StudyBar;
use crate::cli::stream::say;
use crate::cli::study_files;
use crate::foreign::reading::mapping_of;
use crate::judge::absent::Absent;
use crate::record::Record;
use crate::record::long_tables::{columns_csv, history_csv, profiles_csv};
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::record::table_file::TableForm;
use crate::record::tidy::tidy_csv;
use crate::study::check::Study;
use crate::study::check::checker::Purpose;
use crate::study::file::StudySource;
use crate::study::shipped::shipped_studies;
use crate::wording::count_of;
use clap::ValueEnum;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Folder of results where none is named.
pub const DEFAULT_RESULTS: &str = "out";

/// How much of a study, at the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TierArgument {
    /// Seconds
    Smoke,
    /// What a CI runs
    Ci,
    /// Everything
    Full,
}

impl From<TierArgument> for Tier {
    fn from(argument: TierArgument) -> Self {
        match argument {
            TierArgument::Smoke => Self::Smoke,
            TierArgument::Ci => Self::Ci,
            TierArgument::Full => Self::Full,
        }
    }
}

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Study files, or names of shipped studies
    #[arg(required = true, value_name = "STUDY.toml")]
    studies: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    out: PathBuf,
    /// Cases at the same time; all cores where not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// How much of each study
    #[arg(long, value_enum, default_value_t = TierArgument::Full)]
    tier: TierArgument,
    /// Only this share of the cases, like 2/3
    #[arg(long, value_name = "i/n")]
    shard: Option<String>,
    /// Only the case with this hash, or the first digits of it
    #[arg(long, value_name = "HASH", conflicts_with_all = ["tier", "shard"])]
    case: Option<String>,
    /// Take up finished records of this version and these sources, whatever build of them made them
    #[arg(long)]
    resume: bool,
    /// Write the tables compressed, as STUDY.csv.gz: pandas reads them by the same call
    #[arg(long)]
    compress: bool,
}

/// Runs and keeps.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    // Every file is judged before any work begins.
    let studies = load(&arguments.studies)?;
    if arguments.case.as_ref().is_some_and(|hash| hash.trim().is_empty()) {
        return Err(Ended::usage(
            "`--case` names no case: write a hash or its first digits, as `plan` lists them",
        ));
    }
    let options = RunOptions {
        jobs: jobs_of(arguments.jobs),
        tier: arguments.tier.into(),
        shard: arguments.shard.as_deref().map(shard_of).transpose()?,
        resume: arguments.resume,
    };
    let selected: Vec<Study> = studies
        .iter()
        .map(|study| arguments.case.as_ref().map_or_else(|| study.clone(), |hash| with_case(study, hash)))
        .collect();
    let form = if arguments.compress { TableForm::Compressed } else { TableForm::Plain };
    let beside = Beside::Tables(form);
    let mut exit = Exit::NothingSelected;
    for (study, report) in
        studies.iter().zip(run_and_store(&studies, &selected, &options, &arguments.out, beside)?)
    {
        if !report.records.is_empty() && exit == Exit::NothingSelected {
            exit = Exit::Pass;
        }
        let is_unforeseen = |record: &Record| !(record.status.is_skipped() || study.foresees(record));
        if !report.errors.is_empty() || report.failed().any(is_unforeseen) {
            exit = Exit::CaseFailed;
        }
    }
    if exit == Exit::NothingSelected {
        return Err(Ended::with(
            exit,
            match &arguments.case {
                Some(hash) => {
                    format!("no case has a hash that begins with `{hash}`: `oedometer plan` lists them")
                }
                None => "no case belongs to this tier and shard".to_owned(),
            },
        ));
    }
    Ok(exit)
}

/// The study with only the cases whose hash begins so.
fn with_case(study: &Study, hash: &str) -> Study {
    let mut selected = study.clone();
    selected.planned.retain(|planned| planned.case.hash().starts_with(hash));
    selected
}

/// What is written beside the tidy table of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Nothing.
    Nothing,
    /// Tables of profiles, of settlement over time, and of what every column means; all in a form.
    Tables(TableForm),
}

/// Runs the selected cases of studies side by side, then times alone those of the studies that ask
/// for it, and writes a CSV a study; one report a study. A case without a record is told of, and the others
/// go on.
///
/// # Errors
/// When a result cannot be kept.
pub fn run_and_store(
    studies: &[Study],
    selected: &[Study],
    options: &RunOptions,
    results: &Path,
    beside: Beside,
) -> anyhow::Result<Vec<RunReport>> {
    let stores: Vec<RecordStore> =
        studies.iter().map(|study| RecordStore::new(results, &study.name)).collect();
    let kept = selected.iter().zip(&stores).map(|(study, store)| Selected { study, store: Some(store) });
    let name = match studies {
        [study] => study.name.clone(),
        _ => count_of(studies.len(), "study", "studies"),
    };
    let bar = StudyBar::new(&name);
    let tell = |progress| bar.tell(progress);
    let mut reports = run_studies(&kept.collect::<Vec<_>>(), options, &tell);
    if let Some(error) = reports.iter_mut().find_map(first_that_ends_all) {
        bar.finish();
        return Err(error.into());
    }
    for ((study, store), report) in selected.iter().zip(&stores).zip(&mut reports) {
        time_study(study, &mut report.records, Some(store), &tell)?;
    }
    bar.finish();
    for ((study, store), report) in studies.iter().zip(&stores).zip(&reports) {
        for error in &report.errors {
            say!("{}: {error}", study.name);
        }
        if !report.records.is_empty() {
            tell_of(study, report, &write_table(study, store, &report.records, beside)?);
        }
    }
    Ok(reports)
}

/// The first error that is no case's own: nothing can be kept any more.
fn first_that_ends_all(report: &mut RunReport) -> Option<RunError> {
    let place = report.errors.iter().position(|error| error.of_case().is_none())?;
    Some(report.errors.swap_remove(place))
}

fn tell_of(study: &Study, report: &RunReport, table: &Path) {
    say!(
        "{}: {} ({} from disk, {} failed), {}",
        study.name,
        count_of(report.records.len() + report.errors.len(), "case", "cases"),
        report.resumed,
        report.failed().count() + report.errors.len(),
        table.display()
    );
    for warning in Absent::among(&report.records).warnings() {
        say!("{}: {warning}", study.name);
    }
    if report.of_another_program > 0 {
        say!(
            "{}: {} of another version or of other sources {} run again",
            study.name,
            count_of(report.of_another_program, "record", "records"),
            if report.of_another_program == 1 {
                "was not taken up; its case was"
            } else {
                "were not taken up; their cases were"
            }
        );
    }
    if let Some(differences) = report.origins.differences_from(&Provenance::of_this_program()) {
        say!(
            "{}: records of other builds of these sources were taken up, their values are the same: {differences}",
            study.name
        );
    }
}

/// Writes the CSV of every record that a store keeps of a study, whichever run made it: a run of
/// one tier or shard takes nothing away from what others found. Those that are at hand are not
/// read again.
pub fn write_table(
    study: &Study,
    store: &RecordStore,
    at_hand: &[Record],
    beside: Beside,
) -> anyhow::Result<PathBuf> {
    let at_hand: HashMap<&str, &Record> =
        at_hand.iter().map(|record| (record.hash.as_str(), record)).collect();
    let record_of = |case: &Case| match at_hand.get(case.hash().as_str()) {
        Some(record) => Some(Cow::Borrowed(*record)),
        None => store.kept(case).map(Cow::Owned),
    };
    let records: Vec<Cow<'_, Record>> = study.cases(Tier::Full).into_iter().filter_map(record_of).collect();
    let own = Provenance::of_this_program().sources;
    let foreign = records.iter().filter(|record| record.provenance.sources != own).count();
    if foreign > 0 {
        say!(
            "{}: {} of other sources",
            study.name,
            count_of(foreign, "older record in the table is", "older records in the table are")
        );
    }
    let whole = tidy_csv(&study.name, records.iter().map(AsRef::as_ref))?;
    let Beside::Tables(form) = beside else {
        return Ok(TableForm::Plain.write(store.folder(), &study.name, &whole)?);
    };
    for (name, text) in [
        ("profiles", profiles_csv(records.iter().map(AsRef::as_ref))?),
        ("history", history_csv(records.iter().map(AsRef::as_ref))?),
    ] {
        form.write(store.folder(), name, &text)?;
    }
    TableForm::Plain.write(store.folder(), "columns", &columns_csv()?)?;
    Ok(form.write(store.folder(), &study.name, &whole)?)
}

/// Reads and checks study files.
pub fn load(paths: &[PathBuf]) -> anyhow::Result<Vec<Study>> {
    let sources = study_files::read_all(paths)?;
    sources.iter().map(|source| checked(source, Purpose::Solving)).collect()
}

/// A study that can run; what is odd about it goes to standard error.
pub fn checked(source: &StudySource, purpose: Purpose) -> anyhow::Result<Study> {
    let study = Study::check_for(source, purpose)?;
    for solver in &study.solvers {
        mapping_of(solver, study.scene.has_plane_fields())
            .map_err(|error| Ended::usage(error.to_string()))?;
    }
    for warning in &study.warnings {
        say!("{warning}");
    }
    Ok(study)
}

/// The named studies, or every shipped one where none is named.
pub fn load_or_shipped(paths: &[PathBuf]) -> anyhow::Result<Vec<Study>> {
    if paths.is_empty() {
        shipped_studies().iter().map(|source| Ok(Study::check(source)?)).collect()
    } else {
        load(paths)
    }
}

/// Cases at the same time: what was asked for, or one a core.
pub fn jobs_of(asked: Option<u64>) -> usize {
    asked
        .and_then(|jobs| usize::try_from(jobs).ok())
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get))
}

fn shard_of(typed: &str) -> anyhow::Result<Shard> {
    let parts =
        typed.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
    match parts {
        Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count }),
        _ => Err(Ended::usage(format!("`--shard {typed}` is no share: write i/n with 1 ≤ i ≤ n, like 2/3"))),
    }
}
