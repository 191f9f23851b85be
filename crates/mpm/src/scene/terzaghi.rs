//! A column loaded at once and drained at its top, at small strain, from the undrained equilibrium.

use crate::scene::definition::{ColumnStart, SceneDefinition, SceneStart, StartFields, StartPressure};
use oedometer_exact::reference::ReferenceKind;

pub(crate) static TERZAGHI: SceneDefinition = SceneDefinition {
    summary: "column under a sudden load, drained at its top, small strain",
    references: &[ReferenceKind::Terzaghi, ReferenceKind::TerzaghiIncompressible],
    model_difference: |reference, _| {
        (reference == ReferenceKind::TerzaghiIncompressible).then_some("the water's storage")
    },
    start: SceneStart::OverDepth(|column, soil| {
        // Skeleton and water share one strain, reached before any water has moved.
        let strain = -column.load / (soil.oedometric_modulus() + soil.coupling_modulus());
        let [[lateral_stress, _], [_, vertical_stress]] =
            soil.stiffness().stress(&[[0.0, 0.0], [0.0, strain]]);
        let pressure = -soil.coupling_modulus() * strain;
        let fields = StartFields { pressure, vertical_stress, lateral_stress, ..StartFields::default() };
        Ok(ColumnStart::uniform(strain, fields))
    }),
    // Written out here, and not taken from the solver or the reference: this is the check.
    start_pressure: StartPressure::Uniform(|column, soil| {
        column.load / (1.0 + soil.porosity * soil.oedometric_modulus() / soil.water_bulk_modulus)
    }),
    ..SceneDefinition::LOADED
};
