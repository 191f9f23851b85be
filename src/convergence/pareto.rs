//! Accuracy against cost: the Pareto front, the gate against a golden value, the cheapest way to a
//! tolerance, and the price of one more level.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::convergence::class::{Class, Classification};
use crate::convergence::orders::{WINDOW, log_ratio, slope_of};
use crate::elementary;
use crate::wording::short;

/// What a run cost and how far off it was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostPoint {
    /// Cost: point updates, steps or seconds.
    pub cost: f64,
    /// The error.
    pub error: f64,
}

/// One level of a method, with its size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostLevel {
    /// Size of the level, as in an error series.
    pub size: f64,
    /// Its cost and error.
    pub point: CostPoint,
}

impl CostPoint {
    /// Whether both numbers are positive and finite, the error possibly zero.
    pub fn is_usable(&self) -> bool {
        self.cost.is_finite() && self.cost > 0.0 && self.error.is_finite() && self.error >= 0.0
    }

    /// Whether this point is nowhere worse than another and somewhere better; a point that is not
    /// usable neither dominates nor is dominated.
    pub fn dominates(&self, other: &Self) -> bool {
        self.is_usable()
            && other.is_usable()
            && self.cost <= other.cost
            && self.error <= other.error
            && (self.cost < other.cost || self.error < other.error)
    }
}

/// Which points lie on the Pareto front: usable, and dominated by none.
pub fn front(points: &[CostPoint]) -> Vec<bool> {
    let on_front =
        |point: &CostPoint| point.is_usable() && !points.iter().any(|other| other.dominates(point));
    points.iter().map(on_front).collect()
}

/// A point held against its golden value, in accuracy and cost together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ParetoChange {
    /// Neither differs beyond its tolerance.
    Same,
    /// One is better and none is worse: the golden value is stale.
    Better,
    /// One is better and the other worse.
    Traded,
    /// One is worse and none is better: the golden value dominates.
    Dominated,
    /// A number is missing or no number; never a pass.
    NotComparable,
}

impl ParetoChange {
    /// Whether a gate lets the change through: all but domination and what cannot be compared.
    pub fn passes(self) -> bool {
        !matches!(self, Self::Dominated | Self::NotComparable)
    }
}

/// Compares a point with its golden value, with relative tolerances for cost and error.
pub fn against_golden(
    point: &CostPoint,
    golden: &CostPoint,
    cost_tolerance: f64,
    error_tolerance: f64,
) -> ParetoChange {
    let tolerance = |value: f64| value.is_finite() && value >= 0.0;
    if !point.is_usable() || !golden.is_usable() || !tolerance(cost_tolerance) || !tolerance(error_tolerance)
    {
        return ParetoChange::NotComparable;
    }
    let pairs = [(point.cost, golden.cost, cost_tolerance), (point.error, golden.error, error_tolerance)];
    let worse = pairs.iter().any(|(new, old, tolerance)| *new > old * (1.0 + tolerance));
    let better = pairs.iter().any(|(new, old, tolerance)| *new * (1.0 + tolerance) < *old);
    match (better, worse) {
        (false, false) => ParetoChange::Same,
        (true, false) => ParetoChange::Better,
        (true, true) => ParetoChange::Traded,
        (false, true) => ParetoChange::Dominated,
    }
}

/// How a cost for a tolerance was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CostBasis {
    /// Between two levels, straight on a log-log plot.
    Interpolated,
    /// The coarsest level meets the tolerance already: a coarser one might too.
    AtMost,
}

/// The cost at which a method reaches a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostToTolerance {
    /// The cost, in the unit of the points.
    pub cost: f64,
    /// How it was come by.
    pub basis: CostBasis,
}

/// Why there is no cost or no prediction.
#[derive(Clone, Debug, PartialEq, Error, Serialize, Deserialize)]
pub enum NoCost {
    /// A level has a cost, error or size that is no positive number, or there are too few levels.
    #[error("the levels are too few, or hold what is no positive number")]
    NotUsable,
    /// The tolerance is not a positive number.
    #[error("the tolerance is not a positive number")]
    BadTolerance,
    /// The finest level is still outside.
    #[error("the tolerance is not reached: the finest level has an error of {}", short(*.error))]
    NotReached {
        /// Error of the finest level.
        error: f64,
    },
}

/// Cost at which a method reaches a tolerance, for good: a finer level outside undoes a coarser
/// one inside by luck. Levels in any order; only those of one method.
///
/// # Errors
/// [`NoCost`] says why there is none.
pub fn cost_to_tolerance(levels: &[CostLevel], tolerance: f64) -> Result<CostToTolerance, NoCost> {
    if !tolerance.is_finite() || tolerance <= 0.0 {
        return Err(NoCost::BadTolerance);
    }
    let levels = usable(levels, 1)?;
    let outside = levels.iter().rposition(|level| level.point.error > tolerance);
    let Some(outside) = outside else {
        return Ok(CostToTolerance { cost: levels[0].point.cost, basis: CostBasis::AtMost });
    };
    let coarse = levels[outside].point;
    let Some(fine) = levels.get(outside + 1).map(|level| level.point) else {
        return Err(NoCost::NotReached { error: coarse.error });
    };
    // An error of exactly zero has no logarithm: then only the level itself is sure.
    let way = log_ratio(coarse.error, tolerance) / log_ratio(coarse.error, fine.error);
    let way = if fine.error > 0.0 && way.is_finite() { way } else { 1.0 };
    let cost = coarse.cost * elementary::exp(way * log_ratio(fine.cost, coarse.cost));
    Ok(CostToTolerance { cost, basis: CostBasis::Interpolated })
}

/// The method that reaches a tolerance at the least cost, by its place in the list.
pub fn cheapest(methods: &[Vec<CostLevel>], tolerance: f64) -> Option<(usize, CostToTolerance)> {
    methods
        .iter()
        .enumerate()
        .filter_map(|(place, levels)| Some((place, cost_to_tolerance(levels, tolerance).ok()?)))
        .min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))
}

/// What one more level would cost and bring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Size of the level.
    pub size: f64,
    /// Its cost, from the slope of cost over the finest levels.
    pub cost: f64,
    /// Exponent `c` of the cost, `∝ h^−c`.
    pub cost_exponent: f64,
    /// Its error, from the order and the floor of the series' class; `None` where the class gives
    /// none: a divergent or oscillating series has no next error.
    pub error: Option<f64>,
}

/// Predicts one more level, finer by `ratio` than the finest.
///
/// # Errors
/// [`NoCost::NotUsable`] for fewer than two levels, levels that are no numbers, or a ratio not
/// above 1.
pub fn predict_next(
    levels: &[CostLevel],
    classification: &Classification,
    ratio: f64,
) -> Result<Prediction, NoCost> {
    let levels = usable(levels, 2)?;
    if !ratio.is_finite() || ratio <= 1.0 {
        return Err(NoCost::NotUsable);
    }
    let window = &levels[levels.len().saturating_sub(WINDOW)..];
    let costs: Vec<_> = window.iter().map(|level| (level.size, level.point.cost)).collect();
    let slope = slope_of(&costs).map_err(|_| NoCost::NotUsable)?;
    let finest = window[window.len() - 1];
    let cost = finest.point.cost * elementary::powf(ratio, -slope.order);
    let settled = !matches!(
        classification.class,
        Class::Divergent | Class::Oscillatory | Class::NotEvaluable | Class::Exact
    );
    let floor = classification.floor.as_ref().map_or(0.0, |floor| floor.value);
    let converging = (finest.point.error - floor).max(0.0);
    let error = match classification.order.filter(|_| settled) {
        Some(order) => Some(floor + converging * elementary::powf(ratio, -order)),
        // A floor without a fitted order: the error stays where it is.
        None => classification.floor.as_ref().map(|_| finest.point.error),
    };
    Ok(Prediction {
        size: finest.size / ratio,
        cost,
        cost_exponent: -slope.order,
        error: error.filter(|error| error.is_finite()),
    })
}

/// The levels from coarse to fine, when all are usable and of distinct sizes.
fn usable(levels: &[CostLevel], least: usize) -> Result<Vec<CostLevel>, NoCost> {
    let size = |level: &CostLevel| level.size.is_normal() && level.size > 0.0;
    if levels.len() < least || !levels.iter().all(|level| size(level) && level.point.is_usable()) {
        return Err(NoCost::NotUsable);
    }
    let mut levels = levels.to_vec();
    levels.sort_by(|a, b| b.size.total_cmp(&a.size));
    let distinct = levels.windows(2).all(|pair| pair[0].size > pair[1].size);
    if distinct { Ok(levels) } else { Err(NoCost::NotUsable) }
}

#[cfg(test)]
#[path = "../../tests/unit/convergence_pareto.rs"]
mod tests;
