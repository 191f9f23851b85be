//! Accuracy against cost: the Pareto front.

use serde::{Deserialize, Serialize};

/// What a run cost and how far off it was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostPoint {
    /// Cost: point updates, steps or seconds.
    pub cost: f64,
    /// The error.
    pub error: f64,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn point(cost: f64, error: f64) -> CostPoint {
        CostPoint { cost, error }
    }

    #[test]
    fn the_front_holds_what_no_other_point_dominates() {
        let points = [
            point(1.0, 1.0),
            point(2.0, 0.5),
            point(2.0, 0.6),
            point(3.0, 0.5),
            point(0.5, f64::NAN),
            point(4.0, 0.1),
            point(4.0, 0.1),
        ];
        assert_eq!(front(&points), [true, true, false, false, false, true, true]);
    }
}
