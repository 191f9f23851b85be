//! A scene is a physical problem: geometry, load, start, the physics it needs and the references
//! that hold for it. It knows the exact solutions and the solver, and makes a problem for one from
//! the other.

pub mod arrangement;
pub mod column;
pub mod problem;

use crate::exact::large_strain;
use crate::exact::large_strain::law::{LargeStrainModel, SoilLaw, Water};
use crate::exact::reference::ReferenceKind;
use crate::mpm::method::Configuration;
use crate::scene::column::Column;
use crate::soil::material::{Continuity, Law, Material};
use serde::{Deserialize, Serialize};

/// A physical problem by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SceneKind {
    /// A column loaded at once and drained at its top, at small strain, from the undrained
    /// equilibrium.
    Terzaghi,
    /// The slowest mode of an unloaded column: smooth in space and time.
    SingleMode,
    /// A column loaded at once and drained at its top, at large strain, from the undrained
    /// equilibrium.
    XieLeo,
    /// A plane layer loaded at once by a cosine and drained at its top, at small strain, from the
    /// undrained equilibrium.
    CosineLayer,
    /// A column at rest, loaded at once or over a time, with all its waves.
    DynamicColumn,
    /// The slowest mode of an unloaded column, with the inertia that it has.
    DynamicSingleMode,
    /// An undrained wave that stands in an unloaded column: smooth, and nothing but inertia.
    StandingWave,
}

/// The large-strain reference of the default law; see [`SceneKind::reference_for`].
const LARGE_STRAIN: ReferenceKind = ReferenceKind::LargeStrain(LargeStrainModel {
    law: SoilLaw::LogLinear,
    continuity: large_strain::Continuity::Conservative,
    water: Water::Compressible,
});

impl SceneKind {
    /// Every scene.
    pub const ALL: [Self; 7] = [
        Self::Terzaghi,
        Self::SingleMode,
        Self::XieLeo,
        Self::CosineLayer,
        Self::DynamicColumn,
        Self::DynamicSingleMode,
        Self::StandingWave,
    ];

    /// Name in study files and at the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terzaghi => "terzaghi",
            Self::SingleMode => "single-mode",
            Self::XieLeo => "xie-leo",
            Self::CosineLayer => "cosine-layer",
            Self::DynamicColumn => "dynamic-column",
            Self::DynamicSingleMode => "dynamic-single-mode",
            Self::StandingWave => "standing-wave",
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
            Self::XieLeo => "column under a sudden load, drained at its top, large strain",
            Self::CosineLayer => "plane layer under a cosine load, drained at its top: where locking shows",
            Self::DynamicColumn => "column at rest under a sudden or growing load: waves and consolidation",
            Self::DynamicSingleMode => "slowest consolidation mode with its inertia, no load: smooth",
            Self::StandingWave => "undrained standing wave, no load: smooth, for the order in the step",
        }
    }

    /// References that hold for the scene, the one whose equations the solver solves first.
    pub fn references(self) -> &'static [ReferenceKind] {
        match self {
            Self::Terzaghi => &[ReferenceKind::Terzaghi, ReferenceKind::TerzaghiIncompressible],
            Self::SingleMode => &[ReferenceKind::SingleMode],
            Self::XieLeo => &[LARGE_STRAIN, ReferenceKind::XieLeo],
            Self::CosineLayer => &[ReferenceKind::CosineLayer, ReferenceKind::CosineLayerIncompressible],
            Self::DynamicColumn => &[ReferenceKind::DynamicColumn, ReferenceKind::Terzaghi],
            Self::DynamicSingleMode => &[ReferenceKind::DynamicSingleMode, ReferenceKind::SingleMode],
            Self::StandingWave => &[ReferenceKind::StandingWave],
        }
    }

    /// Those that hold for a column: Xie & Leo's load acts at once.
    pub fn references_of(self, column: &Column) -> &'static [ReferenceKind] {
        match self {
            Self::XieLeo if column.loading_time > 0.0 => &[LARGE_STRAIN],
            _ => self.references(),
        }
    }

    /// A reference as it holds for a soil: the large-strain one takes the soil's own law and
    /// continuity, and is of the equations that the solver solves.
    pub fn reference_for(kind: ReferenceKind, soil: &Material) -> ReferenceKind {
        match kind {
            ReferenceKind::LargeStrain(model) => ReferenceKind::LargeStrain(LargeStrainModel {
                law: match soil.law {
                    Law::Linear => SoilLaw::Linear,
                    Law::LogLinear => SoilLaw::LogLinear,
                    Law::PorosityDependent => SoilLaw::PorosityDependent,
                    Law::Engineering => SoilLaw::Engineering,
                },
                continuity: match soil.continuity {
                    Continuity::Conservative => large_strain::Continuity::Conservative,
                    Continuity::ConstantPorosityGradient => {
                        large_strain::Continuity::ConstantPorosityGradient
                    }
                },
                ..model
            }),
            other => other,
        }
    }

    /// Law of the soil where a study names none.
    pub fn default_law(self) -> Law {
        match self {
            Self::XieLeo => Law::LogLinear,
            _ => Law::Linear,
        }
    }

    /// Why the scene cannot take a law, where it cannot.
    pub fn refuses_law(self, law: Law) -> Option<&'static str> {
        match self {
            Self::XieLeo => (law == Law::Linear).then_some(
                "the law `linear` is of small strain: its conductivity ignores that the pores close",
            ),
            _ => (law != Law::Linear).then_some(
                "this scene is of small strain, where every law is linear: the one named would be ignored",
            ),
        }
    }

    /// Whether the scene's theory holds at small strain only.
    pub fn is_small_strain(self) -> bool {
        self != Self::XieLeo
    }

    /// Why the scene cannot take a configuration, where it cannot.
    pub fn refuses_configuration(self, configuration: Configuration) -> Option<&'static str> {
        (self == Self::XieLeo && configuration == Configuration::Frozen)
            .then_some("nothing moves in a `frozen` configuration, and this scene is about large strain")
    }

    /// Configuration of the weights where the method leaves it open: small strain moves nothing.
    pub fn configuration(self) -> Configuration {
        match self {
            Self::XieLeo => Configuration::Updated,
            _ => Configuration::Frozen,
        }
    }

    /// Whether its load may take time to come on.
    pub fn takes_loading_time(self) -> bool {
        matches!(self, Self::XieLeo | Self::DynamicColumn)
    }

    /// Whether the problem is one of two dimensions only.
    pub fn is_plane(self) -> bool {
        self == Self::CosineLayer
    }

    /// Whether waves run in it.
    pub fn has_waves(self) -> bool {
        matches!(self, Self::DynamicColumn | Self::DynamicSingleMode | Self::StandingWave)
    }

    /// Whether a load acts, so that `σ' − p = −q` at rest.
    pub fn is_loaded(self) -> bool {
        match self {
            Self::Terzaghi | Self::XieLeo | Self::DynamicColumn | Self::CosineLayer => true,
            Self::SingleMode | Self::DynamicSingleMode | Self::StandingWave => false,
        }
    }

    /// Why a reference is not the scene's own, where it is a second one.
    pub fn model_difference(self, reference: ReferenceKind, soil: &Material) -> Option<&'static str> {
        match (self, reference) {
            (Self::Terzaghi, ReferenceKind::TerzaghiIncompressible)
            | (Self::CosineLayer, ReferenceKind::CosineLayerIncompressible) => Some("the water's storage"),
            (Self::DynamicColumn, ReferenceKind::Terzaghi)
            | (Self::DynamicSingleMode, ReferenceKind::SingleMode) => Some("the inertia"),
            (Self::XieLeo, ReferenceKind::XieLeo) => {
                Some(match (soil.continuity, soil.law == Law::PorosityDependent) {
                    (Continuity::Conservative, false) => "the water's storage",
                    (Continuity::Conservative, true) => "the modulus in the rate form",
                    (Continuity::ConstantPorosityGradient, false) => "the dropped porosity gradient",
                    (Continuity::ConstantPorosityGradient, true) => {
                        "the dropped porosity gradient and the modulus in the rate form"
                    }
                })
            }
            _ => None,
        }
    }
}
