//! `oedometer accept`: the present values of a study become its golden values.

use crate::case::planned::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::cli::help::EXPERT;
use crate::cli::output::{TableFormat, is_on, print_tables, say, terminal_width};
use crate::cli::place::{StudyArguments, golden_folder};
use crate::cli::running::{jobs_of, run_quietly};
use crate::cli::study_files::load;
use crate::cli::trust::TrustArguments;
use crate::golden::measure::GoldenKey;
use crate::golden::tolerance::{LastDigit, spread_by_group};
use crate::golden::{GoldenError, GoldenFile, values_of};
use crate::history::comparison::{OrderChange, StudyComparison};
use crate::history::state::StudyState;
use crate::judge::study_check::StudyCheck;
use crate::record::Record;
use crate::record::provenance::Provenance;
use crate::report::check_page::objections_of;
use crate::report::history_tables::comparison_tables;
use crate::study::check::Study;
use crate::study::file::GoldenRule;
use oedometer_wording::first_few;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Arguments of `accept`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    studies: StudyArguments,
    /// Accept the values even if expectations or cases of the study fail
    #[arg(long, help_heading = EXPERT)]
    despite_failing: bool,
    /// Why the new values are right
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of the golden values [default: `golden` beside the study or above]
    #[arg(long, value_name = "DIR")]
    golden: Option<PathBuf>,
    /// Number of cases that run in parallel [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    #[command(flatten)]
    trust: TrustArguments,
}

/// Runs the CI tier, as it is and with last digits changed, and writes values and tolerances.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if arguments.reason.trim().is_empty() {
        return Err(Ended::usage("golden values need a reason: --reason \"why the new values are right\""));
    }
    refuse_without_origin()?;
    let reason = arguments.reason.trim();
    let chosen = arguments.studies.chosen()?;
    let mut studies = with_golden(load(&chosen, None)?, !arguments.studies.names_none())?;
    arguments.trust.mark_all(&mut studies, &chosen)?;
    let folder_of = |study: &str| golden_folder(arguments.golden.as_deref(), study, &chosen);
    let older = studies.iter().map(|study| older_of(&folder_of(&study.name), &study.name));
    let older = older.collect::<anyhow::Result<Vec<Option<GoldenFile>>>>()?;
    let records = run_quietly(&studies, jobs_of(arguments.jobs))?;
    refuse_failing(&studies, &records, arguments.despite_failing)?;
    let lost = tell_changes(&studies, &records, &older)?;
    let mut perturbed = Vec::new();
    for digit in LastDigit::ALL {
        let studies: Vec<Study> = studies.iter().map(|study| study.perturbed(digit)).collect();
        perturbed.push(run_quietly(&studies, jobs_of(arguments.jobs))?);
    }
    let mut accepted = Vec::new();
    for (number, study) in studies.iter().enumerate() {
        let reason = with_lost_orders(reason, &lost[number]);
        let golden = GoldenFile::of(&study.name, &records[number], &reason).allowing(study.golden);
        let others: Vec<&[Record]> = perturbed.iter().map(|records| &records[number][..]).collect();
        accepted.push(with_spread(golden, &others)?);
    }
    for (golden, older) in accepted.into_iter().zip(older) {
        // Values that agree with what is there stay as they are.
        let golden = if let Some(older) = &older { golden.keeping(older) } else { golden };
        let path = golden.write(&folder_of(&golden.study))?;
        say!("{}: {} values in {}", golden.study, golden.values.len(), path.display());
    }
    Ok(Exit::Pass)
}

/// Golden values with what the last digits of every input move; refused where a value jumps.
fn with_spread(golden: GoldenFile, others: &[&[Record]]) -> anyhow::Result<GoldenFile> {
    let values = others.iter().map(|records| values_of(records));
    let others: Vec<(LastDigit, BTreeMap<GoldenKey, f64>)> = LastDigit::ALL.into_iter().zip(values).collect();
    if let Some(jump) = golden.jump(&others) {
        let sentence = format!("nothing was accepted: {}: {}", golden.study, jump.sentence());
        return Err(Ended::with(Exit::Golden, sentence));
    }
    let spread = spread_by_group(&golden.values, others.iter().map(|(_, values)| values));
    let spread = golden.explained(spread);
    Ok(golden.widened_by(spread))
}

/// The studies that have golden values: without names those of the project, of named ones all.
///
/// # Errors
/// When a study that was named, or each of the project, says that it has none.
fn with_golden(studies: Vec<Study>, are_named: bool) -> anyhow::Result<Vec<Study>> {
    let (without, kept): (Vec<Study>, Vec<Study>) =
        studies.into_iter().partition(|study| study.golden == GoldenRule::None);
    match without.first() {
        Some(study) if are_named || kept.is_empty() => Err(Ended::usage(format!(
            "{}: the study has `golden = \"none\"`: remove it to accept values",
            study.name
        ))),
        _ => Ok(kept),
    }
}

/// Says which expectations and cases fail, and refuses to accept values of their studies unless asked to.
fn refuse_failing(studies: &[Study], records: &[Vec<Record>], despite: bool) -> anyhow::Result<()> {
    let mut fails = false;
    for (study, records) in studies.iter().zip(records) {
        let as_found = GoldenFile::of(&study.name, records, "as found");
        let check = StudyCheck::new(study, records, Tier::Ci, Ok(as_found));
        if let Some(objections) = objections_of(&check, terminal_width()) {
            say!("{}", objections.trim_end());
            fails = true;
        }
    }
    if fails && !despite {
        return Err(Ended::with(
            Exit::VerdictFailed,
            "nothing was accepted, because these fail: fix the code or the expectations, or accept the \
             values with --despite-failing",
        ));
    }
    Ok(())
}

/// Refuses to write golden files in CI, and from sources that no commit has.
///
/// # Errors
/// A sentence that says which.
pub fn refuse_without_origin() -> anyhow::Result<()> {
    without_origin(is_on("CI"), &Provenance::of_this_program()).map_or(Ok(()), |why| Err(Ended::usage(why)))
}

/// Why a program may not accept golden values.
fn without_origin(is_in_ci: bool, program: &Provenance) -> Option<&'static str> {
    if is_in_ci {
        return Some("golden values are not accepted in CI: review and accept them on your own machine");
    }
    program.dirty.then_some(
        "the sources of this program have uncommitted changes: commit and build first, so that golden values can be traced",
    )
}

/// The golden values there are; `None` where there are none. An unreadable file is not replaced, because its content is unknown.
fn older_of(folder: &Path, study: &str) -> anyhow::Result<Option<GoldenFile>> {
    match GoldenFile::read(folder, study) {
        Ok(older) => Ok(Some(older)),
        Err(GoldenError::Missing(_)) => Ok(None),
        Err(error) => Err(Ended::with(
            Exit::Golden,
            format!("nothing was accepted: {error}. Only a readable or missing file is replaced"),
        )),
    }
}

/// Shows what an acceptance changes; the orders that each study loses.
fn tell_changes(
    studies: &[Study],
    records: &[Vec<Record>],
    older: &[Option<GoldenFile>],
) -> anyhow::Result<Vec<Vec<OrderChange>>> {
    let compared = |((study, records), older): ((&Study, &Vec<Record>), &Option<GoldenFile>)| {
        let before = StudyState::of_golden(older.clone()?);
        Some(StudyComparison::of(&study.name, &before, &StudyState::of_records(&study.name, records)))
    };
    let all: Vec<Option<StudyComparison>> = studies.iter().zip(records).zip(older).map(compared).collect();
    let changes = all.iter().flatten().filter(|comparison| !comparison.groups.is_empty());
    let shown: Vec<StudyComparison> = changes.cloned().collect();
    if !shown.is_empty() {
        print_tables(&comparison_tables(&shown, ["golden values", "now"]), TableFormat::Table)?;
    }
    let lost = |comparison: Option<StudyComparison>| {
        comparison.map_or(Vec::new(), |comparison| {
            comparison.orders.into_iter().filter(OrderChange::is_loss).collect()
        })
    };
    Ok(all.into_iter().map(lost).collect())
}

/// Lost orders that a reason names before the rest is only counted.
const MOST_LOST: usize = 5;

/// A reason with the orders that the acceptance loses.
fn with_lost_orders(reason: &str, lost: &[OrderChange]) -> String {
    if lost.is_empty() {
        return reason.to_owned();
    }
    let named = first_few(lost.iter().map(OrderChange::sentence).collect(), MOST_LOST);
    let reason = format!("{reason} (orders lost: {})", named.join("; "));
    say!("the reason of this acceptance is: {reason}");
    reason
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::comparison::Behaviour;
    use crate::study::file::StudySource;

    #[test]
    fn values_of_a_study_whose_expectations_fail_are_taken_only_when_told() {
        let refused = |below: &str, despite: bool| {
            let text = format!(
                "title = \"short\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[[sweep]]\n\
                 method = [\"MPM\"]\nintegrator = [\"implicit\"]\ncells = [3, 6]\n\n[[expect]]\n\
                 time_factor = 0.1\nat = {{ cells = 6, below = {below} }}\n"
            );
            let source = StudySource { name: "short.toml".to_owned(), text };
            let studies = [Study::check(&source).expect("sound")];
            let records = run_quietly(&studies, 1).expect("records");
            refuse_failing(&studies, &records, despite).err()
        };
        let error = refused("1e-9", false).expect("it is refused");
        assert_eq!(Exit::of(&error), Exit::VerdictFailed);
        assert!(error.to_string().contains("--despite-failing"), "{error}");
        assert!(refused("1e-9", true).is_none(), "somebody said so");
        assert!(refused("0.5", false).is_none(), "nothing fails");
    }

    #[test]
    fn an_acceptance_names_the_orders_that_it_loses_in_its_reason() {
        let behaviour = |class, order| Behaviour { class, order };
        let change = |before, after| OrderChange { series: "s cells=…".to_owned(), before, after };
        for (before, after, lost) in [
            (behaviour("asymptotic", Some(2.0)), behaviour("asymptotic", Some(1.2)), Some("2.00 → 1.20")),
            (
                behaviour("asymptotic", Some(2.0)),
                behaviour("floor-limited", None),
                Some("2.00 → none, floor-limited"),
            ),
            (behaviour("asymptotic", Some(2.0)), behaviour("asymptotic", Some(1.9)), None),
            (behaviour("asymptotic", Some(1.0)), behaviour("asymptotic", Some(2.0)), None),
            (behaviour("asymptotic", Some(2.0)), behaviour("exact", None), None),
            (behaviour("oscillatory", None), behaviour("asymptotic", Some(1.0)), None),
        ] {
            let changed = change(before, after);
            assert_eq!(changed.is_loss(), lost.is_some(), "{changed:?}");
            if let Some(told) = lost {
                assert_eq!(changed.sentence(), format!("s cells=… {told}"));
            }
        }
        assert_eq!(with_lost_orders("why", &[]), "why");
        let lost = change(behaviour("asymptotic", Some(2.0)), behaviour("asymptotic", Some(1.0)));
        assert_eq!(
            with_lost_orders("why", std::slice::from_ref(&lost)),
            "why (orders lost: s cells=… 2.00 → 1.00)"
        );
        assert!(with_lost_orders("why", &vec![lost; 7]).ends_with("; and 2 more)"));
    }

    #[test]
    fn golden_values_are_accepted_by_a_person_and_from_sources_that_are_committed() {
        for (is_in_ci, dirty, words) in [
            (false, false, None),
            (true, false, Some("in CI")),
            (false, true, Some("uncommitted changes")),
            (true, true, Some("in CI")),
        ] {
            let program = Provenance { dirty, ..Provenance::of_this_program() };
            let why = without_origin(is_in_ci, &program);
            assert!(
                words.map_or(why.is_none(), |words| why.is_some_and(|why| why.contains(words))),
                "{why:?}"
            );
        }
    }

    #[test]
    fn orders_that_an_acceptance_loses_are_found_against_the_file_that_it_replaces() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16, 32]\n";
        let study = crate::campaign::runner::study_of("t", text);
        let now = crate::campaign::runner::records_of(text);
        let mut before = GoldenFile::of("t", &now, "before");
        for (key, value) in &mut before.values {
            let cells = key.case.split("cells=").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok());
            if let Some(cells) = cells.filter(|_| key.measure.to_string().starts_with("pressure points")) {
                *value = f64::powi(cells, -3);
            }
        }
        let studies = [study];
        let found = tell_changes(&studies, std::slice::from_ref(&now), &[Some(before)]).expect("compared");
        assert!(
            found[0].iter().any(|comparison| comparison.series.contains("pressure points terzaghi")),
            "{found:?}"
        );
        assert_eq!(tell_changes(&studies, &[now], &[None]).expect("compared"), [vec![]]);
    }

    #[test]
    fn a_spread_is_the_largest_change_by_any_of_the_digits() {
        let records = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [3]\n",
        );
        let golden = GoldenFile::of("t", &records, "a reason");
        let is_kept = |row: &crate::record::ErrorRow| row.norm == row.quantity.first_norm();
        let place = records[0].errors.iter().position(is_kept).expect("a kept error");
        let moved = |change: f64| {
            let mut records = records.clone();
            records[0].errors[place].value += change;
            records
        };
        for changes in [[3e-6, 1e-6], [1e-6, 3e-6]] {
            let others = changes.map(moved);
            let found =
                with_spread(golden.clone(), &others.each_ref().map(Vec::as_slice)).expect("round-off");
            assert_eq!(found.spread.len(), 1);
            assert!(found.spread.values().all(|one| (one / 3e-6 - 1.0).abs() < 1e-6), "{changes:?}");
        }
        // A jump is told with its digit, and taken with the tolerance that it names.
        let jumping = [moved(0.0), moved(3e-2)];
        let jumping = jumping.each_ref().map(Vec::as_slice);
        let told = with_spread(golden.clone(), &jumping).expect_err("no round-off").to_string();
        for words in ["by 3.00e-2, when the last digit of the conductivity", "ceil(", "golden = \"none\""] {
            assert!(told.contains(words), "{words}: {told}");
        }
        let jumping = [moved(3e-3), moved(0.0)];
        let jumping = jumping.each_ref().map(Vec::as_slice);
        let told = with_spread(golden.clone(), &jumping).expect_err("no round-off").to_string();
        assert!(
            told.contains("last digit of the stiffness") && told.contains("`tolerance = 6e-3`"),
            "{told}"
        );
        let found =
            with_spread(golden.allowing(GoldenRule::Within(6e-3)), &jumping).expect("as the study says");
        let name = found.values.keys().find(|key| key.measure.is_error()).expect("a value");
        assert_eq!(found.out_of_bounds(), None);
        assert_eq!(found.tolerance(name, 1.0), 1.2e-2);
    }
}
