//! A square stretched along its axes by body forces, at large strain.

use crate::manufactured::{OF_ALL, soil, square};
use crate::scene::{Scene, SceneReference};
use oedometer_exact::manufactured::motion::{ManufacturedModel, Motion};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::material::Material;

const MODEL: ManufacturedModel = ManufacturedModel::with_default_law(Motion::Box);

/// The scene `manufactured-box`.
pub static MANUFACTURED_BOX: Scene = Scene {
    name: "manufactured-box",
    summary: "square stretched along its axes by body forces, and back: exact fields at large strain in the plane",
    motion: Some(MODEL),
    column: || square([0.25, 0.25, 0.0]),
    soil: || Material { law: MODEL.law, ..soil() },
    takes: &["amplitude_x", "amplitude_y"],
    references: &[SceneReference::own(ReferenceKind::Manufactured(MODEL))],
    ..OF_ALL
};
