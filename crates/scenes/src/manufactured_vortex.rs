//! A square with a disc inside that turns, at large strain.

use crate::manufactured::{OF_ALL, soil, square};
use crate::scene::{Scene, SceneReference};
use oedometer_exact::manufactured::motion::{ManufacturedModel, Motion};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::material::Material;

const MODEL: ManufacturedModel = ManufacturedModel::with_default_law(Motion::Vortex);

/// The scene `manufactured-vortex`.
pub static MANUFACTURED_VORTEX: Scene = Scene {
    name: "manufactured-vortex",
    summary: "a disc that rotates inside a square, and back: separates rotating from non-rotating particle domains",
    motion: Some(MODEL),
    column: || square([0.0, 0.0, 1.5]),
    soil: || Material { law: MODEL.law, ..soil() },
    takes: &["amplitude"],
    references: &[SceneReference::own(ReferenceKind::Manufactured(MODEL))],
    ..OF_ALL
};
