//! An undrained standing wave in an unloaded column: smooth, with inertia only.

use crate::column::{Column, column_parameters};
use crate::scene::{Clock, Question, Scene, SceneReference, StartOf, StartPressure};
use oedometer_exact::dynamic_column::{self, DynamicColumn};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::solution::Solution;
use oedometer_problem::problem::{Start, StartFields};
use oedometer_problem::wave_speeds;
use oedometer_soil::material::Material;
use std::sync::Arc;

/// The scene `standing-wave`.
pub static STANDING_WAVE: Scene = Scene {
    name: "standing-wave",
    summary: "undrained standing wave, no load: smooth, for the order in the step",
    question: Question::Waves,
    waves: true,
    start: StartOf::OverDepth(let_go),
    start_pressure: StartPressure::OfReference,
    formulations: Scene::WITH_INERTIA,
    clock: Clock::Wave,
    outputs: between_the_zeros,
    references: &[SceneReference::own(ReferenceKind::StandingWave)],
    ..Scene::COLUMN
};

/// Skeleton and water displaced together and let go at rest.
fn let_go(column: &Column, soil: &Material) -> Result<Start, ExactError> {
    let parameters = column_parameters(column, soil);
    let wave = DynamicColumn::new(&parameters, dynamic_column::Start::StandingWave, &[0.0])?;
    let soil = *soil;
    let fields = move |zeta: f64| {
        let fields = wave.fields(0.0, zeta)?;
        Ok(StartFields::at_rest(&soil, fields.pressure, fields.effective_stress))
    };
    Ok(Start::OverDepth { gradient: 0.0, fields: Arc::new(fields) })
}

/// Times between the zeros of the wave, of its stress, and of the motions. It dies out within few periods, whose length in
/// time factors follows from soil and height.
fn between_the_zeros(column: &Column, soil: &Material) -> Vec<f64> {
    let period = |column: &Column, soil: &Material| {
        soil.coefficient_of_consolidation() / (column.height * wave_speeds::undrained_wave_speed(soil))
    };
    let longer = period(column, soil) / period(&Column::default(), &Material::default());
    // To three digits, as one types them.
    let plain = |factor: f64| format!("{factor:.2e}").parse().unwrap_or(factor);
    [1e-5, 5e-5, 1e-4].map(|factor| plain(longer * factor)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_outputs_of_a_standing_wave_follow_its_period() {
        let times = |height: f64, conductivity: f64, water: f64| {
            let column = Column { height, ..Column::default() };
            let soil = Material {
                hydraulic_conductivity: conductivity,
                water_bulk_modulus: water,
                ..Material::default()
            };
            (STANDING_WAVE.outputs)(&column, &soil)
        };
        let usual = times(1.0, 1e-4, 2.2e9);
        assert_eq!(usual, [1e-5, 5e-5, 1e-4]);
        // T_v of a period is c_v/(H V): in proportion to k, and less in a higher column or a stiffer water.
        assert_eq!(times(1.0, 1e-6, 2.2e9), [1e-7, 5e-7, 1e-6]);
        assert_eq!(times(4.0, 1e-4, 2.2e9), [2.5e-6, 1.25e-5, 2.5e-5]);
        let stiffer = times(1.0, 1e-4, 8.8e9);
        assert!(stiffer.iter().zip(&usual).all(|(a, b)| (2.0 * a / b - 1.0).abs() < 0.01), "{stiffer:?}");
    }
}
