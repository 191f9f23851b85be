//! A sealed column: no water leaves, so it carries its load undrained.

use crate::scene::definition::{
    SceneBody, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartPressure,
};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static SEALED_ELEMENT: SceneDefinition = SceneDefinition {
    summary: "column under a sudden load that no water leaves, small strain",
    references: &[ReferenceKind::SealedElement],
    model_difference: |_, _| None,
    body: SceneBody::Column,
    strain: SceneStrain::Small,
    load: SceneLoad::Sudden,
    has_waves: false,
    start: SceneStart::Solved,
    start_pressure: StartPressure::OfReference,
};
