//! The classes a series of errors may fall into, and what is said with them.

pub mod classify;
pub mod evaluable_series;
pub mod finest_window;

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::limiter::{Limiter, LimiterKind};
use oedometer_soil::wording::words;

/// How a series of errors behaves under refinement; decided before any order is quoted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// The order is steady on the finest window, and is the formal one where that is known.
    Asymptotic,
    /// The error falls, and its order has not settled yet.
    PreAsymptotic,
    /// Something else than the refined size limits the error: it stands still, or goes to a limit that
    /// is not zero. Four levels at least say so, for a floor is a claim that one more level can refute;
    /// only round-off, whose height is known, is a floor to fewer.
    FloorLimited,
    /// The error goes up and down, or its order does.
    Oscillatory,
    /// The error grows under refinement, and goes to no limit.
    Divergent,
    /// The order is steady and well above the formal one.
    Superconvergent,
    /// Every error is round-off.
    Exact,
    /// A term of lower order than the formal one governs the fine levels.
    Contaminated,
    /// The body hardly moves: its cells cannot keep their volume and deform (volumetric locking).
    Locked,
    /// Nothing can be said: levels are missing, not finite, too few or too close.
    NotEvaluable,
}

words!(
    Class:
    Asymptotic "asymptotic", PreAsymptotic "pre-asymptotic", FloorLimited "floor-limited",
    Oscillatory "oscillatory", Divergent "divergent", Superconvergent "superconvergent", Exact "exact",
    Contaminated "contaminated", Locked "locked", NotEvaluable "not-evaluable",
);

impl fmt::Display for Class {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// What is known about a series beside its errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Context {
    /// The order the method should have.
    pub formal_order: Option<f64>,
    /// Errors up to this are round-off; in the unit of the errors. 1e-13 suits relative errors.
    pub round_off: Option<f64>,
    /// What the reference itself may be off by, in the unit of the errors.
    pub reference_accuracy: Option<f64>,
    /// What might put a floor under the errors.
    pub limiters: Vec<Limiter>,
    /// Displacement over the exact one at each level, coarse to fine, where it is known.
    pub mobility: Vec<f64>,
    /// The errors with their signs, coarse to fine, where they have one: those of a settlement. Empty
    /// for norms of fields.
    pub signed: Vec<f64>,
}

/// The class of a series, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Classification {
    /// The class.
    pub class: Class,
    /// A sentence with the numbers that decided.
    pub reason: String,
    /// What to change, where there is something to say.
    pub advice: Option<String>,
    /// Order on the finest window, for classes in which it means something: asymptotic,
    /// pre-asymptotic, superconvergent and contaminated; for a floor-limited series the order of
    /// the part that converges, where a fit determines it.
    pub order: Option<f64>,
    /// The floor of a floor-limited series.
    pub floor: Option<Floor>,
}

/// A floor under a series of errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Floor {
    /// Height, in the unit of the errors.
    pub value: f64,
    /// Whether the height is fitted; else it is the error at the finest level.
    pub fitted: bool,
    /// Size of the coarsest level at which the floor is at least half the error.
    pub limits_from: f64,
    /// What causes it, where a known candidate fits.
    pub limiter: Option<LimiterKind>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_records() {
        for class in Class::ALL {
            let json = serde_json::to_string(&class).unwrap();
            assert_eq!(json, format!("\"{class}\""));
        }
    }
}
