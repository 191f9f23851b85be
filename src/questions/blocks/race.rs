//! A situation of the race with its contenders in the order in which a page lists them.

use crate::questions::study_results::StudyResults;
use crate::race::situation::{Arrivals, Entry, Situation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A situation of the race, the best contenders first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RaceBlock {
    /// The situation, its entries sorted: those that arrive by their cost, then those with an error, then the others.
    pub situation: Situation,
    /// Whether the third error is that of a displacement in the plane.
    pub is_plane: bool,
    /// Who reaches 1 %, of a situation that judges an error.
    pub arrivals: Option<Arrivals>,
}

impl RaceBlock {
    /// The situation of a study; `None` where it is not of the race.
    pub fn new(results: &StudyResults<'_>) -> Option<Self> {
        let mut situation = Situation::from_records(results.study, results.records)?;
        situation.entries.sort_by(|a, b| {
            let ([cost, error], [other_cost, other_error]) = (worth(a), worth(b));
            cost.total_cmp(&other_cost).then(error.total_cmp(&other_error))
        });
        let arrivals = (!situation.is_property).then(|| situation.arrivals());
        Some(Self { situation, is_plane: results.study.scene.has_plane_fields(), arrivals })
    }
}

/// Cost to 1 % and largest error; what a contender lacks is worth least.
fn worth(entry: &Entry) -> [f64; 2] {
    [entry.costs[1], entry.largest_error()].map(|value| value.unwrap_or(f64::INFINITY))
}
