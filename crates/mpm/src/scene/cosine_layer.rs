//! A plane layer loaded at once by a cosine and drained at its top, at small strain, from the undrained
//! equilibrium.

use crate::scene::definition::{SceneBody, SceneDefinition, SceneLoad, StartPressure};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static COSINE_LAYER: SceneDefinition = SceneDefinition {
    summary: "plane layer under a cosine load, drained at its top: where locking shows",
    references: &[ReferenceKind::CosineLayer, ReferenceKind::CosineLayerIncompressible],
    model_difference: |reference, _| {
        (reference == ReferenceKind::CosineLayerIncompressible).then_some("the water's storage")
    },
    body: SceneBody::Layer,
    load: SceneLoad::Cosine,
    // Of a cosine only the mean is known.
    start_pressure: StartPressure::ZeroMean,
    ..SceneDefinition::LOADED
};
