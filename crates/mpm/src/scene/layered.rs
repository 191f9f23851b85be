//! A column of layers loaded at once and drained at its top, at small strain, from the undrained equilibrium of its own
//! operators.

use crate::scene::definition::{
    SceneBody, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartPressure,
};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static LAYERED: SceneDefinition = SceneDefinition {
    summary: "column of several soils under a sudden load, drained at its top, small strain",
    references: &[ReferenceKind::Layered],
    model_difference: |_, _| None,
    body: SceneBody::Column,
    strain: SceneStrain::Small,
    load: SceneLoad::Sudden,
    has_waves: false,
    start: SceneStart::Solved,
    start_pressure: StartPressure::OfReference,
};
