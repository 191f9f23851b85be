//! A column of layers loaded at once and drained at its top, at small strain, from the undrained equilibrium of its own
//! operators.

use crate::scene::definition::SceneDefinition;
use oedometer_exact::reference::ReferenceKind;

pub(crate) static LAYERED: SceneDefinition = SceneDefinition {
    summary: "column of several soils under a sudden load, drained at its top, small strain",
    references: &[ReferenceKind::Layered],
    ..SceneDefinition::LOADED
};
