//! Time integrators by name.

use super::run::TimeStepRule;
use serde::{Deserialize, Serialize};

/// Share of the critical step where an explicit run names no rule.
const DEFAULT_SHARE: f64 = 0.8;
/// Growth of the steps where an implicit run names no rule: its error in time stays below a
/// twentieth of that of ten cells in space.
const DEFAULT_GROWTH: f64 = 0.05;

/// Time integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// The eight steps of Zheng et al. (2021).
    #[default]
    Explicit,
    /// SDIRK2, L-stable, without inertia.
    Implicit,
}

impl IntegratorKind {
    /// Every integrator.
    pub const ALL: [Self; 2] = [Self::Explicit, Self::Implicit];

    /// Name in study files and at the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explicit => "explicit",
            Self::Implicit => "implicit",
        }
    }

    /// Step rule where none is given.
    pub fn default_rule(self) -> TimeStepRule {
        match self {
            Self::Explicit => TimeStepRule::Stable(DEFAULT_SHARE),
            Self::Implicit => TimeStepRule::Growth(DEFAULT_GROWTH),
        }
    }

    /// Why a step rule is none for this integrator, where it is not.
    pub fn refuses_rule(self, rule: TimeStepRule) -> Option<&'static str> {
        match (self, rule) {
            (Self::Explicit, TimeStepRule::Growth(_)) => {
                Some("the explicit integrator cannot let its steps grow: its critical step bounds them")
            }
            _ => None,
        }
    }
}
