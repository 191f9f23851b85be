//! The finishing line: what it costs a contender to bring an error below a threshold, by refining its mesh, and why it does
//! not arrive where it does not.

use crate::case::contender::CONTENDERS;
pub use crate::record::race_errors::NEGLIGIBLE;
use crate::record::race_errors::{ERRORS, RunErrors};
use oedometer_soil::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Share of the exact settlement below which a body locks.
const LOCKED: f64 = 0.9;
/// Share of its error that a doubling of the cells must take away, or the error stalls.
const STALLED: f64 = 0.25;

/// What the race asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Which method, where points move through the mesh?
    Moving,
    /// Which method, where the mesh may follow the soil: smooth, invertible motions alone?
    Total,
}

impl Question {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Moving, Self::Total];

    /// Its word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moving => "moving",
            Self::Total => "total",
        }
    }

    /// Whether a contender answers it.
    pub fn takes(self, contender: &str) -> bool {
        let is_total = CONTENDERS.iter().any(|one| one.name == contender && one.is_total());
        is_total == (self == Self::Total)
    }
}

/// What an error is of. In the plane the third is of the displacement, under a footing of its load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RaceQuantity {
    /// Pore pressure at the points.
    Pressure,
    /// Effective stress at the points.
    Stress,
    /// Settlement, displacement or load.
    Settlement,
    /// The largest of the three.
    All,
}

impl RaceQuantity {
    /// Each quantity, and all together last.
    pub const EACH: [Self; ERRORS + 1] = [Self::Pressure, Self::Stress, Self::Settlement, Self::All];

    /// Its word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Stress => "stress",
            Self::Settlement => "settlement",
            Self::All => "all",
        }
    }

    /// Its error among those of a run; `None` where one is missing or not a number.
    pub fn error_in(self, errors: &RunErrors) -> Option<f64> {
        let value = match self {
            Self::Pressure => errors[0]?,
            Self::Stress => errors[1]?,
            Self::Settlement => errors[2]?,
            Self::All => {
                let measured: Vec<f64> = errors.iter().copied().flatten().collect();
                if measured.is_empty() || measured.iter().any(|error| error.is_nan()) {
                    return None;
                }
                measured.into_iter().fold(0.0, f64::max)
            }
        };
        (value >= 0.0).then_some(value)
    }
}

/// A run of a contender on one mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Level {
    /// Cells over the height.
    pub cells: usize,
    /// Counted work by the calibration, s.
    pub cost: f64,
    /// Measured seconds of the processor, if the system reports it.
    pub seconds: Option<f64>,
    /// Largest errors over the outputs; none where the run failed.
    pub errors: RunErrors,
}

/// Why a contender does not arrive.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// Its error falls, and the meshes end before the line.
    Budget,
    /// It settles far less than the soil.
    Locks,
    /// Its error stays where it is when the mesh is refined.
    Stalls,
    /// A run ended before its time, by the name of the failure.
    Failed(String),
    /// The method or the program refuses the situation.
    ByDefinition,
    /// It has no record.
    NotRun,
}

impl Reason {
    /// Its words in tables, none of which a reader of CSV takes for a missing value.
    pub fn words(&self) -> &str {
        match self {
            Self::Budget => "budget",
            Self::Locks => "locks",
            Self::Stalls => "stalls",
            Self::Failed(name) => name,
            Self::ByDefinition => "by definition",
            Self::NotRun => "not run",
        }
    }
}

/// Cost to bring an error below a threshold, s: that of the first mesh from which on each run stays below it, between it and
/// the mesh before by powers of both. `None` where the finest run is not below.
pub fn cost_to(levels: &[Level], quantity: RaceQuantity, threshold: f64) -> Option<f64> {
    level_to(levels, quantity, threshold)?.between(levels, |level| Some(level.cost))
}

/// Measured seconds to the same.
pub fn seconds_to(levels: &[Level], quantity: RaceQuantity, threshold: f64) -> Option<f64> {
    level_to(levels, quantity, threshold)?.between(levels, |level| level.seconds)
}

/// The mesh that reaches a threshold, and how far between the mesh before and it the threshold lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reached {
    place: usize,
    /// 1 at the mesh itself.
    share: f64,
}

impl Reached {
    fn between(self, levels: &[Level], cost: impl Fn(&Level) -> Option<f64>) -> Option<f64> {
        let fine = cost(&levels[self.place])?;
        if self.share >= 1.0 {
            return Some(fine);
        }
        let coarse = cost(&levels[self.place - 1]).filter(|coarse| *coarse > 0.0).unwrap_or(fine);
        Some(coarse * elementary::powf(fine / coarse, self.share))
    }
}

fn level_to(levels: &[Level], quantity: RaceQuantity, threshold: f64) -> Option<Reached> {
    let error = |place: usize| quantity.error_in(&levels[place].errors);
    let is_below = |place: &usize| error(*place).is_some_and(|error| error <= threshold);
    let place = (0..levels.len()).rev().take_while(is_below).last()?;
    let before = place.checked_sub(1).and_then(error);
    let share = match (before, error(place)?) {
        (Some(coarse), fine) if coarse > threshold && coarse.is_finite() => {
            // An error of nothing has no logarithm.
            let fine = fine.max(f64::MIN_POSITIVE);
            elementary::ln(coarse / threshold) / elementary::ln(coarse / fine)
        }
        _ => 1.0,
    };
    Some(Reached { place, share })
}

/// Why the finest of some runs does not arrive: `failure` is that of the finest run, `stiffness` what it settles over what
/// the soil does.
pub fn reason_of(levels: &[Level], failure: Option<&str>, stiffness: Option<f64>) -> Reason {
    if let Some(name) = failure {
        return Reason::Failed(name.replace(['_', '-'], " "));
    }
    let errors: Vec<Option<f64>> =
        levels.iter().rev().take(2).map(|level| RaceQuantity::All.error_in(&level.errors)).collect();
    match errors[..] {
        [] => Reason::NotRun,
        _ if stiffness.is_some_and(|stiffness| stiffness < LOCKED) => Reason::Locks,
        [Some(fine), Some(coarse)] if fine > coarse * (1.0 - STALLED) => Reason::Stalls,
        _ => Reason::Budget,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(cells: usize, cost: f64, error: Option<f64>) -> Level {
        Level {
            cells,
            cost,
            seconds: Some(2.0 * cost),
            errors: [error.map(|error| error / 2.0), None, error],
        }
    }

    fn levels(errors: &[Option<f64>]) -> Vec<Level> {
        let costs = [1.0, 8.0, 27.0, 64.0];
        errors
            .iter()
            .zip(costs)
            .zip([4, 8, 16, 32])
            .map(|((error, cost), cells)| level(cells, cost, *error))
            .collect()
    }

    #[test]
    fn the_cost_of_a_threshold_lies_between_two_meshes_by_powers_and_only_where_finer_ones_stay_below() {
        let cost = |errors: &[Option<f64>], threshold| cost_to(&levels(errors), RaceQuantity::All, threshold);
        let falling = [Some(0.1), Some(0.01), Some(0.004)];
        assert_eq!(cost(&falling, 0.2), Some(1.0), "the coarsest mesh is good enough");
        // From 0.1 at 1 s to 0.01 at 8 s: a share of log10 2 of the way.
        let half = cost(&falling, 0.05).expect("reached");
        assert!((half / 8.0_f64.powf(2.0_f64.log10()) - 1.0).abs() < 1e-12, "{half}");
        assert_eq!(cost(&falling, 0.003), None);
        // An accident on a coarse mesh does not count, and neither does a mesh on which the run fails in the end.
        assert_eq!(cost(&[Some(0.001), Some(0.1), Some(0.01)], 0.01), Some(27.0));
        assert_eq!(cost(&[Some(0.1), Some(0.001), Some(0.02)], 0.01), None);
        assert_eq!(cost(&[Some(0.1), Some(0.001), None], 0.01), None);
        assert_eq!(cost(&[None, Some(0.001)], 0.01), Some(8.0), "nothing to interpolate from");
        assert_eq!(cost(&[Some(f64::NAN)], 0.01), None);
        assert_eq!(cost(&[Some(0.1), Some(0.0)], 0.01).map(|cost| cost < 1.1), Some(true));
        assert_eq!(cost(&[], 0.01), None);
        // Half the error of the others: the pressure arrives earlier. There is no stress.
        let of = |quantity| cost_to(&levels(&falling), quantity, 0.05);
        assert_eq!((of(RaceQuantity::Pressure), of(RaceQuantity::Stress)), (Some(1.0), None));
        let seconds = seconds_to(&levels(&falling), RaceQuantity::All, 0.01).expect("reached");
        assert!((seconds - 16.0).abs() < 1e-12, "{seconds}");
    }

    #[test]
    fn who_does_not_arrive_has_a_reason() {
        let reason =
            |errors: &[Option<f64>], failure, stiffness| reason_of(&levels(errors), failure, stiffness);
        assert_eq!(reason(&[Some(0.3), Some(0.1)], None, Some(0.95)), Reason::Budget);
        assert_eq!(reason(&[Some(0.3), Some(0.1)], None, Some(0.85)), Reason::Locks);
        assert_eq!(reason(&[Some(0.3), Some(0.25)], None, None), Reason::Stalls);
        assert_eq!(reason(&[Some(0.3), Some(0.22)], None, None), Reason::Budget);
        assert_eq!(reason(&[Some(0.3), None], Some("not-converged"), Some(0.1)).words(), "not converged");
        assert_eq!(reason(&[], None, None), Reason::NotRun);
    }
}
