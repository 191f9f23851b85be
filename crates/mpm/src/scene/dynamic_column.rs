//! A column at rest, loaded at once or over a time, with all its waves.

use crate::scene::definition::{SceneDefinition, SceneLoad};
use oedometer_exact::reference::ReferenceKind;

const REFERENCES: &[ReferenceKind] = &[ReferenceKind::DynamicColumn, ReferenceKind::Terzaghi];

pub(crate) static DYNAMIC_COLUMN: SceneDefinition = SceneDefinition {
    summary: "column at rest under a sudden or growing load: waves and consolidation",
    references: REFERENCES,
    model_difference: |reference, _| (reference == ReferenceKind::Terzaghi).then_some("the inertia"),
    load: SceneLoad::SuddenOrGrowing(REFERENCES),
    has_waves: true,
    ..SceneDefinition::UNLOADED
};
