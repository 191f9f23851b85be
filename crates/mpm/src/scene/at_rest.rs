//! A column at rest under its own weight: nothing acts that its start does not balance, and nothing may move.

use crate::scene::definition::{
    ColumnStart, SceneBody, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartPressure,
};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static AT_REST: SceneDefinition = SceneDefinition {
    summary: "column without load at rest under its own weight: any motion is the method's own",
    references: &[ReferenceKind::AtRest],
    model_difference: |_, _| None,
    body: SceneBody::Column,
    strain: SceneStrain::Small,
    load: SceneLoad::None,
    has_waves: false,
    start: SceneStart::OverDepth(|_, _| Ok(ColumnStart::unloaded())),
    start_pressure: StartPressure::Uniform(|_, _| 0.0),
};
