//! The class of a series of errors, decided before any order is quoted.

use crate::class::all_levels::judge_all_levels;
use crate::class::evaluable_series::{EvaluableSeries, FLOOR_LEVELS};
use crate::class::finest_window::judge_window;
use crate::class::{Class, Classification, Context};
use crate::fit::approach_to_limit::{Limit, fit_cancelling, limit_of};
use crate::fit::floor::LimiterKind;
use crate::fit::odd_level::odd_level;
use crate::orders::{WINDOW, pair_orders};
use crate::series::{ErrorSeries, Undefined};
use oedometer_wording::{orders, rounded};

/// Neighbouring sizes closer than this give no order worth quoting: at a ratio of 1.1 an error
/// in the error of 1 % is one of 0.1 in the order. (Celik et al. 2008 ask for 1.3.)
const LEAST_RATIO: f64 = 1.15;

/// Pair orders smaller than this, of either sign, are a standstill and not a direction.
const FLAT: f64 = 0.15;

/// Below this order refining no longer helps.
const STALLED: f64 = 0.3;

/// Errors within this factor over the finest levels are a plateau.
const PLATEAU: f64 = 1.5;

/// Errors that grow by less than this in all may stand still.
const GROWN: f64 = 1.3;

/// A body that reaches less than this share of its displacement on every mesh is locked.
const LEAST_MOBILITY: f64 = 0.5;

/// The advice for errors and values that go up and down.
const LOOK_FOR_NOISE: &str = "look for cell crossing, waves or a start that differs from level to level";

/// The class of a series, with its reason.
///
/// The checks run in a fixed order and the first that applies decides:
///
/// 1. an invalid context (`not-evaluable`), errors that are all round-off (`exact`), levels that are
///    missing, too few or too close (`not-evaluable`), a body that hardly moves (`locked`);
/// 2. a finest error of round-off, errors within a tolerance that do not fall, and a limit that is not zero
///    (`floor-limited`; `pre-asymptotic` where only three levels say so), before any growth;
/// 3. signs that change on the three finest levels (`oscillatory`; `pre-asymptotic` for a single change), growth
///    (`divergent`), plateaus (`floor-limited`; `pre-asymptotic` on three levels), ups and downs
///    (`oscillatory`, `divergent`), alternating orders (`oscillatory`);
/// 4. a series that falls steadily is judged on its finest window: `asymptotic`, `pre-asymptotic`,
///    `contaminated`, `superconvergent` or `floor-limited`. Five levels and more may show a floor, a lower order or a
///    logarithm that the window does not.
///
/// A single level that all others contradict is named beside any class. A reference no better than the
/// smallest error turns a class of step 4, or `pre-asymptotic`, into `not-evaluable`.
pub fn classify(series: &ErrorSeries, context: &Context) -> Classification {
    let classification = wrong_context(context)
        .or_else(|| exact(series, context))
        .or_else(|| not_evaluable(series))
        .or_else(|| locked(context));
    if let Some(classification) = classification {
        return classification;
    }
    let evaluated =
        series.points().and_then(|points| Ok(EvaluableSeries::new(&points, context)?.classify(context)));
    let classification =
        evaluated.unwrap_or_else(|undefined| Classification::new(Class::NotEvaluable, undefined.to_string()));
    let levels = series.levels();
    if !levels.windows(2).all(|pair| pair[0].error == pair[1].error) {
        return classification;
    }
    let reason = format!(
        "the errors are identical on all levels, as if from a single result; {}",
        classification.reason
    );
    Classification { reason, ..classification }.advise("check that each level has the result of its own mesh")
}

fn wrong_context(context: &Context) -> Option<Classification> {
    // A round-off or a reference error of exactly 0 is a valid claim.
    let claimed = |value: Option<f64>| value.filter(|value| *value != 0.0);
    let given = [
        ("formal order", context.formal_order),
        ("round-off", claimed(context.round_off)),
        ("tolerance", claimed(context.tolerance)),
        ("reference accuracy", claimed(context.reference_accuracy)),
    ];
    given.into_iter().find_map(|(name, value)| {
        let wrong = value.filter(|value| !value.is_finite() || *value <= 0.0)?;
        let reason = format!("the {name} {} is invalid: expected a positive number", rounded(wrong));
        Some(Classification::new(Class::NotEvaluable, reason))
    })
}

/// Whether the body moves less than half as far as it should on every mesh: its errors under refinement are
/// then those of a body at a standstill.
fn locked(context: &Context) -> Option<Classification> {
    if context.mobility.is_empty() || !context.mobility.iter().all(|share| *share < LEAST_MOBILITY) {
        return None;
    }
    let shares: Vec<String> =
        context.mobility.iter().map(|share| format!("{:.1} %", 100.0 * share)).collect();
    let reason =
        format!("the body reaches only {} of its displacement: volumetric locking", shares.join(", "));
    Some(
        Classification::new(Class::Locked, reason).advise(
            "evaluate the divergence at the cell centres, also for the skeleton if it is incompressible",
        ),
    )
}

fn exact(series: &ErrorSeries, context: &Context) -> Option<Classification> {
    let round_off = context.round_off.unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let is_round_off = |error: &f64| (0.0..=round_off).contains(error);
    let errors: Vec<f64> =
        series.levels().iter().filter_map(|level| level.error.filter(is_round_off)).collect();
    (!errors.is_empty() && errors.len() == series.levels().len()).then(|| {
        let largest = rounded(errors.iter().copied().fold(0.0, f64::max));
        Classification::new(Class::Exact, format!("every error is round-off: the largest is {largest}"))
            .advise("check that the result is not compared with itself; only a harder problem shows an order")
    })
}

fn not_evaluable(series: &ErrorSeries) -> Option<Classification> {
    let levels = series.levels();
    let undefined = series.points().err();
    let reason = match undefined {
        Some(Undefined::Vanishing { size }) => {
            let reason = format!(
                "the error at size {} vanishes while the others do not: no discretisation does that",
                rounded(size)
            );
            let advice = "check whether that level was compared with itself, or was not run";
            return Some(Classification::new(Class::NotEvaluable, reason).advise(advice));
        }
        Some(other) => other.to_string(),
        None if levels.len() < WINDOW => {
            let between = match pair_orders(series).as_slice() {
                [Ok(order)] => format!(" with the order {order:.2} between them"),
                _ => String::new(),
            };
            format!("{} levels{between}: a class needs {WINDOW}, for two orders", levels.len())
        }
        None => {
            let close = levels.windows(2).find(|pair| pair[0].size < LEAST_RATIO * pair[1].size)?;
            let ratio = close[0].size / close[1].size;
            let [coarse, fine] = [close[0], close[1]].map(|level| rounded(level.size));
            format!(
                "sizes {coarse} and {fine} are too close for an order: their ratio is {ratio:.3}, but \
                 {LEAST_RATIO} is needed"
            )
        }
    };
    Some(Classification::new(Class::NotEvaluable, reason))
}

impl EvaluableSeries<'_> {
    fn classify(&self, context: &Context) -> Classification {
        let classification = self
            .round_off(context)
            .or_else(|| self.within_tolerance(context))
            .or_else(|| self.limit())
            .or_else(|| self.changes_of_sign())
            .or_else(|| self.growth())
            .or_else(|| self.plateau())
            .or_else(|| self.ups_and_downs())
            .or_else(|| self.alternation())
            .unwrap_or_else(|| judge_all_levels(self, judge_window(self)));
        self.with_odd_level(self.poor_reference(context, &classification).unwrap_or(classification))
    }

    /// Names a level that the others contradict: the window of the finest levels may not see it.
    fn with_odd_level(&self, classification: Classification) -> Classification {
        let Some(odd) = odd_level(self.points) else { return classification };
        let [size, factor] = [odd.size, odd.factor].map(rounded);
        let reason = format!(
            "{}; the level of size {size} is an outlier: its error is {factor} times the value that the others suggest",
            classification.reason
        );
        let advice = classification
            .advice
            .clone()
            .unwrap_or_else(|| format!("check that the level of size {size} is a run of the same case"));
        Classification { reason, ..classification }.advise(advice)
    }

    /// A limit that is not zero, approached from either side.
    fn limit(&self) -> Option<Classification> {
        Some(match limit_of(&self.values)? {
            Limit::Confirmed(approach) => self.approaching(&approach),
            Limit::Suggested(approach) => self.seen_floor().unwrap_or_else(|| self.may_approach(&approach)),
            Limit::Reached => self.limited(&self.standstill()),
        })
    }

    /// A floor that the levels show by standing still, or by a dip that all of them fit: such a floor needs no
    /// guessed limit.
    fn seen_floor(&self) -> Option<Classification> {
        let still = self.plateau().filter(|still| still.class == Class::FloorLimited);
        still.or_else(|| fit_cancelling(self.points).ok().map(|fit| self.cancelled(&fit)))
    }

    /// Errors that change sign on the finest window have no order. A single change may be a passage through zero
    /// on the way to a limit; two are an oscillation. A change before the window is one of levels too coarse to
    /// count.
    fn changes_of_sign(&self) -> Option<Classification> {
        let changes = |values: &[(f64, f64)]| {
            values.windows(2).filter(|pair| pair[0].1.signum() != pair[1].1.signum()).count()
        };
        if changes(&self.values[self.values.len() - WINDOW..]) == 0 {
            return None;
        }
        let values: Vec<String> = self.values.iter().map(|value| rounded(value.1)).collect();
        let values = values.join(", ");
        let times = changes(&self.values);
        Some(if times > 1 {
            let reason = format!("the sign changes {times} times from level to level: {values}");
            Classification::new(Class::Oscillatory, reason).advise(LOOK_FOR_NOISE)
        } else {
            let reason =
                format!("the sign changes on the three finest levels, where no order is defined: {values}");
            Classification::new(Class::PreAsymptotic, reason)
                .advise("add a finer level: it distinguishes a single zero crossing from an oscillation")
        })
    }

    /// Errors of the finest window within a tolerance that do not fall steadily: the digits of the data or of the
    /// arithmetic, whichever way they move.
    fn within_tolerance(&self, context: &Context) -> Option<Classification> {
        let tolerance = context.tolerance?;
        let window = &self.values[self.values.len() - WINDOW..];
        let is_within = window.iter().all(|value| value.1.abs() <= tolerance);
        let pairs = &self.pairs[self.pairs.len() + 1 - WINDOW..];
        let falls = pairs.iter().all(|order| *order > FLAT) && self.order >= STALLED;
        if !is_within || falls {
            return None;
        }
        let [.., size, error] = self.ends();
        let reason = format!(
            "the errors of the finest levels, {error} at size {size}, do not fall and lie within a tolerance of {}",
            rounded(tolerance)
        );
        let mut classification = self.limited(&reason);
        if let Some(floor) = &mut classification.floor {
            floor.limiter = Some(LimiterKind::RoundOff);
        }
        Some(classification.advise(
            "check the digits of the data and the tolerance of the solver: they limit the error here",
        ))
    }

    /// Rises that no fall makes up for, and that go on: a small rise before levels that stand still is a floor.
    fn growth(&self) -> Option<Classification> {
        let falls = self.pairs.iter().any(|order| *order > FLAT);
        let rises =
            self.pairs.iter().any(|order| *order < -FLAT) || self.finest().1 > GROWN * self.coarsest().1;
        let last = self.pairs.last().copied().unwrap_or(f64::NAN);
        let is_small = self.finest().1 <= GROWN * self.coarsest().1 || last >= 0.0;
        let stands_still = self.order.abs() <= FLAT && last >= -FLAT && is_small;
        let [coarse, first, fine, last] = self.ends();
        (rises && !falls && !stands_still).then(|| {
            let reason = format!(
                "the error grows under refinement, from {first} at size {coarse} to {last} at {fine}"
            );
            Classification::new(Class::Divergent, reason)
                .advise("check stability, and the reference: the method does not converge to it")
        })
    }

    fn round_off(&self, context: &Context) -> Option<Classification> {
        let round_off = context.round_off.filter(|round_off| self.finest().1 <= *round_off)?;
        let [.., size, error] = self.ends();
        let mut classification = self
            .limited(&format!("the error at size {size}, {error}, is round-off ({})", rounded(round_off)));
        if let Some(floor) = &mut classification.floor {
            floor.limiter = Some(LimiterKind::RoundOff);
        }
        Some(classification.advise("drop the finest levels: they show round-off"))
    }

    /// The finest levels stand still.
    fn plateau(&self) -> Option<Classification> {
        let last = *self.pairs.last()?;
        let stalled = (-FLAT..STALLED).contains(&last);
        let window = &self.points[self.points.len() - WINDOW..];
        let highest = window.iter().map(|point| point.1).fold(0.0, f64::max);
        let lowest = window.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        let level = self.order.abs() < STALLED && highest <= PLATEAU * lowest;
        let fell = self.coarsest().1 > PLATEAU * highest;
        let still = self.pairs.iter().all(|order| order.abs() <= FLAT);
        (stalled || still || (level && fell)).then(|| {
            if self.points.len() < FLOOR_LEVELS {
                return self.may_be_limited(&self.standstill(), self.finest().1);
            }
            self.limited(&self.standstill())
        })
    }

    fn standstill(&self) -> String {
        let (before, earlier) = self.points[self.points.len() - 2];
        let [before, earlier] = [before, earlier].map(rounded);
        let [.., size, error] = self.ends();
        format!("refining from size {before} to {size} leaves the error at {error} (was {earlier})")
    }

    /// Changes of direction, standstills left out.
    fn ups_and_downs(&self) -> Option<Classification> {
        let moves: Vec<_> = self.pairs.iter().filter(|order| order.abs() > FLAT).collect();
        let turns = moves.windows(2).filter(|pair| (*pair[0] > 0.0) != (*pair[1] > 0.0)).count();
        let [coarse, first, fine, last] = self.ends();
        if turns > 1 {
            let reason = format!(
                "the error changes direction {turns} times between {first} at size {coarse} and {last} at {fine}: orders {}",
                orders(&self.pairs)
            );
            return Some(Classification::new(Class::Oscillatory, reason).advise(LOOK_FOR_NOISE));
        }
        moves.last().filter(|order| ***order < 0.0)?;
        if let Ok(fit) = fit_cancelling(self.points) {
            return Some(self.cancelled(&fit));
        }
        let least = self.points.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let [size, error] = [least.0, least.1].map(rounded);
        let reason = format!("the error falls to {error} at size {size} and grows again to {last} at {fine}");
        Some(Classification::new(Class::Divergent, reason).advise(
            "check stability on the fine levels, and look for two errors of opposite sign that cancel",
        ))
    }

    /// The error falls throughout, and its order alternates.
    fn alternation(&self) -> Option<Classification> {
        let [a, b, c] = *self.pairs.last_chunk::<3>()?;
        let (first, second) = (b - a, c - b);
        let jumps = first * second < 0.0 && first.abs().min(second.abs()) > 0.5;
        jumps.then(|| {
            let reason = format!("the order alternates under refinement: {}", orders(&self.pairs));
            Classification::new(Class::Oscillatory, reason)
                .advise("check that every level has the same points per cell and the same step rule")
        })
    }

    /// Errors near the accuracy of the reference prove no order.
    fn poor_reference(&self, context: &Context, classification: &Classification) -> Option<Classification> {
        let judged = [Class::FloorLimited, Class::Divergent, Class::Oscillatory];
        let least = self.points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        let accuracy = context.reference_accuracy.filter(|accuracy| 10.0 * accuracy > least)?;
        (!judged.contains(&classification.class)).then(|| {
            let [accuracy, least] = [accuracy, least].map(rounded);
            let reason =
                format!("the reference is only accurate to {accuracy}, and the smallest error is {least}");
            Classification::new(Class::NotEvaluable, reason).advise(
                "use a reference ten times better than the smallest error, or leave out the finest levels",
            )
        })
    }
}
