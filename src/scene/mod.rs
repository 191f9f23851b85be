//! A scene is a physical problem: geometry, load, start, the physics it needs and the references
//! that hold for it. It knows the exact solutions and the solver, and makes a problem for one from
//! the other.

mod column;

pub use column::{Column, column_parameters, column_problem};

use crate::exact::reference::ReferenceKind;
use crate::solver::method::Configuration;
use serde::{Deserialize, Serialize};

/// A physical problem by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SceneKind {
    /// A column loaded at once and drained at its top, at small strain, from the undrained
    /// equilibrium.
    Terzaghi,
    /// The slowest mode of an unloaded column: smooth in space and time.
    SingleMode,
}

impl SceneKind {
    /// Every scene.
    pub const ALL: [Self; 2] = [Self::Terzaghi, Self::SingleMode];

    /// Name in study files and at the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terzaghi => "terzaghi",
            Self::SingleMode => "single-mode",
        }
    }

    /// The scene of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scene| scene.name() == name)
    }

    /// One line on what it is.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Terzaghi => "column under a sudden load, drained at its top, small strain",
            Self::SingleMode => "slowest consolidation mode, no load: smooth, for formal orders",
        }
    }

    /// References that hold for the scene, the one whose equations the solver solves first.
    pub fn references(self) -> &'static [ReferenceKind] {
        match self {
            Self::Terzaghi => &[ReferenceKind::Terzaghi, ReferenceKind::TerzaghiIncompressible],
            Self::SingleMode => &[ReferenceKind::SingleMode],
        }
    }

    /// Configuration of the weights where the method leaves it open: small strain moves nothing.
    pub fn configuration(self) -> Configuration {
        match self {
            Self::Terzaghi | Self::SingleMode => Configuration::Frozen,
        }
    }

    /// Whether a load acts, so that `σ' − p = −q` at rest.
    pub fn is_loaded(self) -> bool {
        match self {
            Self::Terzaghi => true,
            Self::SingleMode => false,
        }
    }

    /// Why a reference is not the scene's own, where it is a second one.
    pub fn model_difference(self, reference: ReferenceKind) -> Option<&'static str> {
        match (self, reference) {
            (Self::Terzaghi, ReferenceKind::TerzaghiIncompressible) => Some("the water's storage"),
            _ => None,
        }
    }
}
