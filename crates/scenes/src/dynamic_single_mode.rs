//! The slowest mode of an unloaded column, with the inertia that it has.

use crate::scene::{Question, Scene, SceneReference, StartOf, StartPressure};
use crate::single_mode::without_inertia;
use oedometer_exact::reference::ReferenceKind;

/// The scene `dynamic-single-mode`.
pub static DYNAMIC_SINGLE_MODE: Scene = Scene {
    name: "dynamic-single-mode",
    summary: "first eigenmode of consolidation with inertia, no load: smooth",
    question: Question::Waves,
    waves: true,
    formulations: Scene::WITH_INERTIA,
    references: &[
        SceneReference::own(ReferenceKind::DynamicSingleMode),
        SceneReference::beside(ReferenceKind::SingleMode, |_| Some("the inertia")),
    ],
    start: StartOf::OverDepth(without_inertia),
    start_pressure: StartPressure::OfReference,
    ..Scene::COLUMN
};
