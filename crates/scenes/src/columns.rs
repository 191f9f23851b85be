//! Scenes of a column: what acts on it, how it starts, and which exact solutions hold for it.

use crate::column::{Column, column_parameters};
use crate::definition::{SceneDefinition, SceneLoad, SceneStart, StartPressure};
use oedometer_exact::dynamic_column::{self, DynamicColumn};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::large_strain::diffusion::LargeStrainModel;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::single_mode::SingleMode;
use oedometer_exact::solution::Solution;
use oedometer_problem::problem::{Start, StartFields, Strain};
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;
use std::sync::Arc;

/// The large-strain reference of the default law; [`ReferenceKind::for_soil`] takes that of a soil.
const LARGE_STRAIN: ReferenceKind = ReferenceKind::LargeStrain(LargeStrainModel::XIE_LEO);

/// References of the dynamic column, whether its load acts at once or grows.
const WITH_WAVES: &[ReferenceKind] = &[ReferenceKind::DynamicColumn, ReferenceKind::Terzaghi];
/// Corrections of the undrained strain; a few are enough where the water is stiffer than the soil.
const MOST_CORRECTIONS: usize = 60;

/// A column loaded at once and drained at its top, at small strain, from the undrained equilibrium.
pub(super) static TERZAGHI: SceneDefinition = SceneDefinition {
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
        Ok(Start::uniform(strain, fields))
    }),
    // Written out here, and not taken from the solver or the reference: this is the check.
    start_pressure: StartPressure::Uniform(|column, soil| {
        column.load / (1.0 + soil.porosity * soil.oedometric_modulus() / soil.water_bulk_modulus)
    }),
    ..SceneDefinition::LOADED
};

/// The slowest mode of an unloaded column: smooth in space and time.
pub(super) static SINGLE_MODE: SceneDefinition = SceneDefinition {
    summary: "first eigenmode of consolidation, no load: smooth, for formal orders",
    references: &[ReferenceKind::SingleMode],
    start: SceneStart::OverDepth(mode_without_inertia),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};

/// The mode of the quasi-static equations, with the velocities that it has.
fn mode_without_inertia(column: &Column, soil: &Material) -> Result<Start, ExactError> {
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

/// A column loaded at once or over a time and drained at its top, at large strain, from the undrained
/// equilibrium.
pub(super) static XIE_LEO: SceneDefinition = SceneDefinition {
    summary: "column under a sudden load, drained at its top, large strain",
    references: &[LARGE_STRAIN, ReferenceKind::XieLeo],
    model_difference: |reference, soil| {
        (reference == ReferenceKind::XieLeo).then_some(
            match (soil.continuity, soil.law == Law::PorosityDependent) {
                (Continuity::Conservative, false) => "the water's storage",
                (Continuity::Conservative, true) => "the modulus in the rate form",
                (Continuity::ConstantPorosityGradient, false) => "the dropped porosity gradient",
                (Continuity::ConstantPorosityGradient, true) => {
                    "the dropped porosity gradient and the modulus in the rate form"
                }
            },
        )
    },
    strain: Strain::Large,
    // Xie & Leo's load acts at once.
    load: SceneLoad::SuddenOrGrowing(&[LARGE_STRAIN]),
    start: SceneStart::OverDepth(|column, soil| Ok(undrained(column, soil))),
    ..SceneDefinition::LOADED
};

/// The undrained equilibrium at finite strain, `p(J) − σ'(J) = q` with `J − 1` the displacement gradient;
/// a load that grows finds the soil at rest without stress.
fn undrained(column: &Column, soil: &Material) -> Start {
    if column.loading_time > 0.0 {
        return Start::unloaded();
    }
    let modulus = soil.oedometric_modulus();
    let carried =
        |strain: f64| soil.undrained_pressure_at(strain) - modulus * soil.law.uniaxial_stress_ratio(strain);
    let mut strain = 0.0;
    for _ in 0..MOST_CORRECTIONS {
        // The tangent of the unstrained state: the undrained strain is tiny, and it converges fast.
        let change = (carried(strain) - column.load) / (modulus + soil.coupling_modulus());
        strain += change;
        if change.abs() < f64::EPSILON * strain.abs() {
            break;
        }
    }
    let stress = modulus * soil.law.uniaxial_stress_ratio(strain);
    let fields = StartFields::at_rest(soil, soil.undrained_pressure_at(strain), stress);
    Start::uniform(strain, fields)
}

/// A column at rest, loaded at once or over a time, with all its waves.
pub(super) static DYNAMIC_COLUMN: SceneDefinition = SceneDefinition {
    summary: "column at rest under a sudden or growing load: waves and consolidation",
    references: WITH_WAVES,
    model_difference: |reference, _| (reference == ReferenceKind::Terzaghi).then_some("the inertia"),
    load: SceneLoad::SuddenOrGrowing(WITH_WAVES),
    has_waves: true,
    ..SceneDefinition::UNLOADED
};

/// The slowest mode of an unloaded column, with the inertia that it has.
pub(super) static DYNAMIC_SINGLE_MODE: SceneDefinition = SceneDefinition {
    summary: "first eigenmode of consolidation with inertia, no load: smooth",
    references: &[ReferenceKind::DynamicSingleMode, ReferenceKind::SingleMode],
    model_difference: |reference, _| (reference == ReferenceKind::SingleMode).then_some("the inertia"),
    has_waves: true,
    start: SceneStart::OverDepth(mode_without_inertia),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};

/// An undrained standing wave in an unloaded column: smooth, with inertia only.
pub(super) static STANDING_WAVE: SceneDefinition = SceneDefinition {
    summary: "undrained standing wave, no load: smooth, for the order in the step",
    references: &[ReferenceKind::StandingWave],
    has_waves: true,
    start: SceneStart::OverDepth(|column, soil| {
        // Skeleton and water displaced together and let go at rest.
        let wave = DynamicColumn::new(
            &column_parameters(column, soil),
            dynamic_column::Start::StandingWave,
            &[0.0],
        )?;
        let soil = *soil;
        let fields = move |zeta: f64| {
            let fields = wave.fields(0.0, zeta)?;
            Ok(StartFields::at_rest(&soil, fields.pressure, fields.effective_stress))
        };
        Ok(Start::OverDepth { gradient: 0.0, fields: Arc::new(fields) })
    }),
    start_pressure: StartPressure::OfReference,
    ..SceneDefinition::UNLOADED
};

/// A column at rest under its own weight: nothing acts that its start does not balance, and nothing may move.
pub(super) static AT_REST: SceneDefinition = SceneDefinition {
    summary: "column in hydrostatic equilibrium under its own weight, no load: any motion is numerical error",
    references: &[ReferenceKind::AtRest],
    ..SceneDefinition::UNLOADED
};

/// A column of layers loaded at once and drained at its top, at small strain, from the undrained equilibrium of its own
/// operators.
pub(super) static LAYERED: SceneDefinition = SceneDefinition {
    summary: "column of several soils under a sudden load, drained at its top, small strain",
    references: &[ReferenceKind::Layered],
    ..SceneDefinition::LOADED
};

/// A preconsolidated column loaded at once beyond its preconsolidation and drained at its top: undrained it stays elastic,
/// and as the water leaves a front of yielding runs in from the surface. Stresses are counted from those of the start.
pub(super) static YIELD_FRONT: SceneDefinition = SceneDefinition {
    summary: "preconsolidated column under a sudden load: a front of yielding runs in from its drained top",
    references: &[ReferenceKind::YieldFront],
    ..SceneDefinition::LOADED
};

/// A sealed column: no water leaves, so it carries its load undrained.
pub(super) static SEALED_ELEMENT: SceneDefinition = SceneDefinition {
    summary: "sealed (undrained) column under a sudden load, small strain",
    references: &[ReferenceKind::SealedElement],
    ..SceneDefinition::LOADED
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_undrained_start_is_in_equilibrium_whatever_the_law() {
        for law in Law::for_columns() {
            for (load, stiffness) in [(1.0, 2.2e9), (2e5, 2.2e9), (2e5, 2e7), (2e5, 2e6)] {
                let soil = Material { law, water_bulk_modulus: stiffness, ..Material::default() };
                let start = undrained(&Column { load, ..Column::default() }, &soil);
                let Start::OverDepth { gradient, fields } = start else { panic!("over the depth") };
                assert!(gradient < 0.0 && gradient > -0.1);
                let fields = fields(0.5).expect("inside");
                let total = fields.pressure - fields.vertical_stress;
                assert!((total / load - 1.0).abs() < 1e-9, "{law:?} {load} {stiffness}: {total}");
            }
        }
    }

    #[test]
    fn the_floor_against_xie_and_leo_is_attributed_to_the_neglected_terms() {
        use oedometer_soil::continuity::Continuity::{Conservative, ConstantPorosityGradient};
        for (continuity, law, cause) in [
            (Conservative, Law::LogLinear, "the water's storage"),
            (Conservative, Law::PorosityDependent, "the modulus in the rate form"),
            (ConstantPorosityGradient, Law::LogLinear, "the dropped porosity gradient"),
            (
                ConstantPorosityGradient,
                Law::PorosityDependent,
                "the dropped porosity gradient and the modulus in the rate form",
            ),
        ] {
            let soil = Material { continuity, law, ..Material::default() };
            let difference = |reference| (XIE_LEO.model_difference)(reference, &soil);
            assert_eq!(difference(ReferenceKind::XieLeo), Some(cause), "{law:?} {continuity:?}");
            assert_eq!(difference(LARGE_STRAIN), None);
        }
    }
}
