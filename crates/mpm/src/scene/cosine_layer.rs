//! A plane layer loaded at once by a cosine and drained at its top, at small strain, from the undrained
//! equilibrium.

use crate::scene::definition::{
    SceneBody, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartPressure,
};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static COSINE_LAYER: SceneDefinition = SceneDefinition {
    summary: "plane layer under a cosine load, drained at its top: where locking shows",
    references: &[ReferenceKind::CosineLayer, ReferenceKind::CosineLayerIncompressible],
    model_difference: |reference, _| {
        (reference == ReferenceKind::CosineLayerIncompressible).then_some("the water's storage")
    },
    body: SceneBody::Layer,
    strain: SceneStrain::Small,
    load: SceneLoad::Cosine,
    has_waves: false,
    // The solver's own equilibrium, and what it measures; of a cosine only the mean is known.
    start: SceneStart::Solved,
    start_pressure: StartPressure::ZeroMean,
};
