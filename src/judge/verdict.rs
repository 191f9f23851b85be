//! From the paths of a study to verdicts: compares series of errors with what the study expects of them.
//!
//! Every comparison is written so that NaN fails, every part of an expectation is judged, and a missing row
//! is a failure.

use crate::case::{Case, Tier};
use crate::golden::GoldenFile;
use crate::judge::paths::{Path, StudyPaths};
use crate::record::Record;
use crate::render::number;
use crate::study::check::Study;
use crate::study::expectation::{CaseExpectation, Measure, SeriesExpectation};
use oedometer_convergence::{
    Class, Classification, Context, ErrorBound, ErrorSeries, FLOOR_LEVELS, FloorBand, NumericalUncertainty,
    OrderBand, SeriesDemand, Undefined, classify, hidden_floor,
};
use oedometer_wording::{count_of, order, rounded};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// How a verdict came out; known failures are separate outcomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VerdictOutcome {
    /// Everything expected was found.
    Passed,
    /// Something was not found.
    Failed,
    /// Something was not found, and that was known.
    KnownFailure,
    /// Everything was found, although a strict known failure was declared.
    UnexpectedPass,
}

/// One part of an expectation, judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// `expectation`, `rows`, `class`, `order`, `error`, `spread`, `floor`, `oscillation` or `uncertainty`.
    pub name: String,
    /// Whether it is met.
    pub pass: bool,
    /// The number judged, where there is one; always finite.
    pub measured: Option<f64>,
    /// What was expected and what was found.
    pub reason: String,
    /// Whether it fails for no other reason than the class does.
    #[serde(skip)]
    pub follows: bool,
}

/// The judgement of one series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Whether the check passes.
    pub pass: bool,
    /// How it came out.
    pub outcome: VerdictOutcome,
    /// One sentence: what failed and why, or what was found.
    pub reason: String,
    /// The class, its reason, and the order where the class allows one.
    pub classification: Classification,
    /// Everything that was judged.
    pub checks: Vec<Check>,
}

/// What is measured of the runs besides their errors, where an expectation asks for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// Oscillation index of the run that the expectation is about.
    pub oscillation: Option<f64>,
    /// Numerical uncertainty of the value, or why it has none.
    pub uncertainty: Option<Result<NumericalUncertainty, Undefined>>,
}

/// Judges a series. Where the context has no formal order, the expected order serves as one.
pub fn judge(
    expectation: &SeriesDemand,
    series: &ErrorSeries,
    context: &Context,
    beside: &Beside,
) -> Verdict {
    let formal_order = context.formal_order.or(expectation.order.map(|band| band.value));
    let context = Context { formal_order, ..context.clone() };
    let classification = classify(series, &context);
    let problems: Vec<&str> = expectation.problems().iter().map(|problem| problem.sentence).collect();
    let mut checks = Vec::new();
    if !problems.is_empty() {
        checks.push(Check::failed("expectation", problems.join("; ")));
    }
    if expectation.class != Some(Class::NotEvaluable) {
        checks.push(rows(series, expectation.class));
    }
    let class = expectation.expected_class();
    checks.extend(class.map(|class| class_check(class, &classification, series)));
    checks.extend(expectation.order.map(|band| order_check(band, class, &classification)));
    checks.extend(expectation.at.map(|bound| error_check(bound, series)));
    checks.extend(expectation.spread.map(|bound| spread_check(bound, series)));
    checks.extend(expectation.floor.map(|band| floor_check(band, series, formal_order, &classification)));
    checks.extend(expectation.oscillation_below.map(|bound| oscillation_check(bound, beside.oscillation)));
    checks.extend(
        expectation.uncertainty_below.map(|bound| uncertainty_check(bound, beside.uncertainty.as_ref())),
    );
    let (outcome, reason) = conclude(expectation, &classification, &checks, problems.is_empty());
    let pass = matches!(outcome, VerdictOutcome::Passed | VerdictOutcome::KnownFailure);
    Verdict { pass, outcome, reason, classification, checks }
}

fn conclude(
    expectation: &SeriesDemand,
    classification: &Classification,
    checks: &[Check],
    sound: bool,
) -> (VerdictOutcome, String) {
    let failed: Vec<_> = checks.iter().filter(|check| !check.pass).collect();
    // A reason that a later one contains is said once.
    let sentence = |checks: &[&Check]| {
        let reasons = checks.iter().enumerate().filter_map(|(at, check)| {
            let is_repeated = checks[at + 1..].iter().any(|later| later.reason.contains(&check.reason));
            (!is_repeated).then_some(check.reason.as_str())
        });
        reasons.collect::<Vec<_>>().join("; ")
    };
    // A known failure excuses a wrong result, not a missing one.
    let absent = !failed.is_empty() && classification.class == Class::NotEvaluable
        || failed.iter().any(|check| check.name == "rows");
    match (&expectation.xfail, failed.is_empty()) {
        (Some(known), false) if sound && !absent => {
            let why = sentence(&failed);
            (VerdictOutcome::KnownFailure, format!("known failure ({}): {why}", known.reason))
        }
        (Some(known), true) if known.strict => (
            VerdictOutcome::UnexpectedPass,
            format!("passes although it is marked as a known failure ({}): remove `xfail`", known.reason),
        ),
        (_, true) => (VerdictOutcome::Passed, sentence(&checks.iter().collect::<Vec<_>>())),
        (_, false) => (VerdictOutcome::Failed, sentence(&failed)),
    }
}

impl Check {
    /// A check that fails because there is nothing to judge.
    pub(crate) fn failed(name: &str, reason: impl Into<String>) -> Self {
        Self::new(name, false, reason)
    }

    /// A check of something that is no number.
    pub(crate) fn new(name: &str, pass: bool, reason: impl Into<String>) -> Self {
        Self { name: name.to_owned(), pass, measured: None, reason: reason.into(), follows: false }
    }

    /// A number that was compared with bounds: `statement`, one of the words for pass and failure, `bounds`.
    pub(crate) fn compared(
        name: &str,
        pass: bool,
        measured: f64,
        statement: &str,
        words: [&str; 2],
        bounds: &str,
    ) -> Self {
        let word = words[usize::from(!pass)];
        let measured = Some(measured).filter(|value| value.is_finite());
        let reason = format!("{statement} {word} {bounds}");
        Self { measured, ..Self::new(name, pass, reason) }
    }
}

/// Words for a number between two bounds.
pub(crate) const IN: [&str; 2] = ["in", "outside"];
/// Words for a number with an upper bound.
pub(crate) const BELOW: [&str; 2] = ["below", "not below"];

/// Every level is there with a finite error; an error of zero is allowed where exactness is expected.
fn rows(series: &ErrorSeries, class: Option<Class>) -> Check {
    let levels = series.levels();
    let is_zero = |error: Option<f64>| error.is_some_and(|error| (0.0..1e-300).contains(&error));
    let obstacle = levels
        .iter()
        .filter(|level| !(class == Some(Class::Exact) && is_zero(level.error)))
        .find_map(|level| level.positive_error().err());
    let obstacle = obstacle.or(series.check_sizes().err());
    match obstacle {
        _ if levels.is_empty() => Check::failed("rows", "there are no rows"),
        Some(obstacle) => Check::failed("rows", obstacle.to_string()),
        None => Check::new("rows", true, format!("{} levels", levels.len())),
    }
}

fn class_check(wanted: Class, found: &Classification, series: &ErrorSeries) -> Check {
    let pass = found.class == wanted;
    let reason = if pass {
        format!("{}: {}", found.class, found.reason)
    } else {
        let advice = found.advice.as_deref().map_or_else(String::new, |text| format!(" ({text})"));
        let errors: Vec<String> = series
            .levels()
            .iter()
            .filter_map(|level| level.error)
            .map(|error| format!("{error:.3e}"))
            .collect();
        let errors = match found.class {
            Class::NotEvaluable if !errors.is_empty() => format!("; the errors are {}", errors.join(", ")),
            _ => String::new(),
        };
        format!("{}, expected {wanted}: {}{advice}{errors}", found.class, found.reason)
    };
    Check::new("class", pass, reason)
}

fn order_check(band: OrderBand, class: Option<Class>, found: &Classification) -> Check {
    let limits = format!("{} … {}", order(band.value - band.minus), order(band.value + band.plus));
    match found.order {
        Some(measured) if class == Some(found.class) => {
            let statement = format!("order {}", order(measured));
            Check::compared("order", band.contains(measured), measured, &statement, IN, &limits)
        }
        // That the class is another one is said by its own check.
        _ if class.is_some_and(|class| class != found.class) => {
            Check { follows: true, ..Check::failed("order", format!("no order to compare with {limits}")) }
        }
        _ => Check::failed(
            "order",
            format!("no order to compare with {limits}: the series is {}", found.class),
        ),
    }
}

fn error_check(bound: ErrorBound, series: &ErrorSeries) -> Check {
    let [size, above, below] = [bound.size, bound.above, bound.below].map(rounded);
    let Some(found) = series.at(bound.size) else {
        return Check::failed("error", format!("there is no level of size {size}"));
    };
    match found.positive_error() {
        Err(undefined) => Check::failed("error", undefined.to_string()),
        Ok(error) => {
            let pass = error < bound.below && error >= bound.above;
            let statement = format!("error {} at size {size}", rounded(error));
            if error < bound.above {
                let words = ["", "suspiciously small: expected between"];
                return Check::compared(
                    "error",
                    pass,
                    error,
                    &statement,
                    words,
                    &format!("{above} and {below}"),
                );
            }
            Check::compared("error", pass, error, &statement, BELOW, &below)
        }
    }
}

/// How far the errors of the levels up to a size lie apart.
fn spread_check(bound: ErrorBound, series: &ErrorSeries) -> Check {
    let counted: Vec<f64> = series
        .levels()
        .iter()
        .filter(|level| level.size <= bound.size * (1.0 + 1e-9))
        .filter_map(|level| level.positive_error().ok())
        .collect();
    let count = counted.len();
    if count < 2 {
        let levels = count_of(count, "level", "levels");
        let reason = format!("{levels} up to size {}: too few for a spread", rounded(bound.size));
        return Check::failed("spread", reason);
    }
    let largest = counted.iter().copied().fold(0.0, f64::max);
    let smallest = counted.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = largest / smallest - 1.0;
    let statement = format!("errors of {count} levels lie within {:.3} %,", 100.0 * spread);
    Check::compared("spread", spread < bound.below, spread, &statement, BELOW, &number::bound(bound.below))
}

fn floor_check(band: FloorBand, series: &ErrorSeries, formal: Option<f64>, found: &Classification) -> Check {
    let without = [Class::NotEvaluable, Class::Divergent, Class::Oscillatory];
    if without.contains(&found.class) {
        return Check::failed("floor", format!("no error plateau to judge: the series is {}", found.class));
    }
    let levels = series.levels().len();
    if found.floor.is_none() && levels < FLOOR_LEVELS {
        let reason = format!("no error plateau to judge: {levels} levels cannot show one; add a level");
        return Check::failed("floor", reason);
    }
    // A floor may bend the series without governing it yet.
    let floor = found.floor.as_ref().map_or_else(|| hidden_floor(series, formal), |floor| floor.value);
    let (words, limits) = if band.below == f64::MAX {
        (["at least", "less than"], rounded(band.above))
    } else {
        (IN, format!("{} … {}", rounded(band.above), rounded(band.below)))
    };
    Check::compared(
        "floor",
        band.contains(floor),
        floor,
        &format!("error plateau {}", rounded(floor)),
        words,
        &limits,
    )
}

fn oscillation_check(bound: f64, oscillation: Option<f64>) -> Check {
    let Some(index) = oscillation.filter(|index| index.is_finite()) else {
        return Check::failed("oscillation", "the oscillation was not measured");
    };
    let statement = format!("oscillation {}", rounded(index));
    Check::compared("oscillation", index < bound, index, &statement, BELOW, &rounded(bound))
}

fn uncertainty_check(bound: f64, found: Option<&Result<NumericalUncertainty, Undefined>>) -> Check {
    let failed = |reason: &str| Check::failed("uncertainty", reason);
    match found {
        None => failed("the uncertainty was not measured"),
        Some(Err(undefined)) => failed(&format!("no uncertainty: {undefined}")),
        Some(Ok(found)) if !found.relative().is_finite() => {
            failed("a value of zero has no relative uncertainty")
        }
        Some(Ok(found)) => {
            let relative = found.relative();
            let statement = format!(
                "uncertainty {} of the value {} by {}",
                rounded(relative),
                rounded(found.finest()),
                found.estimator.name()
            );
            Check::compared("uncertainty", relative < bound, relative, &statement, BELOW, &rounded(bound))
        }
    }
}

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

/// Judges every expectation of a study that its tier can answer, with the paths of its records.
pub fn judge_paths(study: &Study, records: &[Record], paths: &StudyPaths<'_>, tier: Tier) -> Vec<Judgement> {
    let absent = Absent::among(records);
    let series = study.expectations.iter().filter(|expectation| expectation.tier <= tier);
    let cases = study.case_expectations.iter().filter(|expectation| expectation.tier <= tier);
    // Cases that were not run because their solver is missing are not judged; the check says so.
    let series = series.filter(|one| !absent.holds_series(one));
    let cases = cases.filter(|one| !absent.holds_cases(one));
    series
        .flat_map(|expectation| judge_expectation(expectation, paths.along(expectation.axis)))
        .chain(cases.flat_map(|expectation| expectation.judge(records)))
        .collect()
}

/// One judgement for each path that the expectation selects; where it selects none, one that fails.
pub(super) fn judge_expectation(expectation: &SeriesExpectation, all: &[Path<'_>]) -> Vec<Judgement> {
    let SeriesExpectation { measure, any_places, demand, selection, axis, line, .. } = expectation;
    let judge_path = |path: &Path<'_>, measure: &Measure, series: ErrorSeries| {
        let context = path.context(measure);
        let beside = path.beside(demand, measure, context.formal_order);
        let mut verdict = judge(demand, &series, &context, &beside);
        let missing = |record: &&Record| measure.elsewhere(record).or_else(|| measure.unjudged(record));
        let elsewhere = path.records.iter().find_map(missing);
        if let Some(place) = elsewhere.or_else(|| path.place(demand, measure)).filter(|_| !verdict.pass) {
            verdict.reason = format!("{}; {place}", verdict.reason);
        }
        let uncertainty = beside.uncertainty.and_then(Result::ok);
        Judgement { line: *line, subject: format!("{}: {measure}", path.label()), verdict, uncertainty }
    };
    let selected = all.iter().filter(|path| selection.fits_along(axis.name(), &path.records[0].case));
    let with_series = selected.map(|path| {
        let measure = if *any_places { path.own_measure(measure) } else { measure.clone() };
        let series = path.series(&measure);
        (path, measure, series)
    });
    let judgements: Vec<Judgement> = with_series
        .filter(|(_, _, series)| !series.levels().is_empty())
        .map(|(path, measure, series)| judge_path(path, &measure, series))
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

    /// Cases that were not begun, because nobody allowed their programs to start.
    pub fn held_back(&self, study: &Study) -> usize {
        self.skipped.iter().filter(|record| study.holds_back(&record.case)).count()
    }

    /// Whether a selection has cases, and all of them were skipped.
    pub fn holds_all(&self, is_selected: impl Fn(&Case) -> bool) -> bool {
        self.skipped.iter().any(|record| is_selected(&record.case))
            && !self.others.iter().any(|record| is_selected(&record.case))
    }

    /// Whether all cases of an expectation of series were skipped.
    fn holds_series(&self, one: &SeriesExpectation) -> bool {
        self.holds_all(|case| one.selection.fits_along(one.axis.name(), case))
    }

    /// Whether all cases of an expectation of cases were skipped, and it does not ask for that.
    fn holds_cases(&self, one: &CaseExpectation) -> bool {
        !one.asks_for_a_skip() && self.holds_all(|case| one.selection.fits(case))
    }

    /// Expectations of a tier that are not judged.
    pub fn unjudged(&self, study: &Study, tier: Tier) -> usize {
        let series = study.expectations.iter().filter(|one| one.tier <= tier && self.holds_series(one));
        let cases = study.case_expectations.iter().filter(|one| one.tier <= tier && self.holds_cases(one));
        series.count() + cases.count()
    }

    /// Golden values without those of skipped cases.
    pub fn without(&self, mut golden: GoldenFile) -> GoldenFile {
        let labels: BTreeSet<String> = self.skipped.iter().map(|record| record.case.label()).collect();
        golden.values.retain(|key, _| !labels.contains(&*key.case));
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
            format!(
                "{solver}: {} skipped and not judged: {why}",
                count_of(records.len(), "case was", "cases were")
            )
        };
        by_solver.iter().map(sentence).collect()
    }
}

/// One sentence for each case whose solver gives different results when repeated.
pub fn differing_repeats(records: &[Record]) -> Vec<String> {
    let note = |record: &Record| {
        let note = record.outside_run()?.notes.first()?;
        Some(format!("{}: {note}", record.case.label()))
    };
    records.iter().filter_map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::record::Status;
    use oedometer_problem::outcome::{Failure, FailureKind};

    fn records() -> Vec<Record> {
        let mut records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\ncells = [2, 4]\n",
        );
        let reason = "it reports that it cannot run here".to_owned();
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
        assert!(told.len() == 1 && told[0].contains("MPM: 1 case was skipped"), "{told:?}");
        // Golden values of others stay, however alike their labels are.
        let [skipped, run] = [0, 1].map(|place: usize| records[place].case.label());
        let name = |label: &str| crate::golden::measure::key(label, None, "steps");
        let kept = [name(&run), name(&format!("{skipped}5")), name(&format!("VP, {skipped}"))];
        let mut golden = GoldenFile::of("t", &[], "test");
        golden.values = kept.iter().chain([&name(&skipped)]).map(|name| (name.clone(), 1.0)).collect();
        assert_eq!(absent.without(golden).values, kept.map(|name| (name, 1.0)).into());
    }

    #[test]
    fn what_is_not_judged_is_counted_in_the_tiers_that_run() {
        let expected = |block: &str, tier: &str, demand: &str| {
            format!("[[{block}]]\ncells = 2\ntier = '{tier}'\n{demand}\n")
        };
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2, 4]\n";
        let study = |tiers: [&str; 2]| {
            study_of(
                "t",
                &(text.to_owned()
                    + &tiers.map(|tier| expected("expect_case", tier, "status = 'ok'")).concat()),
            )
        };
        let records = records();
        let absent = Absent::among(&records);
        for (tiers, counts) in [(["ci", "full"], [1, 2]), (["full", "full"], [0, 2]), (["ci", "ci"], [2, 2])]
        {
            assert_eq!(
                [Tier::Ci, Tier::Full].map(|tier| absent.unjudged(&study(tiers), tier)),
                counts,
                "{tiers:?}"
            );
        }
    }
}
