//! From the paths of a study to verdicts on what it expects.

use crate::case::tier::Tier;
use crate::judge::absent::Absent;
use crate::judge::paths::{Path, StudyPaths};
use crate::judge::verdict::{Beside, Verdict, judge};
use crate::record::Record;
use crate::study::check::Study;
use crate::study::expectation::SeriesExpectation;
use oedometer_convergence::class::Context;
use oedometer_convergence::series::ErrorSeries;
use oedometer_convergence::series_demand::SeriesDemand as Demand;
use oedometer_convergence::uncertainty::NumericalUncertainty;

/// The judgement of one expectation of a study.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Judgement {
    /// Line of the expectation in its file.
    pub line: usize,
    /// What was judged, in words.
    pub subject: String,
    /// The verdict.
    pub verdict: Verdict,
    /// What refinement tells of the value, where that was asked for and could be had.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<NumericalUncertainty>,
}

/// Judges every expectation of a study that its tier can answer.
pub fn judge_study(study: &Study, records: &[Record], tier: Tier) -> Vec<Judgement> {
    judge_paths(study, records, &StudyPaths::of(records), tier)
}

/// The same where the paths of the records are known.
pub fn judge_paths(study: &Study, records: &[Record], paths: &StudyPaths<'_>, tier: Tier) -> Vec<Judgement> {
    let absent = Absent::among(records);
    let series = study.expectations.iter().filter(|expectation| expectation.tier <= tier);
    let cases = study.case_expectations.iter().filter(|expectation| expectation.tier <= tier);
    // What was not run, because its solver is not here, is not judged; the check says so.
    let series =
        series.filter(|one| !absent.holds_all(|case| one.selection.fits_along(one.axis.name(), case)));
    let cases =
        cases.filter(|one| one.asks_for_a_skip() || !absent.holds_all(|case| one.selection.fits(case)));
    series
        .flat_map(|expectation| judge_expectation(expectation, paths.along(expectation.axis)))
        .chain(cases.flat_map(|expectation| expectation.judge(records)))
        .collect()
}

/// One judgement a path that the expectation selects; where it selects none, one that fails.
fn judge_expectation(expectation: &SeriesExpectation, all: &[Path<'_>]) -> Vec<Judgement> {
    let measure = &expectation.measure;
    let what = measure.to_string();
    let selected: Vec<_> = all
        .iter()
        .filter(|path| expectation.selection.fits_along(expectation.axis.name(), &path.records[0].case))
        .filter(|path| !path.series(measure).levels().is_empty())
        .collect();
    if selected.is_empty() {
        let method =
            expectation.selection.method().map_or("any method".to_owned(), |method| method.to_string());
        let nothing = ErrorSeries::new(Vec::new());
        // Without its pardon: nothing was measured, and that is no known failure.
        let strict = Demand { xfail: None, ..expectation.demand.clone() };
        let verdict = judge(&strict, &nothing, &Context::default(), &Beside::default());
        let subject = format!("{method}: {what}");
        return vec![Judgement { line: expectation.line, subject, verdict, uncertainty: None }];
    }
    selected
        .into_iter()
        .map(|path| {
            let context = path.context(measure);
            let beside = path.beside(&expectation.demand, measure, context.formal_order);
            let mut verdict = judge(&expectation.demand, &path.series(measure), &context, &beside);
            if let Some(place) = path.place(&expectation.demand, measure).filter(|_| !verdict.pass) {
                verdict.reason = format!("{}; {place}", verdict.reason);
            }
            Judgement {
                line: expectation.line,
                subject: format!("{}: {what}", path.label()),
                verdict,
                uncertainty: beside.uncertainty.and_then(Result::ok),
            }
        })
        .collect()
}
