//! Holds a series of errors against what a study expects of it.
//!
//! Every comparison is written so that NaN fails, everything asked is judged, and a missing row
//! is a failure.

use serde::{Deserialize, Serialize};

use oedometer_convergence::class::classify::classify;
use oedometer_convergence::class::evaluable_series::FLOOR_LEVELS;
use oedometer_convergence::class::{Class, Classification, Context};
use oedometer_convergence::fit::bending_order::{Bend, explain};
use oedometer_convergence::fit::floor::fit_floor;
use oedometer_convergence::series::{ErrorSeries, Undefined};
use oedometer_convergence::series_demand::{ErrorBound, FloorBand, OrderBand, SeriesDemand};
use oedometer_convergence::uncertainty::NumericalUncertainty;
use oedometer_soil::wording::{order, short};

/// How a verdict came out, the known failures told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VerdictOutcome {
    /// Everything expected was found.
    Passed,
    /// Something was not.
    Failed,
    /// Something was not, and that was known.
    KnownFailure,
    /// Everything was found, and a strict known failure said that it would not be.
    UnexpectedPass,
}

/// One thing that was asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// `expectation`, `rows`, `class`, `order`, `error`, `spread`, `floor`, `oscillation` or `uncertainty`.
    pub name: String,
    /// Whether it is met.
    pub pass: bool,
    /// The number judged, where there is one; always finite.
    pub measured: Option<f64>,
    /// What was wanted and what was found.
    pub reason: String,
}

/// The judgement of one series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Whether a gate lets it through.
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

/// What is measured of the runs beside their errors, where an expectation asks for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// Oscillation index of the run that the expectation is about.
    pub oscillation: Option<f64>,
    /// Numerical uncertainty of the value, or why it has none.
    pub uncertainty: Option<Result<NumericalUncertainty, Undefined>>,
}

/// Judges a series. Where the context names no formal order, the order expected serves as one.
pub fn judge(
    expectation: &SeriesDemand,
    series: &ErrorSeries,
    context: &Context,
    beside: &Beside,
) -> Verdict {
    let formal_order = context.formal_order.or(expectation.order.map(|band| band.value));
    let context = Context { formal_order, ..context.clone() };
    let classification = classify(series, &context);
    let problems = expectation.problems();
    let mut checks = Vec::new();
    if !problems.is_empty() {
        checks.push(check("expectation", false, None, problems.join("; ")));
    }
    if expectation.class != Some(Class::NotEvaluable) {
        checks.push(rows(series, expectation.class));
    }
    let class = expectation.expected_class();
    checks.extend(class.map(|class| class_found(class, &classification)));
    checks.extend(expectation.order.map(|band| order_found(band, class, &classification)));
    checks.extend(expectation.at.map(|bound| error_found(bound, series)));
    checks.extend(expectation.spread.map(|bound| spread_found(bound, series)));
    checks.extend(expectation.floor.map(|band| floor_found(band, series, formal_order, &classification)));
    checks.extend(expectation.oscillation_below.map(|bound| oscillation_found(bound, beside.oscillation)));
    checks.extend(
        expectation.uncertainty_below.map(|bound| uncertainty_found(bound, beside.uncertainty.as_ref())),
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
    let sentence =
        |checks: &[&Check]| checks.iter().map(|check| check.reason.as_str()).collect::<Vec<_>>().join("; ");
    // A known failure pardons a wrong result, not an absent one.
    let absent = !failed.is_empty() && classification.class == Class::NotEvaluable
        || failed.iter().any(|check| check.name == "rows");
    match (&expectation.xfail, failed.is_empty()) {
        (Some(known), false) if sound && !absent => {
            let why = sentence(&failed);
            (VerdictOutcome::KnownFailure, format!("known failure ({}): {why}", known.reason))
        }
        (Some(known), true) if known.strict => (
            VerdictOutcome::UnexpectedPass,
            format!("passes, though marked as a known failure ({}): remove the mark", known.reason),
        ),
        (_, true) => (VerdictOutcome::Passed, sentence(&checks.iter().collect::<Vec<_>>())),
        (_, false) => (VerdictOutcome::Failed, sentence(&failed)),
    }
}

/// Something that was asked, judged.
pub(crate) fn check(name: &str, pass: bool, measured: Option<f64>, reason: String) -> Check {
    let measured = measured.filter(|value| value.is_finite());
    Check { name: name.to_owned(), pass, measured, reason }
}

/// Every level is there with a finite error; one of zero is allowed where exactness is expected.
fn rows(series: &ErrorSeries, class: Option<Class>) -> Check {
    let exact = class == Some(Class::Exact);
    let zero = |error: Option<f64>| error.is_some_and(|error| (0.0..1e-300).contains(&error));
    let obstacle = series
        .levels()
        .iter()
        .filter(|level| !(exact && zero(level.error)))
        .find_map(|level| level.positive_error().err());
    match (obstacle, series.check_sizes()) {
        _ if series.levels().is_empty() => check("rows", false, None, "there are no rows".into()),
        (Some(obstacle), _) | (None, Err(obstacle)) => check("rows", false, None, obstacle.to_string()),
        (None, Ok(())) => check("rows", true, None, format!("{} levels", series.levels().len())),
    }
}

fn class_found(wanted: Class, found: &Classification) -> Check {
    let pass = found.class == wanted;
    let reason = if pass {
        format!("{}: {}", found.class, found.reason)
    } else {
        let advice = found.advice.as_deref().map_or_else(String::new, |text| format!(" ({text})"));
        format!("{} instead of {wanted}: {}{advice}", found.class, found.reason)
    };
    check("class", pass, None, reason)
}

fn order_found(band: OrderBand, class: Option<Class>, found: &Classification) -> Check {
    let limits = format!("{} … {}", order(band.value - band.minus), order(band.value + band.plus));
    match found.order {
        Some(measured) if class == Some(found.class) => {
            let pass = band.contains(measured);
            let inside = if pass { "in" } else { "outside" };
            let reason = format!("order {} {inside} {limits}", order(measured));
            check("order", pass, Some(measured), reason)
        }
        _ => {
            let reason = format!("no order to hold against {limits}: the series is {}", found.class);
            check("order", false, None, reason)
        }
    }
}

fn error_found(bound: ErrorBound, series: &ErrorSeries) -> Check {
    let level = format!("size {}", short(bound.size));
    let Some(found) = series.at(bound.size) else {
        return check("error", false, None, format!("there is no level of {level}"));
    };
    match found.positive_error() {
        Err(undefined) => check("error", false, None, undefined.to_string()),
        Ok(error) => {
            let pass = error < bound.below && error >= bound.above;
            let relation = match (error < bound.below, error >= bound.above) {
                (true, true) => "below",
                (true, false) => "too good: expected between",
                (false, _) => "not below",
            };
            let below = match relation {
                "too good: expected between" => format!("{} and {}", short(bound.above), short(bound.below)),
                _ => short(bound.below),
            };
            let reason = format!("error {} at {level} {relation} {below}", short(error));
            check("error", pass, Some(error), reason)
        }
    }
}

/// How far the errors of the levels up to a size lie apart.
fn spread_found(bound: ErrorBound, series: &ErrorSeries) -> Check {
    let counted: Vec<f64> = series
        .levels()
        .iter()
        .filter(|level| level.size <= bound.size * (1.0 + 1e-9))
        .filter_map(|level| level.positive_error().ok())
        .collect();
    if counted.len() < 2 {
        let reason = format!("{} levels up to size {} have no spread", counted.len(), short(bound.size));
        return check("spread", false, None, reason);
    }
    let largest = counted.iter().copied().fold(0.0, f64::max);
    let smallest = counted.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = largest / smallest - 1.0;
    let pass = spread < bound.below;
    let relation = if pass { "below" } else { "not below" };
    let reason = format!(
        "errors of {} levels lie within {:.3} %, {relation} {} %",
        counted.len(),
        100.0 * spread,
        short(100.0 * bound.below)
    );
    check("spread", pass, Some(spread), reason)
}

fn floor_found(band: FloorBand, series: &ErrorSeries, formal: Option<f64>, found: &Classification) -> Check {
    let without = [Class::NotEvaluable, Class::Divergent, Class::Oscillatory];
    if without.contains(&found.class) {
        let reason = format!("no floor to judge: the series is {}", found.class);
        return check("floor", false, None, reason);
    }
    let levels = series.levels().len();
    if found.floor.is_none() && levels < FLOOR_LEVELS {
        let reason = format!("no floor to judge: {levels} levels cannot tell one from none, add a level");
        return check("floor", false, None, reason);
    }
    let floor = found.floor.as_ref().map_or_else(|| hidden_floor(series, formal), |floor| floor.value);
    let pass = band.contains(floor);
    let inside = if pass { "in" } else { "outside" };
    let reason = format!("floor {} {inside} {} … {}", short(floor), short(band.above), short(band.below));
    check("floor", pass, Some(floor), reason)
}

/// A floor that bends the series without governing it yet, or 0.
fn hidden_floor(series: &ErrorSeries, formal: Option<f64>) -> f64 {
    let bent = series.points().ok().and_then(|points| explain(&points, formal));
    match (bent, fit_floor(series)) {
        (Some(Bend::Floor(_)), Ok(fit)) => fit.significant_floor(),
        _ => 0.0,
    }
}

fn oscillation_found(bound: f64, oscillation: Option<f64>) -> Check {
    let Some(index) = oscillation.filter(|index| index.is_finite()) else {
        return check("oscillation", false, None, "the oscillation was not measured".into());
    };
    let pass = index < bound;
    let relation = if pass { "below" } else { "not below" };
    let reason = format!("oscillation {} {relation} {}", short(index), short(bound));
    check("oscillation", pass, Some(index), reason)
}

fn uncertainty_found(bound: f64, found: Option<&Result<NumericalUncertainty, Undefined>>) -> Check {
    let found = match found {
        Some(Ok(found)) if found.relative().is_finite() => found,
        Some(Ok(_)) => {
            return check("uncertainty", false, None, "a value of zero has no relative uncertainty".into());
        }
        Some(Err(undefined)) => {
            return check("uncertainty", false, None, format!("no uncertainty: {undefined}"));
        }
        None => return check("uncertainty", false, None, "the uncertainty was not measured".into()),
    };
    let relative = found.relative();
    let pass = relative < bound;
    let relation = if pass { "below" } else { "not below" };
    let reason = format!(
        "uncertainty {} of the value {} by {} {relation} {}",
        short(relative),
        short(found.finest()),
        found.estimator.name(),
        short(bound)
    );
    check("uncertainty", pass, Some(relative), reason)
}
