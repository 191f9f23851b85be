//! A square with shear inside, at large strain.

use crate::manufactured::{OF_ALL, soil, square};
use crate::scene::{Scene, SceneReference};
use oedometer_exact::manufactured::motion::{ManufacturedModel, Motion};
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::material::Material;

const MODEL: ManufacturedModel = ManufacturedModel::with_default_law(Motion::Shear);

/// The scene `manufactured-shear`.
pub static MANUFACTURED_SHEAR: Scene = Scene {
    name: "manufactured-shear",
    summary: "the same with internal shear, in a neo-Hookean soil",
    motion: Some(MODEL),
    column: || square([0.25, -0.2, 0.0]),
    soil: || Material { law: MODEL.law, ..soil() },
    takes: &["amplitude_x", "amplitude_y"],
    references: &[SceneReference::own(ReferenceKind::Manufactured(MODEL))],
    ..OF_ALL
};
