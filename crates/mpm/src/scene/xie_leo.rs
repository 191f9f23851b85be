//! A column loaded at once or over a time and drained at its top, at large strain, from the undrained
//! equilibrium.

use crate::scene::column::Column;
use crate::scene::definition::{
    ColumnStart, SceneDefinition, SceneLoad, SceneStart, SceneStrain, StartFields,
};
use oedometer_exact::large_strain::diffusion::LargeStrainModel;
use oedometer_exact::reference::ReferenceKind;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// The large-strain reference of the default law; [`ReferenceKind::of_soil`] takes that of a soil.
const LARGE_STRAIN: ReferenceKind = ReferenceKind::LargeStrain(LargeStrainModel::XIE_LEO);

pub(crate) static XIE_LEO: SceneDefinition = SceneDefinition {
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
    strain: SceneStrain::Large,
    // Xie & Leo's load acts at once.
    load: SceneLoad::SuddenOrGrowing(&[LARGE_STRAIN]),
    start: SceneStart::OverDepth(|column, soil| Ok(undrained(column, soil))),
    ..SceneDefinition::LOADED
};

/// Corrections of the undrained strain; a few are enough where the water is stiffer than the soil.
const MOST_CORRECTIONS: usize = 60;

/// The undrained equilibrium at finite strain, `p(J) − σ'(J) = q` with `J − 1` the displacement gradient;
/// a load that grows finds the soil at rest without stress.
fn undrained(column: &Column, soil: &Material) -> ColumnStart {
    if column.loading_time > 0.0 {
        return ColumnStart::unloaded();
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
    ColumnStart::uniform(strain, fields)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_undrained_start_is_in_equilibrium_whatever_the_law() {
        for law in Law::OF_COLUMNS {
            for (load, stiffness) in [(1.0, 2.2e9), (2e5, 2.2e9), (2e5, 2e7), (2e5, 2e6)] {
                let soil = Material { law, water_bulk_modulus: stiffness, ..Material::default() };
                let start = undrained(&Column { load, ..Column::default() }, &soil);
                assert!(start.vertical_gradient < 0.0 && start.vertical_gradient > -0.1);
                let fields = (start.fields)(0.5).expect("inside");
                let total = fields.pressure - fields.vertical_stress;
                assert!((total / load - 1.0).abs() < 1e-9, "{law:?} {load} {stiffness}: {total}");
            }
        }
    }
}
