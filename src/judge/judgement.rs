//! Judges the expectations of a study on the paths of its records.

use crate::case::{Case, Tier};
use crate::golden::GoldenFile;
use crate::judge::paths::{Path, StudyPaths};
use crate::judge::verdict::{Beside, Verdict, judge};
use crate::record::Record;
use crate::study::check::Study;
use crate::study::expectation::SeriesExpectation;
use oedometer_convergence::{Context, ErrorSeries, NumericalUncertainty, SeriesDemand};
use std::collections::BTreeMap;

/// The judgement of one expectation of a study.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Judgement {
    /// Line of the expectation in its file.
    pub line: usize,
    /// What was judged, in words.
    pub subject: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The uncertainty of the value, where it was asked for and defined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<NumericalUncertainty>,
}

/// Judges every expectation of a study that its tier can answer.
pub fn judge_study(study: &Study, records: &[Record], tier: Tier) -> Vec<Judgement> {
    judge_paths(study, records, &StudyPaths::of(records), tier)
}

/// [`judge_study`] with the paths of the records given.
pub fn judge_paths(study: &Study, records: &[Record], paths: &StudyPaths<'_>, tier: Tier) -> Vec<Judgement> {
    let absent = Absent::among(records);
    let series = study.expectations.iter().filter(|expectation| expectation.tier <= tier);
    let cases = study.case_expectations.iter().filter(|expectation| expectation.tier <= tier);
    // Cases that were not run because their solver is missing are not judged; the check says so.
    let series =
        series.filter(|one| !absent.holds_all(|case| one.selection.fits_along(one.axis.name(), case)));
    let cases =
        cases.filter(|one| one.asks_for_a_skip() || !absent.holds_all(|case| one.selection.fits(case)));
    series
        .flat_map(|expectation| judge_expectation(expectation, paths.along(expectation.axis)))
        .chain(cases.flat_map(|expectation| expectation.judge(records)))
        .collect()
}

/// One judgement for each path that the expectation selects; where it selects none, one that fails.
pub(super) fn judge_expectation(expectation: &SeriesExpectation, all: &[Path<'_>]) -> Vec<Judgement> {
    let SeriesExpectation { measure, demand, selection, axis, line, .. } = expectation;
    let judge_path = |path: &Path<'_>, series: ErrorSeries| {
        let context = path.context(measure);
        let beside = path.beside(demand, measure, context.formal_order);
        let mut verdict = judge(demand, &series, &context, &beside);
        if let Some(place) = path.place(demand, measure).filter(|_| !verdict.pass) {
            verdict.reason = format!("{}; {place}", verdict.reason);
        }
        let uncertainty = beside.uncertainty.and_then(Result::ok);
        Judgement { line: *line, subject: format!("{}: {measure}", path.label()), verdict, uncertainty }
    };
    let selected = all.iter().filter(|path| selection.fits_along(axis.name(), &path.records[0].case));
    let with_series = selected.map(|path| (path, path.series(measure)));
    let judgements: Vec<Judgement> = with_series
        .filter(|(_, series)| !series.levels().is_empty())
        .map(|(path, series)| judge_path(path, series))
        .collect();
    if !judgements.is_empty() {
        return judgements;
    }
    let method = selection.method().map_or("any method".to_owned(), |method| method.to_string());
    // Not excused by `xfail`: nothing was measured, which is not a known failure.
    let strict = SeriesDemand { xfail: None, ..demand.clone() };
    let verdict = judge(&strict, &ErrorSeries::default(), &Context::default(), &Beside::default());
    vec![Judgement { line: *line, subject: format!("{method}: {measure}"), verdict, uncertainty: None }]
}

/// Cases that were skipped because their solver is not installed, and the others.
pub struct Absent<'a> {
    skipped: Vec<&'a Record>,
    others: Vec<&'a Record>,
}

impl<'a> Absent<'a> {
    /// The skipped cases among records.
    pub fn among(records: &'a [Record]) -> Self {
        let (skipped, others) = records.iter().partition(|record| record.status.is_skipped());
        Self { skipped, others }
    }

    /// Whether a selection has cases, and all of them were skipped.
    pub fn holds_all(&self, is_selected: impl Fn(&Case) -> bool) -> bool {
        self.skipped.iter().any(|record| is_selected(&record.case))
            && !self.others.iter().any(|record| is_selected(&record.case))
    }

    /// Golden values without those of skipped cases.
    pub fn without(&self, mut golden: GoldenFile) -> GoldenFile {
        let labels: Vec<String> = self.skipped.iter().map(|record| record.case.label()).collect();
        golden.values.retain(|name, _| {
            name.split_once(" | ").is_none_or(|(case, _)| !labels.iter().any(|label| label == case))
        });
        golden
    }

    /// One sentence for each solver that is not installed.
    pub fn warnings(&self) -> Vec<String> {
        let mut by_solver: BTreeMap<String, Vec<&Record>> = BTreeMap::new();
        for record in &self.skipped {
            by_solver.entry(record.case.method.to_string()).or_default().push(record);
        }
        let sentence = |(solver, records): (&String, &Vec<&Record>)| {
            let why = records[0].status.failure().map_or("", |failure| failure.reason.as_str());
            format!("{solver}: {} cases were skipped and not judged: {why}", records.len())
        };
        by_solver.iter().map(sentence).collect()
    }
}

/// One sentence for each case whose solver gives different results when repeated.
pub fn differing_repeats(records: &[Record]) -> Vec<String> {
    let note = |record: &Record| {
        let told = record.attached.as_ref()?.notes.first()?;
        Some(format!("{}: {told}", record.case.label()))
    };
    records.iter().filter_map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::Status;
    use oedometer_mpm::run::results::outcome::{Failure, FailureKind};

    fn records() -> Vec<Record> {
        let mut records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\ncells = [2, 4]\n",
        );
        let reason = "it says that it cannot run here".to_owned();
        records[0].status = Status::Failed(Failure::of_attached(FailureKind::Skipped, reason));
        records
    }

    #[test]
    fn a_selection_is_absent_only_where_all_of_it_was_skipped() {
        let records = records();
        let absent = Absent::among(&records);
        assert!(absent.holds_all(|case| case.cells == 2));
        assert!(!absent.holds_all(|case| case.cells == 4));
        assert!(!absent.holds_all(|_| true), "half of it was run and is judged");
        assert!(!absent.holds_all(|_| false), "what selects nothing must fail");
        let told = absent.warnings();
        assert!(told.len() == 1 && told[0].contains("MPM: 1 cases were skipped"), "{told:?}");
    }
}
