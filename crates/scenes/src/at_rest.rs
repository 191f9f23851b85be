//! A column at rest under its own weight: nothing acts that its start does not balance, and nothing may move.

use crate::column::Column;
use crate::scene::{Check, Question, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;

/// The scene `at-rest`.
pub static AT_REST: Scene = Scene {
    name: "at-rest",
    summary: "column in hydrostatic equilibrium under its own weight, no load: any motion is numerical error",
    question: Question::Rest,
    column: || Column { self_weight: true, ..Column::default() },
    takes: &["points", "self_weight"],
    references: &[SceneReference::own(ReferenceKind::AtRest)],
    unjudged: &[(Check::Pressure, "the pressures are those of self-weight")],
    ..Scene::COLUMN
};
