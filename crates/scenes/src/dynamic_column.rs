//! A column at rest, loaded at once or over a time, with all its waves.

use crate::scene::{Clock, LoadKind, Question, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;

/// The scene `dynamic-column`.
pub static DYNAMIC_COLUMN: Scene = Scene {
    name: "dynamic-column",
    summary: "column under a sudden or growing load, with inertia: waves and consolidation",
    question: Question::Waves,
    waves: true,
    load: LoadKind::Uniform,
    takes: &["points", "self_weight", "loading_time"],
    formulations: Scene::WITH_INERTIA,
    clock: Clock::Consolidation,
    references: &[
        SceneReference::own(ReferenceKind::DynamicColumn),
        SceneReference::beside(ReferenceKind::Terzaghi, |_| Some("the inertia")),
    ],
    ..Scene::COLUMN
};
