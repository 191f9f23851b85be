//! A preconsolidated column loaded at once beyond its preconsolidation and drained at its top: undrained it stays elastic,
//! and as the water leaves a front of yielding runs in from the surface. Stresses are counted from those of the start.

use crate::scene::{Clock, Laws, Question, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// The scene `yield-front`.
pub static YIELD_FRONT: Scene = Scene {
    name: "yield-front",
    summary: "preconsolidated column under a sudden load: a yield front advances from its drained top",
    question: Question::Layers,
    soil: clay,
    laws: Laws::Only(Law::Preconsolidated),
    takes: &["points", "initial_stress", "reload_modulus", "preconsolidation"],
    clock: Clock::HalfSpace,
    // It has no front once the base is felt.
    outputs: |_, _| vec![0.0005, 0.001, 0.002, 0.004],
    references: &[SceneReference::own(ReferenceKind::YieldFront)],
    ..Scene::LOADED
};

/// A clay, five times as stiff up to half of the load.
fn clay() -> Material {
    let clay = Material { hydraulic_conductivity: 1e-7, porosity: 0.5, ..Material::default() };
    Material { law: Law::Preconsolidated, reload_modulus: 6e6, preconsolidation: 0.5, ..clay }
}
