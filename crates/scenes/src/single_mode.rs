//! The slowest mode of an unloaded column: smooth in space and time.

use crate::column::{Column, column_parameters};
use crate::scene::{Scene, SceneReference, StartOf, StartPressure};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::single_mode::SingleMode;
use oedometer_exact::solution::Solution;
use oedometer_problem::problem::{Start, StartFields};
use oedometer_soil::material::Material;
use std::sync::Arc;

/// The scene `single-mode`.
pub static SINGLE_MODE: Scene = Scene {
    name: "single-mode",
    summary: "first eigenmode of consolidation, no load: smooth, for formal orders",
    references: &[SceneReference::own(ReferenceKind::SingleMode)],
    start: StartOf::OverDepth(without_inertia),
    start_pressure: StartPressure::OfReference,
    ..Scene::COLUMN
};

/// The mode of the quasi-static equations, with the velocities that it has.
pub(crate) fn without_inertia(column: &Column, soil: &Material) -> Result<Start, ExactError> {
    let mode = SingleMode::compressible(&column_parameters(column, soil))?;
    let soil = *soil;
    let fields = move |zeta: f64| {
        let fields = mode.fields(0.0, zeta)?;
        let velocities = mode.velocities(0.0, zeta)?;
        Ok(StartFields {
            solid_velocity: velocities.solid,
            water_velocity: velocities.water,
            ..StartFields::at_rest(&soil, fields.pressure, fields.effective_stress)
        })
    };
    Ok(Start::OverDepth { gradient: 0.0, fields: Arc::new(fields) })
}
