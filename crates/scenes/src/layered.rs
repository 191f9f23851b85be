//! A column of layers loaded at once and drained at its top, at small strain, from the undrained equilibrium of its own
//! operators.

use crate::scene::{Question, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;

/// The scene `layered`.
pub static LAYERED: Scene = Scene {
    name: "layered",
    summary: "column of several soils under a sudden load, drained at its top, small strain",
    question: Question::Layers,
    takes: &["drainage", "points", "soils"],
    references: &[SceneReference::own(ReferenceKind::Layered)],
    ..Scene::LOADED
};
