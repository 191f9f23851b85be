//! A series that can be evaluated, and the description of its floor.

use crate::class::{Class, Classification, Context, Floor};
use crate::fit::approach_to_limit::{Approach, CancellingFit};
use crate::fit::floor::{Limiter, LimiterKind, advice, fit_floor, identify};
use crate::orders::{WINDOW, log_ratio, pair_order, slope_of};
use crate::series::Undefined;
use oedometer_soil::elementary::powf;
use oedometer_wording::{order, rounded};
use std::f64::consts::LN_2;

/// A series that can be evaluated, with the numbers that the checks share.
pub struct EvaluableSeries<'a> {
    /// Sizes and errors from coarse to fine, all positive.
    pub points: &'a [(f64, f64)],
    /// Sizes and signed errors, where errors have a sign; else `points`.
    pub values: Vec<(f64, f64)>,
    /// Orders between neighbouring levels.
    pub pairs: Vec<f64>,
    /// Least-squares order on the finest window.
    pub order: f64,
    /// By how much the order between levels rises over the finest window, per halving of the size.
    pub drift: f64,
    /// Formal order, where known.
    pub formal: Option<f64>,
    /// What may put a floor under the errors.
    pub limiters: Vec<Limiter>,
}

/// Fewest levels on which a floor can be claimed: three show it, and a fourth could have refuted it.
pub const FLOOR_LEVELS: usize = 4;

/// The points with the signs of the values, where these are the errors with signs; else the points.
fn with_signs(points: &[(f64, f64)], signed: &[f64]) -> Vec<(f64, f64)> {
    let same = |(point, value): (&(f64, f64), &f64)| (value.abs() - point.1).abs() <= 1e-9 * point.1;
    if signed.len() != points.len() || !points.iter().zip(signed).all(same) {
        return points.to_vec();
    }
    points.iter().zip(signed).map(|(point, value)| (point.0, *value)).collect()
}

/// `, by the inertia`; for a cause of unknown height, that no other cause is known.
fn put_down_to(limiter: Option<&Limiter>) -> String {
    match limiter {
        None => String::new(),
        Some(limiter) if limiter.magnitude.is_some() => format!(", by {}", limiter.name),
        Some(limiter) => format!(", most likely by {}: no other cause is known", limiter.name),
    }
}

/// Change of the order from the last pair but one to the last, per halving of the size. An order between two
/// levels is that of the place half way between them in ln *h*, so that the two lie half of the window apart.
fn drift_per_halving(window: &[(f64, f64)], pairs: &[f64]) -> f64 {
    let ([first, .., last], [.., coarse, fine]) = (window, pairs) else { return f64::NAN };
    (fine - coarse) * LN_2 / (0.5 * log_ratio(first.0, last.0))
}

impl<'a> EvaluableSeries<'a> {
    /// A series of (size, error) points in a context.
    ///
    /// # Errors
    /// [`Undefined`] where its finest levels have no slope.
    pub fn new(points: &'a [(f64, f64)], context: &Context) -> Result<Self, Undefined> {
        let known = [
            (LimiterKind::Reference, "the reference's accuracy", context.reference_accuracy),
            (LimiterKind::RoundOff, "round-off", context.round_off),
        ];
        let mut limiters = context.limiters.clone();
        limiters.extend(known.into_iter().filter_map(|(kind, name, magnitude)| {
            let magnitude = Some(magnitude.filter(|magnitude| *magnitude > 0.0)?);
            Some(Limiter { magnitude, ..Limiter::new(kind, name) })
        }));
        let window = &points[points.len().saturating_sub(WINDOW)..];
        let pairs: Vec<f64> = points.windows(2).map(pair_order).collect();
        Ok(Self {
            points,
            values: with_signs(points, &context.signed),
            order: slope_of(window)?.order,
            drift: drift_per_halving(window, &pairs),
            pairs,
            formal: context.formal_order,
            limiters,
        })
    }

    /// Sizes and errors of the coarsest and the finest level, in words.
    pub fn ends(&self) -> [String; 4] {
        let (coarse, fine) = (self.coarsest(), self.finest());
        [coarse.0, coarse.1, fine.0, fine.1].map(rounded)
    }

    /// Size and error of the finest level.
    pub fn finest(&self) -> (f64, f64) {
        self.points.last().copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// Share of the finest error that a floor must have to explain the falling order over the finest window; 0 where
    /// the order does not fall.
    ///
    /// The error `C h^p + F` with the floor's share `s = F/e` has the order `q = p (1 − s)`, which falls by
    /// `d = p² s (1 − s)` per unit of ln *h*. Hence `p = q + d/q` and `s = d/(q² + d)`, half way between the last two
    /// levels. The lower the order, the smaller the drift that matters.
    pub fn floor_that_would_bend(&self) -> f64 {
        let [.., (before, _), (finest, _)] = *self.points else { return f64::NAN };
        let fall = (-self.drift / LN_2).max(0.0);
        let order = self.pairs.last().map_or(f64::NAN, |last| last.max(0.0));
        let half_way = fall / (order * order + fall);
        let without_floor = order + fall / order;
        half_way / (half_way + (1.0 - half_way) * powf(finest / before, 0.5 * without_floor))
    }

    /// Size and error of the coarsest level.
    pub fn coarsest(&self) -> (f64, f64) {
        self.points.first().copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// A floor-limited classification: which levels a floor limits, its cause, and how to lower it to a target.
    /// `reason` is the first half of the sentence.
    fn over_floor(
        &self,
        reason: &str,
        order: Option<f64>,
        target: Option<f64>,
        floor: (f64, bool),
    ) -> Classification {
        let (value, fitted) = floor;
        let limiter = identify(value, &self.limiters);
        let limits_from = self.points.iter().find(|(_, error)| *error <= 2.0 * value);
        let limits_from = limits_from.map_or(self.finest().0, |point| point.0);
        let cause = put_down_to(limiter);
        let reason = format!("{reason} limits the levels from size {} on{cause}", rounded(limits_from));
        let target = target.filter(|target| *target > 0.0);
        let floor = Floor { value, fitted, limits_from, limiter: limiter.map(|limiter| limiter.kind) };
        Classification { order, floor: Some(floor), ..Classification::new(Class::FloorLimited, reason) }
            .advise(advice(value, target, limiter, &self.limiters))
    }

    /// A converging error and a plateau of opposite sign that cancel at one level.
    pub fn cancelled(&self, fit: &CancellingFit) -> Classification {
        let target = 0.1 * fit.coefficient * powf(self.finest().0, fit.order);
        let [size, floor] = [fit.cancels_at, fit.floor].map(rounded);
        let reason = format!(
            "the error falls, cancels near size {size} and grows again to a plateau of {floor} with \
             opposite sign, which"
        );
        self.over_floor(&reason, Some(fit.order), Some(target), (fit.floor, true))
    }

    /// The first and the last value, in words.
    fn first_to_last(&self) -> String {
        let [first, last] =
            [self.values[0], self.values[self.values.len() - 1]].map(|value| rounded(value.1));
        format!("the error goes from {first} to {last}")
    }

    /// A series that approaches a limit which is not zero.
    pub fn approaching(&self, approach: &Approach) -> Classification {
        let target = 0.1 * (approach.at(self.finest().0) - approach.limit).abs();
        let reason = format!(
            "{} at order {} towards a limit of {}, and the finest level lies where the previous ones \
             predict: a plateau that",
            self.first_to_last(),
            order(approach.order),
            rounded(approach.limit)
        );
        self.over_floor(&reason, Some(approach.order), Some(target), (approach.limit.abs(), true))
    }

    /// A limit that the three finest levels suggest and no other level confirms.
    pub fn may_approach(&self, approach: &Approach) -> Classification {
        let next = 0.5 * self.finest().0;
        let reason = format!(
            "{} as if towards a limit of {} at order {}: {} levels cannot distinguish a limit from growth",
            self.first_to_last(),
            rounded(approach.limit),
            order(approach.order),
            self.points.len()
        );
        let advice = format!(
            "add a level: at size {} the limit predicts {}",
            rounded(next),
            rounded(approach.at(next))
        );
        Classification::new(Class::PreAsymptotic, reason).advise(advice)
    }

    /// The floor that a short series may have.
    pub fn may_be_limited(&self, reason: &str, height: f64) -> Classification {
        let limiter = identify(height, &self.limiters);
        let suspect = limiter.map_or_else(String::new, |limiter| format!(" ({})", limiter.name));
        let reason = format!(
            "{reason}; {} levels cannot distinguish a plateau of about {}{suspect} from an order that has \
             not settled",
            self.points.len(),
            rounded(height)
        );
        Classification::new(Class::PreAsymptotic, reason).advise(if self.points.len() < FLOOR_LEVELS {
            "add a finer level: a plateau shows only on four"
        } else {
            "add a finer level: a plateau stops the error, a lower order does not"
        })
    }

    /// Whether a power and a floor fit the levels far better than a power alone.
    pub fn has_significant_floor(&self) -> bool {
        fit_floor(self.points).is_ok_and(|fit| fit.significant)
    }

    /// A floor-limited classification with the floor fitted, its cause and advice.
    pub fn limited(&self, reason: &str) -> Classification {
        let fit = fit_floor(self.points).ok().filter(|fit| fit.significant && fit.residual < 0.1);
        let (size, error) = self.finest();
        let value = fit.map_or(error, |fit| fit.floor);
        let target = fit.map(|fit| 0.1 * fit.coefficient * powf(size, fit.order));
        let height = if fit.is_some() { "a plateau of" } else { "a plateau not above" };
        let reason = format!("{reason}; {height} {}", rounded(value));
        self.over_floor(&reason, fit.map(|fit| fit.order), target, (value, fit.is_some()))
    }
}
