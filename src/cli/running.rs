//! Cases of studies run, kept and told of, as several commands do it.

use crate::campaign::case_run::all_cores;
use crate::campaign::case_runner::time_study;
use crate::campaign::runner::{RunError, RunOptions, RunReport, Selected, run_studies, run_studies_thinned};
use crate::campaign::taken_over::TakenOver;
use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::say;
use crate::cli::progress::StudyBar;
use crate::cli::study_files::{is_compressed, is_small, tell_of_passed_over, write_tables};
use crate::judge::verdict::Absent;
use crate::record::Record;
use crate::record::csv::TableForm;
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::study::check::Study;
use oedometer_wording::count_of;
use std::path::Path;

/// Cases at the same time: what was asked for, or one a core.
pub fn jobs_of(asked: Option<u64>) -> usize {
    asked.and_then(|jobs| usize::try_from(jobs).ok()).unwrap_or_else(all_cores)
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
    let bar = StudyBar::of(studies);
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

/// Runs the CI tier of studies and keeps nothing; the records of each study.
///
/// # Errors
/// When a case has no record, or the run was interrupted.
pub fn run_quietly(studies: &[Study], jobs: usize) -> anyhow::Result<Vec<Vec<Record>>> {
    let of_study = |(study, report): (&Study, RunReport)| match report.errors.into_iter().next() {
        Some(error) => Err(anyhow::Error::from(error).context(study.name.clone())),
        None => Ok(report.records),
    };
    studies.iter().zip(run_ci_tier(studies, jobs, None, &|_, _| {})?).map(of_study).collect()
}

/// Runs the CI tier of studies and stores nothing; errors are in the reports. What this build solved already is taken
/// from a folder of results, and what other programs did where the study declares by what they are known.
pub fn run_ci_tier(
    studies: &[Study],
    jobs: usize,
    records: Option<&Path>,
    thin: &(dyn Fn(&Study, &mut Record) + Sync),
) -> anyhow::Result<Vec<RunReport>> {
    let bar = StudyBar::of(studies);
    let store_of = |study: &Study| Some(RecordStore::new(records?, &study.name));
    let stores: Vec<Option<RecordStore>> = studies.iter().map(store_of).collect();
    let selected: Vec<Selected<'_>> = (studies.iter().zip(&stores))
        .map(|(study, store)| Selected { study, store: store.as_ref(), is_kept: false })
        .collect();
    let options = RunOptions { resume: true, ..RunOptions::whole(Tier::Ci, jobs) };
    let mut reports = run_studies_thinned(&selected, &options, thin, &|progress| bar.tell(progress));
    bar.finish();
    if let Some(error) = reports.iter_mut().find_map(first_that_ends_all) {
        return Err(error.into());
    }
    refuse_unfinished(&reports)?;
    Ok(reports)
}

/// Refuses to judge the results of an interrupted run.
///
/// # Errors
/// A sentence with the number of cases that are missing.
pub fn refuse_unfinished(reports: &[RunReport]) -> anyhow::Result<()> {
    let left: usize = reports.iter().map(|report| report.tally.left).sum();
    if left == 0 {
        return Ok(());
    }
    let cases = count_of(left, "case was", "cases were");
    let sentence = format!("{cases} not run, because this run was interrupted: nothing was judged");
    Err(Ended::with(Exit::IncompleteMerge, sentence))
}

/// The first error that no single case caused: no further result can be kept.
fn first_that_ends_all(report: &mut RunReport) -> Option<RunError> {
    let place = report.errors.iter().position(|error| error.of_case().is_none())?;
    Some(report.errors.swap_remove(place))
}

fn tell_of(study: &Study, report: &RunReport, table: &Path) {
    let skipped = match report.tally.skipped {
        0 => String::new(),
        skipped => format!(", {skipped} skipped"),
    };
    say!(
        "{}: {} ({} reused, {} failed{skipped}), {}",
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
            "{}: not reused, so run again: {} of another version or of other sources",
            study.name,
            count_of(report.of_another_program, "record", "records")
        );
    }
    if let Some(differences) = report.origins.differences_from(&Provenance::of_this_program()) {
        say!(
            "{}: records of other builds of the same sources were reused; their values are the same: {differences}",
            study.name
        );
    }
}
