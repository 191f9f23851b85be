//! Terzaghi's column: loaded at once, drained at its top, at small strain (docs/theory.md, Eq. 12).

use crate::column::{Column, column_parameters};
use crate::scene::{Scene, SceneReference, StartOf, StartPressure};
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::problem::{Start, StartFields};
use oedometer_soil::material::Material;

/// The scene `terzaghi`.
pub static TERZAGHI: Scene = Scene {
    name: "terzaghi",
    summary: "column under a sudden load, drained at its top, small strain",
    takes: &["drainage", "points", "self_weight"],
    references: &[
        SceneReference::own(ReferenceKind::Terzaghi),
        SceneReference::beside(ReferenceKind::TerzaghiIncompressible, |_| Some("the water's storage")),
    ],
    start: StartOf::OverDepth(|column, soil| Ok(undrained(column, soil))),
    // Written out here, and not taken from the solver or the reference: this is the check.
    start_pressure: StartPressure::Uniform(|column, soil| {
        column.load / (1.0 + soil.porosity * soil.oedometric_modulus() / soil.water_bulk_modulus)
    }),
    final_settlement: Some(|column, soil| column_parameters(column, soil).final_settlement()),
    ..Scene::LOADED
};

/// Skeleton and water share one strain, reached before any water has moved.
fn undrained(column: &Column, soil: &Material) -> Start {
    let strain = -column.load / (soil.oedometric_modulus() + soil.coupling_modulus());
    let [[lateral_stress, _], [_, vertical_stress]] = soil.stiffness().stress(&[[0.0, 0.0], [0.0, strain]]);
    let pressure = -soil.coupling_modulus() * strain;
    let fields = StartFields { pressure, vertical_stress, lateral_stress, ..StartFields::default() };
    Start::uniform(strain, fields)
}
