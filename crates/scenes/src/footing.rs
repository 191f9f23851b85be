//! A rigid strip footing that is pushed into undrained soil: half of it by symmetry, at small strain, from rest.
//!
//! The plate settles by its own width in the time of `T_v = 1`, so that time factors are settlements over the width; the
//! soil is without inertia, and how fast it goes makes no difference.

use crate::column::{Column, Undrained};
use crate::limit::{Limit, MethodLimit, PLATE_HOLDS_NODES};
use crate::scene::{Allowed, Body, Check, Clock, Laws, LoadKind, Question, Scene, SceneReference};
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::quantity::Quantity;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// The scene `footing`.
pub static FOOTING: Scene = Scene {
    name: "footing",
    summary: "strip footing on undrained soil that yields: its collapse load reveals locking",
    question: Question::Locking,
    body: Body::Layer,
    locks: true,
    load: LoadKind::Pushed,
    column: Column::under_footing,
    soil: clay,
    laws: Laws::Only(Law::VonMises),
    takes: &["plate_width", "plate", "undrained", "undrained_strength"],
    integrators: Allowed {
        list: &[IntegratorKind::Implicit],
        why: "the plate is pushed so slowly that there is no inertia: the integrator is `implicit`",
        instead: "leave the key out",
    },
    formulations: Allowed {
        list: &[Formulation::QuasiStatic],
        why: "a footing is quasi-static: it has no inertia",
        instead: "leave `formulation` out",
    },
    methods: &[
        MethodLimit {
            refuses: |method| method.has_projection(),
            why: "a pressure projection has unknown pressures at the nodes, but the footing's follow from \
                  displacements",
        },
        PLATE_HOLDS_NODES,
    ],
    limits: &[
        Limit {
            key: "cells",
            refuses: |it| it.cells % 2 == 1,
            why: "an odd number of cells under a footing: half of it is solved, and its middle lies on a node",
            instead: "use an even number",
        },
        Limit {
            key: "plate_width",
            refuses: |it| it.column.footing.width >= 2.0 * it.column.extent(),
            why: "the layer ends under the footing: half of the footing must lie on it",
            instead: "make `length` more than half of `plate_width`: 2.5 times `plate_width` is enough",
        },
        Limit {
            key: "method",
            refuses: |it| {
                it.column.footing.undrained == Undrained::TotalStress
                    && it.method.strain.with_bbar().is_none()
            },
            why: "the composite gradient between domain ends has no separate volumetric part, which total \
                  stress needs",
            instead: "use another method, or `undrained = \"two-phase\"`",
        },
    ],
    clock: Clock::Push,
    outputs: |_, _| vec![0.01, 0.02, 0.05],
    references: &[SceneReference::own(ReferenceKind::Footing)],
    quantities: &[Quantity::LoadFactor],
    unjudged: &[(Check::Water, "no water leaves the soil under a footing")],
    ..Scene::COLUMN
};

/// A clay of 10 kPa that yields long before the first output.
fn clay() -> Material {
    let clay = Material { law: Law::VonMises, undrained_strength: 1e4, ..Material::default() };
    Material { youngs_modulus: 1e7, poissons_ratio: 0.4999, ..clay }
}
