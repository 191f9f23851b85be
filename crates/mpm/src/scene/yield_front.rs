//! A preconsolidated column loaded at once beyond its preconsolidation and drained at its top: undrained it stays elastic,
//! and as the water leaves a front of yielding runs in from the surface. Stresses are counted from those of the start.

use crate::scene::definition::SceneDefinition;
use oedometer_exact::reference::ReferenceKind;

pub(crate) static YIELD_FRONT: SceneDefinition = SceneDefinition {
    summary: "preconsolidated column under a sudden load: a front of yielding runs in from its drained top",
    references: &[ReferenceKind::YieldFront],
    ..SceneDefinition::LOADED
};
