//! A column at rest, loaded at once or over a time, with all its waves.

use crate::scene::definition::{
    ColumnStart, SceneBody, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartPressure,
};
use oedometer_exact::reference::ReferenceKind;

const REFERENCES: &[ReferenceKind] = &[ReferenceKind::DynamicColumn, ReferenceKind::Terzaghi];

pub(crate) static DYNAMIC_COLUMN: SceneDefinition = SceneDefinition {
    summary: "column at rest under a sudden or growing load: waves and consolidation",
    references: REFERENCES,
    model_difference: |reference, _| (reference == ReferenceKind::Terzaghi).then_some("the inertia"),
    body: SceneBody::Column,
    strain: SceneStrain::Small,
    load: SceneLoad::SuddenOrGrowing(REFERENCES),
    has_waves: true,
    start: SceneStart::OverDepth(|_, _| Ok(ColumnStart::unloaded())),
    start_pressure: StartPressure::Uniform(|_, _| 0.0),
};
