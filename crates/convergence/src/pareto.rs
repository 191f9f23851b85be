//! Accuracy against cost: the Pareto front, and the price of one more level.

use serde::{Deserialize, Serialize};

use crate::class::{Class, Classification};
use crate::orders::{WINDOW, slope_of};
use oedometer_soil::elementary;

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
}

/// Which points lie on the Pareto front: usable, and dominated by none, which is nowhere worse and somewhere better.
pub fn front(points: &[CostPoint]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).filter(|place| points[*place].is_usable()).collect();
    order.sort_by(|a, b| {
        let (a, b) = (&points[*a], &points[*b]);
        a.cost.total_cmp(&b.cost).then(a.error.total_cmp(&b.error))
    });
    let mut on_front = vec![false; points.len()];
    let mut least = f64::INFINITY;
    // Of equal cost only the least error can be on the front, and all that have it are.
    for alike in order.chunk_by(|a, b| points[*a].cost == points[*b].cost) {
        let best = points[alike[0]].error;
        for place in alike.iter().take_while(|place| points[**place].error == best && best < least) {
            on_front[*place] = true;
        }
        least = least.min(best);
    }
    on_front
}

/// A point compared with its golden value, in accuracy and cost together.
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

/// What one more level would cost and bring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelPrediction {
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

/// Predicts one more level, finer by `ratio` than the finest; `None` for fewer than two levels, levels
/// that are no numbers, or a ratio not above 1.
pub fn predict_next(
    levels: &[CostLevel],
    classification: &Classification,
    ratio: f64,
) -> Option<LevelPrediction> {
    let levels = usable(levels)?;
    if !ratio.is_finite() || ratio <= 1.0 {
        return None;
    }
    let window = &levels[levels.len().saturating_sub(WINDOW)..];
    let costs: Vec<_> = window.iter().map(|level| (level.size, level.point.cost)).collect();
    let slope = slope_of(&costs).ok()?;
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
    Some(LevelPrediction {
        size: finest.size / ratio,
        cost,
        cost_exponent: -slope.order,
        error: error.filter(|error| error.is_finite()),
    })
}

/// The levels from coarse to fine, when there are two and all are usable and of distinct sizes.
fn usable(levels: &[CostLevel]) -> Option<Vec<CostLevel>> {
    let size = |level: &CostLevel| level.size.is_normal() && level.size > 0.0;
    if levels.len() < 2 || !levels.iter().all(|level| size(level) && level.point.is_usable()) {
        return None;
    }
    let mut levels = levels.to_vec();
    levels.sort_by(|a, b| b.size.total_cmp(&a.size));
    levels.windows(2).all(|pair| pair[0].size > pair[1].size).then_some(levels)
}

#[cfg(test)]
mod tests;
