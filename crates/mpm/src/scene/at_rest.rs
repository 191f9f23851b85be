//! A column at rest under its own weight: nothing acts that its start does not balance, and nothing may move.

use crate::scene::definition::SceneDefinition;
use oedometer_exact::reference::ReferenceKind;

pub(crate) static AT_REST: SceneDefinition = SceneDefinition {
    summary: "column without load at rest under its own weight: any motion is the method's own",
    references: &[ReferenceKind::AtRest],
    ..SceneDefinition::UNLOADED
};
