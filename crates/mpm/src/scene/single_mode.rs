//! The slowest mode of an unloaded column: smooth in space and time.

use crate::scene::column::{Column, column_parameters};
use crate::scene::definition::{ColumnStart, SceneDefinition, SceneStart, StartFields, StartPressure};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::single_mode::SingleMode;
use oedometer_soil::material::Material;

pub(crate) static SINGLE_MODE: SceneDefinition = SceneDefinition {
    summary: "slowest consolidation mode, no load: smooth, for formal orders",
    references: &[ReferenceKind::SingleMode],
    start: SceneStart::OverDepth(mode_without_inertia),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};

/// The mode of the quasi-static equations, with the velocities that it has.
pub(crate) fn mode_without_inertia(column: &Column, soil: &Material) -> Result<ColumnStart, ExactError> {
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
    Ok(ColumnStart { vertical_gradient: 0.0, fields: Box::new(fields) })
}
