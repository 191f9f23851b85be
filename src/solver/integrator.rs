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

    /// Formulation where none is given.
    pub fn default_formulation(self) -> Formulation {
        match self {
            Self::Explicit => Formulation::VW,
            Self::Implicit => Formulation::QuasiStatic,
        }
    }

    /// Why a formulation is none for this integrator, where it is not.
    pub fn refuses_formulation(self, formulation: Formulation) -> Option<&'static str> {
        match (self, formulation) {
            (Self::Explicit, Formulation::QuasiStatic) => {
                Some("the explicit integrator goes from accelerations: it cannot leave them out")
            }
            (Self::Explicit, Formulation::UP) => {
                Some("the explicit integrator has an acceleration of the water: it solves `v-w` only")
            }
            _ => None,
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

/// Which accelerations the balances keep (theory, section 2: model only what a scene needs).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// None: Biot's consolidation.
    QuasiStatic,
    /// That of the mixture; the water's relative to the skeleton is neglected, `a_w ≈ a_s`
    /// (Zienkiewicz 1980).
    #[serde(rename = "u-p")]
    UP,
    /// Both phases' own.
    #[serde(rename = "v-w")]
    VW,
}

impl Formulation {
    /// Every formulation, the shortest first.
    pub const ALL: [Self; 3] = [Self::QuasiStatic, Self::UP, Self::VW];

    /// Name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::QuasiStatic => "quasi-static",
            Self::UP => "u-p",
            Self::VW => "v-w",
        }
    }
}
