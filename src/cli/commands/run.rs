//! `oedometer run`: runs the cases of study files and writes their records and one tidy CSV per study.

use crate::campaign::case_runner::time_study;
use crate::campaign::runner::{RunError, RunOptions, RunReport, Selected, Tally, run_studies};
use crate::campaign::shares::{Parting, Shard};
use crate::campaign::stop;
use crate::campaign::taken_over::TakenOver;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::cli::place::StudyArguments;
use crate::cli::progress::StudyBar;
use crate::cli::study_files::{is_compressed, is_small, tell_of_passed_over, write_tables};
use crate::cli::trust::{self, TrustArguments};
use crate::cli::{slurm, study_files};
use crate::foreign::reading::mapping_of;
use crate::import::mapping::Axes;
use crate::judge::verdict::Absent;
use crate::record::csv::TableForm;
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::study::check::{Purpose, Study};
use crate::study::file::StudySource;
use clap::ValueEnum;
use oedometer_soil::wording::count_of;
use std::path::{Path, PathBuf};

/// Folder of results where none is named.
pub const DEFAULT_RESULTS: &str = "out";

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = DEFAULT_RESULTS)]
    out: PathBuf,
    /// Cases at the same time [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Tier of the cases
    #[arg(long, value_enum, default_value_t = Tier::Full)]
    tier: Tier,
    /// Only this share of the cases, like 2/3
    #[arg(long, value_name = "i/n")]
    shard: Option<String>,
    /// Divide the cases by estimated time, the longest first, instead of by hash
    #[arg(long, requires = "shard")]
    balance: bool,
    /// Only the case with this hash, or the first digits of it
    #[arg(long, value_name = "HASH", conflicts_with_all = ["tier", "shard"])]
    case: Option<String>,
    /// Reuse finished records of the same version and sources, from any build
    #[arg(long)]
    resume: bool,
    /// With `--resume`: also reuse results of attached solvers that cannot be shown to come from the present program
    #[arg(long, requires = "resume")]
    keep_unproven: bool,
    /// Write the tables as STUDY.csv.gz, which pandas reads too
    #[arg(long)]
    compress: bool,
    /// Run the cases with a scheduler instead of on this machine
    #[arg(long, value_enum, conflicts_with_all = ["case", "shard", "jobs"])]
    engine: Option<Engine>,
    #[command(flatten)]
    trust: TrustArguments,
    #[command(flatten)]
    cluster: slurm::ClusterArguments,
}

/// Who runs cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// Submit an array of shares and a merge, and follow both
    Slurm,
}

/// Runs and keeps.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    // Every file is judged before any work begins.
    let chosen = arguments.studies.chosen()?;
    let mut studies = load(&chosen)?;
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
        return Err(Ended::usage(
            "`--case` names no case: write a hash or its first digits, as `plan` lists them",
        ));
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
            say!("share {index} of {count} has no case");
            Ok(Exit::Pass)
        }
        _ if all.recorded == 0 => Err(Ended::with(
            Exit::NothingSelected,
            match &arguments.case {
                Some(hash) => {
                    format!("no case has a hash that begins with `{hash}`: `oedometer plan` lists them")
                }
                None => "no case belongs to this tier and shard".to_owned(),
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

/// Runs the selected cases of studies side by side, then times alone those of the studies that ask
/// for it, and writes the tables of a study where a form of them is given; one report a study. A case without a record is
/// told of, and the others go on.
///
/// # Errors
/// When a case would take longer than a week, or a result cannot be stored.
pub fn run_and_store(
    studies: &[Study],
    selected: &[Study],
    options: &RunOptions,
    results: &Path,
    tables: Option<TableForm>,
) -> anyhow::Result<Vec<RunReport>> {
    let store_of = |study: &Study| RecordStore::new(results, &study.name).naming(&study.cases(Tier::Full));
    let stores: Vec<RecordStore> = studies.iter().map(store_of).collect();
    for (study, store) in studies.iter().zip(&stores) {
        tell_of_passed_over(study, store);
    }
    // Records of small studies and of timed ones are held, for they are read again at once.
    let is_held = |study: &Study| is_small(study) || study.timing_repeats > 0 || !study.solvers.is_empty();
    let only_on_disk = options.only_on_disk && !studies.iter().any(is_held);
    let options = RunOptions { only_on_disk, ..options.clone() };
    let kept = selected.iter().zip(&stores).map(|(study, store)| Selected {
        study,
        store: Some(store),
        is_kept: true,
    });
    let name = match studies {
        [study] => study.name.clone(),
        _ => count_of(studies.len(), "study", "studies"),
    };
    let bar = StudyBar::new(&name);
    let tell = |progress| bar.tell(progress);
    let mut reports = run_studies(&kept.collect::<Vec<_>>(), &options, &tell);
    if let Some(error) = reports.iter_mut().find_map(first_that_ends_all) {
        bar.finish();
        return Err(error.into());
    }
    for ((study, store), report) in selected.iter().zip(&stores).zip(&mut reports) {
        time_study(study, &mut report.records, Some(store), &tell)?;
    }
    bar.finish();
    for (((study, chosen), store), report) in studies.iter().zip(selected).zip(&stores).zip(&reports) {
        for error in &report.errors {
            say!("{}: {error}", study.name);
        }
        if report.tally.left > 0 {
            let left = count_of(report.tally.left, "case was", "cases were");
            say!(
                "{}: {left} not run, because the run was interrupted: `--resume` continues with them",
                study.name
            );
        }
        if report.tally.recorded == 0 {
            continue;
        }
        store.note_named_cases()?;
        // The table of many shares is made once, by `merge`, and so is a large one where a case is run again.
        let is_share = options.shard.is_some_and(|shard| shard.count > 1);
        let is_one_of_many = chosen.planned.len() < study.planned.len() && is_compressed(study);
        let is_left = (is_share && !is_small(study)) || is_one_of_many;
        let place = match tables.filter(|_| !is_left) {
            Some(form) => write_tables(study, store, &report.records, form)?,
            None => store.folder().to_owned(),
        };
        tell_of(study, report, &place);
    }
    Ok(reports)
}

/// The first error that no single case caused: no further result can be kept.
/// The first error of a report that is not about a single case.
pub(super) fn first_that_ends_all(report: &mut RunReport) -> Option<RunError> {
    let place = report.errors.iter().position(|error| error.of_case().is_none())?;
    Some(report.errors.swap_remove(place))
}

fn tell_of(study: &Study, report: &RunReport, table: &Path) {
    let skipped = match report.tally.skipped {
        0 => String::new(),
        skipped => format!(", {skipped} skipped"),
    };
    say!(
        "{}: {} ({} from disk, {} failed{skipped}), {}",
        study.name,
        count_of(report.tally.recorded + report.errors.len(), "case", "cases"),
        report.resumed,
        report.tally.failed + report.errors.len(),
        table.display()
    );
    for sentence in TakenOver::sentences(&report.taken_over) {
        say!("{}: {sentence}", study.name);
    }
    if report.unproven > 0 {
        say!(
            "{}: {} of attached solvers cannot be shown to come from the present programs, because the study \
             does not declare what identifies them (`reuse = \"version\"`): not reused; `--keep-unproven` \
             reuses such results",
            study.name,
            count_of(report.unproven, "finished result", "finished results"),
        );
    }
    for warning in Absent::among(&report.records).warnings() {
        say!("{}: {warning}", study.name);
    }
    if report.of_another_program > 0 {
        say!(
            "{}: {} of another version or of other sources {} run again",
            study.name,
            count_of(report.of_another_program, "record", "records"),
            if report.of_another_program == 1 {
                "was not reused; its case was"
            } else {
                "were not reused; their cases were"
            }
        );
    }
    if let Some(differences) = report.origins.differences_from(&Provenance::of_this_program()) {
        say!(
            "{}: records of other builds of these sources were reused, their values are the same: {differences}",
            study.name
        );
    }
}

/// Reads and checks study files; what is odd about them goes to standard error.
pub fn load(paths: &[PathBuf]) -> anyhow::Result<Vec<Study>> {
    let studies = checked(paths)?;
    studies.iter().for_each(tell_warnings);
    Ok(studies)
}

/// The same after a run: warnings about a study with results in a folder were printed then.
pub fn load_after_run(paths: &[PathBuf], results: &Path) -> anyhow::Result<Vec<Study>> {
    let studies = checked(paths)?;
    studies.iter().filter(|study| !results.join(&study.name).is_dir()).for_each(tell_warnings);
    Ok(studies)
}

/// Studies that can run, with the mappings of their solvers.
fn checked(paths: &[PathBuf]) -> anyhow::Result<Vec<Study>> {
    let sources = study_files::read_all(paths)?;
    let of = |source: &StudySource| {
        let study = Study::check_for(source, Purpose::Solving)?;
        for solver in &study.solvers {
            mapping_of(solver, Axes::of(study.scene)).map_err(|error| Ended::usage(error.to_string()))?;
        }
        Ok(study)
    };
    sources.iter().map(of).collect()
}

/// What is odd about a study, on standard error.
pub fn tell_warnings(study: &Study) {
    for warning in &study.warnings {
        say!("{warning}");
    }
}

/// Cases at the same time: what was asked for, or one a core.
pub fn jobs_of(asked: Option<u64>) -> usize {
    asked
        .and_then(|jobs| usize::try_from(jobs).ok())
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get))
}

/// A share as it is typed, `i/n`.
pub fn shard_of(typed: &str, parting: Parting) -> anyhow::Result<Shard> {
    let parts =
        typed.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
    match parts {
        Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count, parting }),
        _ => {
            Err(Ended::usage(format!("`--shard {typed}` is not a share: write i/n with 1 ≤ i ≤ n, like 2/3")))
        }
    }
}
