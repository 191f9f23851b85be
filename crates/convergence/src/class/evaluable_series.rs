//! A series that can be evaluated, and how a floor under it is described.

use crate::class::{Class, Classification, Context, Floor};
use crate::fit::approach_to_limit::Approach;
use crate::fit::cancelling_terms::CancellingFit;
use crate::fit::floor::fit_floor;
use crate::limiter::{Limiter, LimiterKind, advice, identify};
use crate::orders::{WINDOW, log_ratio, slope_of};
use crate::series::{ErrorSeries, Undefined};
use oedometer_soil::elementary;
use oedometer_soil::wording::{order, short};
use std::f64::consts::LN_2;

/// A series that can be evaluated, with what the checks share.
pub struct EvaluableSeries<'a> {
    /// Sizes and errors from coarse to fine, all positive.
    pub points: &'a [(f64, f64)],
    /// The same with the errors' signs, where they have one.
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

/// A classification without order, floor and advice.
pub fn plain(class: Class, reason: String) -> Classification {
    Classification { class, reason, advice: None, order: None, floor: None }
}

/// A classification with advice.
pub fn advised(class: Class, reason: String, advice: &str) -> Classification {
    Classification { advice: Some(advice.to_owned()), ..plain(class, reason) }
}

/// Levels at which a floor can be claimed: three show it, and a fourth could have refuted it.
pub const FLOOR_LEVELS: usize = 4;

/// The points with the signs of values of the same size; as they are where the values are others.
fn with_signs(points: &[(f64, f64)], signed: &[f64]) -> Vec<(f64, f64)> {
    let same = |(point, value): (&(f64, f64), &f64)| (value.abs() - point.1).abs() <= 1e-9 * point.1;
    if signed.len() != points.len() || !points.iter().zip(signed).all(same) {
        return points.to_vec();
    }
    points.iter().zip(signed).map(|(point, value)| (point.0, *value)).collect()
}

/// `, by the inertia`; of a cause whose height nobody knows, that no other is left.
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
    /// A series of (size, error) with what is known of it.
    ///
    /// # Errors
    /// [`Undefined`] where its finest levels have no slope.
    pub fn of(points: &'a [(f64, f64)], context: &Context) -> Result<Self, Undefined> {
        let pair = |pair: &[(f64, f64)]| log_ratio(pair[0].1, pair[1].1) / log_ratio(pair[0].0, pair[1].0);
        let mut limiters = context.limiters.clone();
        let known = |kind, name: &str, magnitude: Option<f64>| {
            magnitude.filter(|magnitude| *magnitude > 0.0).map(|magnitude| Limiter {
                kind,
                name: name.to_owned(),
                magnitude: Some(magnitude),
                order: None,
            })
        };
        limiters.extend(known(
            LimiterKind::Reference,
            "the reference's accuracy",
            context.reference_accuracy,
        ));
        limiters.extend(known(LimiterKind::RoundOff, "round-off", context.round_off));
        let window = &points[points.len().saturating_sub(WINDOW)..];
        let pairs: Vec<f64> = points.windows(2).map(pair).collect();
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

    /// Size and error of the finest level.
    pub fn finest(&self) -> (f64, f64) {
        self.points.last().copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// Share of the finest error that a floor has to have if it is what lowers the order over the finest window,
    /// 0 where the order does not fall.
    ///
    /// Of `C h^p + F` with the share `s = F/e` the order is `q = p (1 − s)`, and falls by `d = p² s (1 − s)` per unit of
    /// ln *h*: so that `p = q + d/q` and `s = d/(q² + d)`, half way between the last two levels. The slower the
    /// order, the smaller the drift that tells.
    pub fn floor_that_would_bend(&self) -> f64 {
        let [.., (before, _), (finest, _)] = *self.points else { return f64::NAN };
        let fall = (-self.drift / LN_2).max(0.0);
        let order = self.pairs.last().map_or(f64::NAN, |last| last.max(0.0));
        let half_way = fall / (order * order + fall);
        let without_floor = order + fall / order;
        half_way / (half_way + (1.0 - half_way) * elementary::powf(finest / before, 0.5 * without_floor))
    }

    /// Size and error of the coarsest level.
    pub fn coarsest(&self) -> (f64, f64) {
        self.points.first().copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// A floor-limited classification: which levels a floor limits, its cause, and how to lower it to a target.
    /// `told` is the reason up to what the floor limits.
    fn over_floor(
        &self,
        told: &str,
        order: Option<f64>,
        target: Option<f64>,
        floor: (f64, bool),
    ) -> Classification {
        let (value, fitted) = floor;
        let limiter = identify(value, &self.limiters);
        let limits_from = self.points.iter().find(|(_, error)| *error <= 2.0 * value);
        let limits_from = limits_from.map_or(self.finest().0, |point| point.0);
        let cause = put_down_to(limiter);
        Classification {
            class: Class::FloorLimited,
            reason: format!("{told} limits the levels from size {} on{cause}", short(limits_from)),
            advice: Some(advice(value, target.filter(|target| *target > 0.0), limiter, &self.limiters)),
            order,
            floor: Some(Floor { value, fitted, limits_from, limiter: limiter.map(|limiter| limiter.kind) }),
        }
    }

    /// A converging error and a floor of opposite sign that cancel at one level.
    pub fn cancelled(&self, fit: &CancellingFit) -> Classification {
        let target = 0.1 * fit.coefficient * elementary::powf(self.finest().0, fit.order);
        let told = format!(
            "the error falls, cancels near size {} and grows again to a floor of {} of opposite sign, which",
            short(fit.cancels_at),
            short(fit.floor)
        );
        self.over_floor(&told, Some(fit.order), Some(target), (fit.floor, true))
    }

    /// A series that goes to a limit which is not zero.
    pub fn approaching(&self, found: &Approach) -> Classification {
        let target = 0.1 * (found.at(self.finest().0) - found.limit).abs();
        let told = format!(
            "the error goes from {} to {} at order {} towards a limit of {}, and the finest level lies where \
             those before it say: a floor that",
            short(self.values[0].1),
            short(self.values[self.values.len() - 1].1),
            order(found.order),
            short(found.limit)
        );
        self.over_floor(&told, Some(found.order), Some(target), (found.limit.abs(), true))
    }

    /// A limit that the three finest levels suggest and none confirms.
    pub fn may_approach(&self, found: &Approach) -> Classification {
        let (size, _) = self.finest();
        advised(
            Class::PreAsymptotic,
            format!(
                "the error goes from {} to {} as if towards a limit of {} at order {}: {} levels cannot tell a \
                 limit from growth",
                short(self.values[0].1),
                short(self.values[self.values.len() - 1].1),
                short(found.limit),
                order(found.order),
                self.points.len()
            ),
            &format!(
                "add a level: at size {} the limit promises {}",
                short(0.5 * size),
                short(found.at(0.5 * size))
            ),
        )
    }

    /// The floor that a short series may have, and what is not known.
    pub fn may_be_limited(&self, reason: &str, height: f64) -> Classification {
        let limiter = identify(height, &self.limiters);
        let suspect = limiter.map_or_else(String::new, |limiter| format!(" ({})", limiter.name));
        advised(
            Class::PreAsymptotic,
            format!(
                "{reason}; {} levels cannot tell a floor of about {}{suspect} from an order that has not settled",
                self.points.len(),
                short(height)
            ),
            if self.points.len() < FLOOR_LEVELS {
                "add a finer level: a floor shows itself on four"
            } else {
                "add a finer level: a floor stops the error, a lower order does not"
            },
        )
    }

    /// Whether a power and a floor fit the levels far better than a power alone.
    pub fn has_significant_floor(&self) -> bool {
        fit_floor(&ErrorSeries::of(self.points)).is_ok_and(|fit| fit.significant)
    }

    /// A floor-limited classification with the floor fitted, its cause and advice.
    pub fn limited(&self, reason: &str) -> Classification {
        let series = ErrorSeries::of(self.points);
        let fit = fit_floor(&series).ok().filter(|fit| fit.significant && fit.residual < 0.1);
        let (size, error) = self.finest();
        let value = fit.map_or(error, |fit| fit.floor);
        let converging = fit.map(|fit| fit.coefficient * elementary::powf(size, fit.order));
        let height = if fit.is_some() { "a floor of" } else { "a floor not above" };
        let told = format!("{reason}; {height} {}", short(value));
        let target = converging.map(|part| 0.1 * part);
        self.over_floor(&told, fit.map(|fit| fit.order), target, (value, fit.is_some()))
    }
}
