//! A plane layer loaded at once by a cosine and drained at its top, at small strain, from the undrained equilibrium.

use crate::column::Column;
use crate::scene::{Body, LoadKind, Question, Scene, SceneReference, StartPressure};
use oedometer_exact::reference::ReferenceKind;

/// The scene `cosine-layer`.
pub static COSINE_LAYER: Scene = Scene {
    name: "cosine-layer",
    summary: "plane layer under a cosine load, drained at its top: reveals locking",
    axes: "y is measured upward from the base, impermeable, fixed along y and if rough along x, to the drained \
           surface; x from the crest of the load, load · cos(π x/width), to its trough; at both ends there is \
           neither flow nor motion along x",
    question: Question::Locking,
    body: Body::Layer,
    locks: true,
    load: LoadKind::Cosine,
    column: Column::layer,
    takes: &["points", "load"],
    references: &[
        SceneReference::own(ReferenceKind::CosineLayer),
        SceneReference::beside(ReferenceKind::CosineLayerIncompressible, |_| Some("the water's storage")),
    ],
    // Of a cosine only the mean is known.
    start_pressure: StartPressure::ZeroMean,
    // Later the pressure has drained along the layer, too.
    outputs: |_, _| vec![0.05, 0.1, 0.2, 0.5],
    ..Scene::LOADED
};
