//! Puts a series of errors into a class, before any order is quoted.
//!
//! The checks run in a fixed order and the first that applies decides:
//!
//! 1. a context of nonsense (`not-evaluable`), errors that are all round-off (`exact`), levels that are
//!    missing, too few or too close (`not-evaluable`), a body that hardly moves (`locked`);
//! 2. a finest error of round-off, and a limit that is not zero (`floor-limited`; `pre-asymptotic` where
//!    only three levels say so), before any growth;
//! 3. signs that change on the finest window (`oscillatory`; `pre-asymptotic` for a single change), growth
//!    (`divergent`), plateaus (`floor-limited`; `pre-asymptotic` on three levels), ups and downs
//!    (`oscillatory`, `divergent`), alternating orders (`oscillatory`);
//! 4. what is left falls steadily, and is judged on its finest window in [`window`](crate::class::finest_window).
//!
//! A single level that all others contradict is named beside any class.
//!
//! Last, evidence of a reference no better than the smallest error makes a class of step 4, or a
//! `pre-asymptotic` one, `not-evaluable`.

use crate::class::evaluable_series::{EvaluableSeries, FLOOR_LEVELS, advised, plain};
use crate::class::finest_window::judge_window;
use crate::class::{Class, Classification, Context};
use crate::fit::approach_to_limit::{Limit, limit_of};
use crate::fit::cancelling_terms::fit_cancelling;
use crate::fit::odd_level::odd_level;
use crate::limiter::LimiterKind;
use crate::orders::{WINDOW, pair_orders};
use crate::series::{ErrorSeries, Undefined};
use oedometer_soil::wording::{orders, short};

/// Neighbouring sizes closer than this give no order worth quoting: at a ratio of 1.1 an error
/// in the error of 1 % is one of 0.1 in the order. (Celik et al. 2008 ask for 1.3.)
pub const LEAST_RATIO: f64 = 1.15;

/// Pair orders smaller than this, of either sign, are a standstill and not a direction.
const FLAT: f64 = 0.15;

/// Below this order refining no longer helps.
const STALLED: f64 = 0.3;

/// Errors within this factor over the finest levels are a plateau.
const PLATEAU: f64 = 1.5;

/// The class of a series, with its reason.
pub fn classify(series: &ErrorSeries, context: &Context) -> Classification {
    let found = wrong_context(context)
        .or_else(|| exact(series, context))
        .or_else(|| not_evaluable(series))
        .or_else(|| locked(context));
    if let Some(found) = found {
        return found;
    }
    let evaluated = series.points().and_then(|points| {
        let case = EvaluableSeries::of(&points, context)?;
        Ok(case.classify(context))
    });
    evaluated.unwrap_or_else(|undefined| plain(Class::NotEvaluable, undefined.to_string()))
}

fn wrong_context(context: &Context) -> Option<Classification> {
    // A round-off or a reference error of exactly 0 is a claim, and a legal one.
    let claimed = |value: Option<f64>| value.filter(|value| *value != 0.0);
    let given = [
        ("formal order", context.formal_order),
        ("round-off", claimed(context.round_off)),
        ("reference accuracy", claimed(context.reference_accuracy)),
    ];
    given.into_iter().find_map(|(name, value)| {
        let wrong = value.filter(|value| !value.is_finite() || *value <= 0.0)?;
        Some(plain(Class::NotEvaluable, format!("the {name} given, {}, is none", short(wrong))))
    })
}

/// A body that reaches less than this share of its displacement on the finest mesh is locked.
const LEAST_MOBILITY: f64 = 0.5;

/// A body that gives way less than half of what it should on every mesh: whatever its errors do
/// under refinement, they are those of a body at a standstill.
fn locked(context: &Context) -> Option<Classification> {
    if context.mobility.is_empty() || !context.mobility.iter().all(|share| *share < LEAST_MOBILITY) {
        return None;
    }
    let shares: Vec<String> =
        context.mobility.iter().map(|share| format!("{:.1} %", 100.0 * share)).collect();
    Some(advised(
        Class::Locked,
        format!("the body reaches {} of its displacement: volumetric locking", shares.join(", ")),
        "take the divergence at the cell centres, for the skeleton too where that is what is incompressible",
    ))
}

fn exact(series: &ErrorSeries, context: &Context) -> Option<Classification> {
    let round_off = context.round_off.unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let levels = series.levels();
    let below = |error: f64| (0.0..=round_off).contains(&error);
    if levels.is_empty() || !levels.iter().all(|level| level.error.is_some_and(below)) {
        return None;
    }
    let largest = levels.iter().filter_map(|level| level.error).fold(0.0, f64::max);
    let reason = format!("every error is round-off: the largest is {}", short(largest));
    Some(advised(
        Class::Exact,
        reason,
        "make sure that the result is not held against itself; a harder scene shows an order",
    ))
}

fn not_evaluable(series: &ErrorSeries) -> Option<Classification> {
    let levels = series.levels();
    let undefined = series.points().err();
    let reason = match undefined {
        Some(Undefined::Vanishing { size }) => {
            let reason = format!(
                "the error at size {} vanishes while others do not: no discretisation does that",
                short(size)
            );
            let advice = "look whether that level is held against itself, or was not run";
            return Some(advised(Class::NotEvaluable, reason, advice));
        }
        Some(other) => other.to_string(),
        None if levels.len() < WINDOW => {
            let between = match pair_orders(series).as_slice() {
                [Ok(order)] => format!(" with the order {order:.2} between them"),
                _ => String::new(),
            };
            format!("{} levels{between}: a class needs {WINDOW}, two orders to compare", levels.len())
        }
        None => {
            let close = levels.windows(2).find(|pair| pair[0].size < LEAST_RATIO * pair[1].size)?;
            let ratio = close[0].size / close[1].size;
            format!(
                "sizes {} and {} are too close for an order: ratio {ratio:.3}, {LEAST_RATIO} is needed",
                short(close[0].size),
                short(close[1].size)
            )
        }
    };
    Some(plain(Class::NotEvaluable, reason))
}

impl EvaluableSeries<'_> {
    fn classify(&self, context: &Context) -> Classification {
        let found = self
            .round_off(context)
            .or_else(|| self.limit())
            .or_else(|| self.changes_of_sign())
            .or_else(|| self.growth())
            .or_else(|| self.plateau())
            .or_else(|| self.ups_and_downs())
            .or_else(|| self.alternation())
            .unwrap_or_else(|| judge_window(self));
        let found = self.poor_reference(context, &found).unwrap_or(found);
        self.with_odd_level(found)
    }

    /// The classification with a level that the others contradict named: the window of the finest levels may not see it.
    fn with_odd_level(&self, found: Classification) -> Classification {
        let Some(odd) = odd_level(self.points) else { return found };
        let reason = format!(
            "{}; the level of size {} stands alone: its error is {} times what the others say",
            found.reason,
            short(odd.size),
            short(odd.factor)
        );
        let advice = found.advice.unwrap_or_else(|| {
            format!("look whether the level of size {} is a run of the same case", short(odd.size))
        });
        Classification { reason, advice: Some(advice), ..found }
    }

    /// A limit that is not zero, approached from either side.
    fn limit(&self) -> Option<Classification> {
        Some(match limit_of(&self.values)? {
            Limit::Confirmed(found) => self.approaching(&found),
            Limit::Suggested(found) => self.seen_floor().unwrap_or_else(|| self.may_approach(&found)),
            Limit::Reached => self.limited(&self.standstill()),
        })
    }

    /// A floor that the levels show by standing still, or by a dip that all of them fit: it needs no limit
    /// that is only guessed.
    fn seen_floor(&self) -> Option<Classification> {
        let still = self.plateau().filter(|still| still.class == Class::FloorLimited);
        still.or_else(|| fit_cancelling(self.points).ok().map(|fit| self.cancelled(&fit)))
    }

    /// Errors that change their sign on the finest window: between one of either sign there is no order. Once may be
    /// a passage through zero on the way to somewhere; twice is to and fro. A change before the window is
    /// that of levels too coarse to count.
    fn changes_of_sign(&self) -> Option<Classification> {
        let changes = |values: &[(f64, f64)]| {
            values.windows(2).filter(|pair| pair[0].1.signum() != pair[1].1.signum()).count()
        };
        let window = &self.values[self.values.len() - WINDOW..];
        if changes(window) == 0 {
            return None;
        }
        let values: Vec<String> = self.values.iter().map(|value| short(value.1)).collect();
        let values = values.join(", ");
        let times = changes(&self.values);
        Some(if times > 1 {
            advised(
                Class::Oscillatory,
                format!("the sign changes {times} times from level to level: {values}"),
                "look for cell crossing, waves or a start that differs from level to level",
            )
        } else {
            advised(
                Class::PreAsymptotic,
                format!("the sign changes on the finest window, and no order leads through zero: {values}"),
                "add a finer level: it tells a passage through zero from one to and fro",
            )
        })
    }

    /// Rises that no fall makes up for.
    fn growth(&self) -> Option<Classification> {
        let ((coarse, first), (fine, last)) = (self.coarsest(), self.finest());
        let falls = self.pairs.iter().any(|order| *order > FLAT);
        let rises = self.pairs.iter().any(|order| *order < -FLAT) || last > 1.3 * first;
        (rises && !falls).then(|| {
            advised(
                Class::Divergent,
                format!(
                    "the error grows under refinement, from {} at size {} to {} at {}",
                    short(first),
                    short(coarse),
                    short(last),
                    short(fine)
                ),
                "look at stability and at the reference: the method does not converge to it",
            )
        })
    }

    fn round_off(&self, context: &Context) -> Option<Classification> {
        let (size, error) = self.finest();
        let round_off = context.round_off.filter(|round_off| error <= *round_off)?;
        let reason = format!(
            "the error at size {}, {}, is round-off ({})",
            short(size),
            short(error),
            short(round_off)
        );
        let mut found = self.limited(&reason);
        if let Some(floor) = &mut found.floor {
            floor.limiter = Some(LimiterKind::RoundOff);
        }
        found.advice = Some("drop the finest levels: they show round-off".to_owned());
        Some(found)
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
        let ((size, error), (before, earlier)) = (self.finest(), self.points[self.points.len() - 2]);
        format!(
            "refining from size {} to {} leaves the error at {} (was {})",
            short(before),
            short(size),
            short(error),
            short(earlier)
        )
    }

    /// Changes of direction, standstills left out.
    fn ups_and_downs(&self) -> Option<Classification> {
        let moves: Vec<_> = self.pairs.iter().filter(|order| order.abs() > FLAT).collect();
        let turns = moves.windows(2).filter(|pair| (*pair[0] > 0.0) != (*pair[1] > 0.0)).count();
        let (coarse, fine) = (self.coarsest(), self.finest());
        if turns > 1 {
            let reason = format!(
                "the error turns {turns} times between {} at size {} and {} at {}: orders {}",
                short(coarse.1),
                short(coarse.0),
                short(fine.1),
                short(fine.0),
                orders(&self.pairs)
            );
            let advice = "look for cell crossing, waves or a start that differs from level to level";
            return Some(advised(Class::Oscillatory, reason, advice));
        }
        moves.last().filter(|order| ***order < 0.0)?;
        if let Ok(fit) = fit_cancelling(self.points) {
            return Some(self.cancelled(&fit));
        }
        let least = self.points.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(&fine);
        Some(advised(
            Class::Divergent,
            format!(
                "the error falls to {} at size {} and grows again to {} at {}",
                short(least.1),
                short(least.0),
                short(fine.1),
                short(fine.0)
            ),
            "look at stability on the fine levels, or for two errors of opposite sign that cancel",
        ))
    }

    /// The error falls throughout, and its order jumps to and fro.
    fn alternation(&self) -> Option<Classification> {
        let [a, b, c] = *self.pairs.last_chunk::<3>()?;
        let (first, second) = (b - a, c - b);
        let jumps = first * second < 0.0 && first.abs().min(second.abs()) > 0.5;
        jumps.then(|| {
            advised(
                Class::Oscillatory,
                format!("the order jumps to and fro under refinement: {}", orders(&self.pairs)),
                "look whether every level keeps the same path of points per cell and time step",
            )
        })
    }

    /// Errors that the reference is not good enough to show are no evidence of an order.
    fn poor_reference(&self, context: &Context, found: &Classification) -> Option<Classification> {
        let judged = [Class::FloorLimited, Class::Divergent, Class::Oscillatory];
        let least = self.points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        let accuracy = context.reference_accuracy.filter(|accuracy| 10.0 * accuracy > least)?;
        (!judged.contains(&found.class)).then(|| {
            advised(
                Class::NotEvaluable,
                format!(
                    "the reference is good to {} only, and the smallest error is {}",
                    short(accuracy),
                    short(least)
                ),
                "use a reference ten times better than the smallest error, or leave the finest levels out",
            )
        })
    }
}
