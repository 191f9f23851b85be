//! Golden values over the commits that changed them.

use crate::golden::GoldenFile;
use crate::golden::compare::{Difference, case_changes, cases_apart, compare};
use crate::golden::measure::{GoldenKey, Measure};
use crate::history::comparison::{StudyComparison, Trend};
use crate::history::repository::{Commit, GitError, Repository};
use crate::history::state::{StudyState, golden_name, unreadable};
use crate::measure::round_off::ROUND_OFF;
use oedometer_soil::elementary;
use oedometer_wording::count_of;
use std::collections::{BTreeMap, BTreeSet};

/// One commit that changed a study's golden values.
#[derive(Clone, Debug, serde::Serialize)]
pub(crate) struct Step {
    /// The commit.
    #[serde(flatten)]
    pub commit: Commit,
    /// The reason that the golden file gives.
    pub reason: String,
    /// Cases that the file before had and this one has not.
    #[serde(rename = "went")]
    pub removed: Vec<String>,
    /// Cases that only this file has.
    #[serde(rename = "came")]
    pub added: Vec<String>,
    /// Values of the file.
    pub values: usize,
    /// Values that the file before had too.
    pub shared: usize,
    /// Geometric mean of the errors over those of the first file, chained over the values that neighbours share.
    pub error_index: f64,
    /// Geometric mean of the work counters over those of the first file, chained likewise.
    pub work_index: f64,
    /// Values that moved beyond the tolerance of the file before.
    pub moved: usize,
    /// Values that only one of the two files has.
    pub unpaired: usize,
    /// Largest relative change of an error.
    pub largest_change: f64,
    /// Whether the errors rose or fell.
    pub accuracy: Trend,
    /// Whether the work rose or fell.
    pub cost: Trend,
}

impl Step {
    /// Whether values moved, or cases were removed or added.
    pub fn has_changed(&self) -> bool {
        self.moved > 0 || !(self.removed.is_empty() && self.added.is_empty())
    }
}

/// A study's golden values over time.
#[derive(Clone, Debug, serde::Serialize)]
pub(crate) struct Timeline {
    /// The study.
    pub study: String,
    /// The commits that changed its file, the first one first.
    pub steps: Vec<Step>,
}

/// The timelines of the golden files in a folder of a repository, and what was passed over.
///
/// # Errors
/// When git fails.
pub(crate) fn timelines(
    repository: &Repository,
    folder: &str,
    only: &[String],
) -> Result<(Vec<Timeline>, Vec<String>), GitError> {
    let commits = repository.changes_below(folder)?;
    let is_asked = |study: &str| only.is_empty() || only.iter().any(|name| name == study);
    let (mut files, mut others) = (Vec::new(), BTreeSet::new());
    for (commit, paths) in &commits {
        for path in paths {
            let Some(study) = golden_name(path, folder) else {
                others.extend(json_name(path, folder).filter(|study| is_asked(study)));
                continue;
            };
            if is_asked(study) {
                files.push((study, commit, format!("{}:{path}", commit.hash)));
            }
        }
    }
    let objects: Vec<String> = files.iter().map(|(.., object)| object.clone()).collect();
    let texts = repository.texts(&objects)?;
    let mut lines: BTreeMap<&str, (Vec<Step>, Option<GoldenFile>)> = BTreeMap::new();
    let mut notes = Vec::new();
    if let Some(first) = others.first() {
        notes.push(format!(
            "{} skipped, like {folder}/{first}.json: only golden values from layout 2 on, in CSV, are read",
            count_of(others.len(), "golden file in JSON is", "golden files in JSON are")
        ));
    }
    for (study, commit, object) in &files {
        // A commit that deleted the file has no text.
        let Some(text) = texts.get(object) else { continue };
        match GoldenFile::from_text(text) {
            Ok(golden) => {
                let (steps, before) = lines.entry(study).or_default();
                steps.push(Step::of(commit, steps.last(), before.as_ref(), &golden));
                *before = Some(golden);
            }
            Err(reason) => {
                notes.push(unreadable(commit, object.split_once(':').map_or("", |(_, path)| path), &reason));
            }
        }
    }
    let timeline = |(study, (steps, _)): (&str, _)| Timeline { study: study.to_owned(), steps };
    Ok((lines.into_iter().map(timeline).collect(), notes))
}

impl Step {
    fn of(commit: &Commit, last: Option<&Self>, before: Option<&GoldenFile>, golden: &GoldenFile) -> Self {
        let mut step = Self {
            commit: commit.clone(),
            reason: golden.reason.clone(),
            removed: Vec::new(),
            added: Vec::new(),
            values: golden.values.len(),
            shared: golden.values.len(),
            error_index: last.map_or(1.0, |last| last.error_index),
            work_index: last.map_or(1.0, |last| last.work_index),
            moved: 0,
            unpaired: 0,
            largest_change: 0.0,
            accuracy: Trend::Same,
            cost: Trend::Same,
        };
        let Some(before) = before else { return step };
        [step.removed, step.added] = cases_apart(before.values.keys(), golden.values.keys());
        step.shared = before.values.keys().filter(|key| golden.values.contains_key(*key)).count();
        step.error_index *= mean_ratio(before, golden, |key| key.measure.is_error());
        step.work_index *= mean_ratio(before, golden, |key| key.measure == Measure::Steps);
        let differences = compare(before, &golden.values);
        step.moved = differences.iter().filter(|one| one.is_paired()).count();
        step.unpaired = differences.len() - step.moved;
        let errors = differences.iter().filter(|one| one.key.measure.is_error());
        step.largest_change = errors.filter_map(Difference::relative_change).fold(0.0, f64::max);
        let state = |golden: &GoldenFile| StudyState::of_golden(golden.clone());
        if !case_changes(&differences).is_empty() {
            let comparison = StudyComparison::of(&golden.study, &state(before), &state(golden));
            (step.accuracy, step.cost) = (comparison.accuracy, comparison.cost);
        }
        step
    }
}

/// The study whose golden file of the first layout has this path.
fn json_name<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    path.strip_prefix(folder)?.strip_prefix('/')?.strip_suffix(".json").filter(|name| !name.contains('/'))
}

/// Geometric mean of the ratios of what both files have.
fn mean_ratio(before: &GoldenFile, after: &GoldenFile, is_meant: impl Fn(&GoldenKey) -> bool) -> f64 {
    let ratios = before.values.iter().filter(|(key, _)| is_meant(key)).filter_map(|(key, value)| {
        let (before, after) = (value.abs(), after.values.get(key)?.abs());
        // Ratios of round-off say nothing.
        (before > ROUND_OFF && after > ROUND_OFF).then(|| elementary::ln(after / before))
    });
    let (sum, count) = ratios.fold((0.0, 0_u32), |(sum, count), ratio| (sum + ratio, count + 1));
    if count == 0 { 1.0 } else { elementary::exp(sum / f64::from(count)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::measure::key;

    fn error(case: &str) -> GoldenKey {
        key(case, 0.1, "pressure points terzaghi")
    }

    fn steps(case: &str) -> GoldenKey {
        key(case, None, "steps")
    }

    fn golden<const N: usize>(values: [(GoldenKey, f64); N]) -> GoldenFile {
        GoldenFile { values: values.into(), ..GoldenFile::of("study", &[], "test") }
    }

    fn commit() -> Commit {
        Commit { hash: "0".repeat(40), date: "2026-11-25".to_owned(), subject: "s".to_owned() }
    }

    #[test]
    fn a_mean_ratio_is_that_of_later_to_earlier_values_of_what_both_have() {
        let of = |both: [f64; 5], alone: &str| {
            let both = ["a", "b", "c", "from zero", "to zero"].map(error).into_iter().zip(both);
            GoldenFile { values: both.chain([(error(alone), 3.0)]).collect(), ..golden([]) }
        };
        let (before, after) =
            (of([2.0, -5.0, 1.0, 0.0, 4.0], "gone"), of([16.0, 10.0, 1e3, 4.0, 0.0], "new"));
        let found = mean_ratio(&before, &after, |key| *key.case != *"c");
        assert!((found - 4.0).abs() < 1e-14, "8 and 2: {found}");
        assert_eq!(mean_ratio(&before, &after, |key| *key.case == *"gone"), 1.0);
    }

    #[test]
    fn a_step_counts_what_moved_and_apart_from_it_what_has_no_partner() {
        let [a, b, c] = ["a", "b", "c"].map(error);
        let before = golden([(a.clone(), 1e-2), (b, 2e-2), (steps("a"), 4.0)]);
        let after = golden([(a, 3e-2), (c, 2e-2), (steps("a"), 6.0)]);
        let first = Step::of(&commit(), None, None, &before);
        assert_eq!((first.values, first.moved, first.unpaired, first.error_index), (3, 0, 0, 1.0));
        let step = Step::of(&commit(), Some(&first), Some(&before), &after);
        let counts = (step.values, step.moved, step.unpaired);
        assert_eq!(counts, (3, 2, 2), "an error and the steps; `b` and `c`");
        assert!((step.error_index - 3.0).abs() < 1e-14, "{}", step.error_index);
        assert!((step.work_index - 1.5).abs() < 1e-14, "{}", step.work_index);
        assert!((step.largest_change - 2.0 / 3.0).abs() < 1e-14, "{}", step.largest_change);
        let next = Step::of(&commit(), Some(&step), Some(&after), &after);
        assert_eq!((next.moved, next.unpaired, next.largest_change), (0, 0, 0.0));
        assert_eq!((next.error_index, next.work_index), (step.error_index, step.work_index));
    }

    #[test]
    fn where_errors_and_work_went_are_told_apart_and_the_indices_go_on_from_the_last_step() {
        let of = |value: f64, count: f64| golden([(error("a"), value), (steps("a"), count)]);
        let before = of(1e-2, 40.0);
        let first = Step::of(&commit(), None, None, &before);
        for (error, steps, accuracy, cost) in [
            (2e-2, 40.0, Trend::Regressed, Trend::Same),
            (5e-3, 40.0, Trend::Improved, Trend::Same),
            (1e-2, 80.0, Trend::Same, Trend::Regressed),
            (1e-2, 20.0, Trend::Same, Trend::Improved),
            (2e-2, 20.0, Trend::Regressed, Trend::Improved),
        ] {
            let step = Step::of(&commit(), Some(&first), Some(&before), &of(error, steps));
            assert_eq!((step.accuracy, step.cost), (accuracy, cost), "{error} {steps}");
            let last = Step { error_index: 3.0, work_index: 5.0, ..first.clone() };
            let step = Step::of(&commit(), Some(&last), Some(&before), &of(error, steps));
            assert!((step.error_index - 3.0 * error / 1e-2).abs() < 1e-12, "{}", step.error_index);
            assert!((step.work_index - 5.0 * steps / 40.0).abs() < 1e-12, "{}", step.work_index);
        }
        assert_eq!(json_name("golden/a.json", "golden"), Some("a"));
        for other in ["golden/b/a.json", "other/a.json", "golden/a.csv", "goldena.json"] {
            assert_eq!(json_name(other, "golden"), None, "{other}");
        }
    }
}
