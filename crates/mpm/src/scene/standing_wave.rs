//! An undrained standing wave in an unloaded column: smooth, with inertia only.

use crate::scene::column::column_parameters;
use crate::scene::definition::{ColumnStart, SceneDefinition, SceneStart, StartFields, StartPressure};
use oedometer_exact::dynamic_column::{DynamicColumn, Start};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static STANDING_WAVE: SceneDefinition = SceneDefinition {
    summary: "undrained standing wave, no load: smooth, for the order in the step",
    references: &[ReferenceKind::StandingWave],
    has_waves: true,
    start: SceneStart::OverDepth(|column, soil| {
        // Skeleton and water displaced together and let go at rest.
        let wave = DynamicColumn::new(&column_parameters(column, soil), Start::StandingWave, &[0.0])?;
        let soil = *soil;
        let fields = move |zeta: f64| {
            let fields = wave.fields(0.0, zeta)?;
            Ok(StartFields::at_rest(&soil, fields.pressure, fields.effective_stress))
        };
        Ok(ColumnStart { vertical_gradient: 0.0, fields: Box::new(fields) })
    }),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};
