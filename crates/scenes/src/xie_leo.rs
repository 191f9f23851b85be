//! A column loaded at once or over a time and drained at its top, at large strain, from the undrained equilibrium.

use crate::column::Column;
use crate::scene::{Laws, Question, Scene, SceneReference, StartOf};
use oedometer_exact::large_strain::diffusion::LargeStrainModel;
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::problem::{Start, StartFields, Strain};
use oedometer_soil::continuity::Continuity;
use oedometer_soil::elementary;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// The large-strain reference of the default law; [`ReferenceKind::for_soil`] takes that of a soil.
const LARGE_STRAIN: ReferenceKind = ReferenceKind::LargeStrain(LargeStrainModel::XIE_LEO);
/// Corrections of the undrained strain; a few are enough where the water is stiffer than the soil.
const MOST_CORRECTIONS: usize = 60;

/// The scene `xie-leo`.
pub static XIE_LEO: Scene = Scene {
    name: "xie-leo",
    summary: "column under a sudden load, drained at its top, large strain",
    question: Question::LargeStrain,
    strain: Strain::Large,
    soil: || Material { law: Law::LogLinear, ..Material::default() },
    laws: Laws::OfColumns,
    takes: &["drainage", "points", "self_weight", "loading_time", "soils"],
    references: &[
        SceneReference::own(LARGE_STRAIN),
        // Xie & Leo's load acts at once.
        SceneReference {
            holds_growing: false,
            ..SceneReference::beside(ReferenceKind::XieLeo, |soil| Some(neglected(soil)))
        },
    ],
    start: StartOf::OverDepth(|column, soil| Ok(undrained(column, soil))),
    final_settlement: Some(|column, soil| {
        let strain = 1.0 - elementary::exp(-column.load / soil.oedometric_modulus());
        column.height * strain
    }),
    ..Scene::LOADED
};

/// What Xie & Leo's solution neglects.
fn neglected(soil: &Material) -> &'static str {
    match (soil.continuity, soil.law == Law::PorosityDependent) {
        (Continuity::Conservative, false) => "the water's storage",
        (Continuity::Conservative, true) => "the modulus in rate form",
        (Continuity::ConstantPorosityGradient, false) => "the neglected porosity gradient",
        (Continuity::ConstantPorosityGradient, true) => {
            "the neglected porosity gradient and the modulus in rate form"
        }
    }
}

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
            (Conservative, Law::PorosityDependent, "the modulus in rate form"),
            (ConstantPorosityGradient, Law::LogLinear, "the neglected porosity gradient"),
            (
                ConstantPorosityGradient,
                Law::PorosityDependent,
                "the neglected porosity gradient and the modulus in rate form",
            ),
        ] {
            let soil = Material { continuity, law, ..Material::default() };
            let difference = |reference| XIE_LEO.model_difference(reference, &soil);
            assert_eq!(difference(ReferenceKind::XieLeo), Some(cause), "{law:?} {continuity:?}");
            assert_eq!(difference(LARGE_STRAIN), None);
        }
    }
}
