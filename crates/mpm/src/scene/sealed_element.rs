//! A sealed column: no water leaves, so it carries its load undrained.

use crate::scene::definition::SceneDefinition;
use oedometer_exact::reference::ReferenceKind;

pub(crate) static SEALED_ELEMENT: SceneDefinition = SceneDefinition {
    summary: "column under a sudden load that no water leaves, small strain",
    references: &[ReferenceKind::SealedElement],
    ..SceneDefinition::LOADED
};
