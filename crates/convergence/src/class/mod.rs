//! The classes of a series of errors, and what a classification contains.

mod all_levels;
mod classify;
mod evaluable_series;
mod finest_window;

pub use classify::classify;
pub use evaluable_series::FLOOR_LEVELS;

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::fit::floor::{Limiter, LimiterKind};
use oedometer_wording::words;

/// How a series of errors behaves under refinement; decided before any order is quoted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Class {
    /// The order is steady on the finest window, and is the formal one where that is known.
    Asymptotic,
    /// The error falls, but its order has not settled yet.
    PreAsymptotic,
    /// Something other than the refined size limits the error: it stands still, or approaches a limit that
    /// is not zero. This takes at least four levels, because one more level can refute a floor; only
    /// round-off, whose height is known, is a floor on fewer.
    FloorLimited,
    /// The error goes up and down, or its order does.
    Oscillatory,
    /// The error grows under refinement and approaches no limit.
    Divergent,
    /// The order is steady and well above the formal one.
    Superconvergent,
    /// Every error is round-off.
    Exact,
    /// A term of lower order than the formal one governs the fine levels.
    Contaminated,
    /// The body hardly moves: its cells cannot deform at constant volume (volumetric locking).
    Locked,
    /// No class can be given: levels are missing, not finite, too few or too close.
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

/// What is known about a series besides its errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Context {
    /// The order the method should have.
    pub formal_order: Option<f64>,
    /// Errors up to this are round-off; in the unit of the errors. 1e-13 suits relative errors.
    pub round_off: Option<f64>,
    /// Errors up to this may be what a solver's tolerance or the digits of its data leave, in the unit of the errors:
    /// they stand on a floor unless they fall. 1e-6 suits relative errors of data in single precision.
    pub tolerance: Option<f64>,
    /// How far the reference itself may be off, in the unit of the errors.
    pub reference_accuracy: Option<f64>,
    /// What might put a floor under the errors.
    pub limiters: Vec<Limiter>,
    /// Displacement over the exact one at each level, coarse to fine, where it is known.
    pub mobility: Vec<f64>,
    /// Signed errors, coarse to fine, where errors have a sign, as those of a settlement; empty for norms of fields.
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

impl Class {
    /// Whether a series of this class has an order that no longer changes from mesh to mesh.
    pub const fn is_settled(self) -> bool {
        matches!(self, Self::Asymptotic | Self::Superconvergent)
    }
}

impl Classification {
    /// A classification without order, floor and advice.
    pub fn new(class: Class, reason: impl Into<String>) -> Self {
        Self { class, reason: reason.into(), advice: None, order: None, floor: None }
    }

    /// The classification with advice.
    #[must_use]
    pub fn advise(self, advice: impl Into<String>) -> Self {
        Self { advice: Some(advice.into()), ..self }
    }
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
