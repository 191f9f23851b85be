//! A sealed column: no water leaves, so it carries its load undrained.

use crate::limit::Limit;
use crate::scene::{Clock, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::settings::{Drag, ExplicitSettings};

/// The scene `sealed-element`.
pub static SEALED_ELEMENT: Scene = Scene {
    name: "sealed-element",
    summary: "sealed (undrained) column under a sudden load, small strain",
    sealed: true,
    // Water that does not leave would bound the step without limit.
    settings: || ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() },
    clock: Clock::Nothing,
    references: &[SceneReference::own(ReferenceKind::SealedElement)],
    limits: &[Limit {
        key: "drag",
        refuses: |it| it.integrator == IntegratorKind::Explicit && it.settings.drag == Drag::Explicit,
        why: "explicit drag in a nearly impermeable soil needs steps below 1e-12 of the wave limit",
        instead: "use `drag = \"implicit\"`",
    }],
    ..Scene::LOADED
};
