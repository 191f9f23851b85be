//! What every reference keeps to.

use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_soil::material::Material;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn pressure_lies_between_zero_and_the_load(
        porosity in 0.05..0.9_f64,
        stiffness in -1.0..6.0_f64,
        conductivity in -11.0..-2.0_f64,
        strain in 1e-9..0.04_f64,
        exponent in -5.0..1.0_f64,
        zeta in 0.0..=1.0_f64,
    ) {
        let mut column = ColumnParameters { soil: Material { porosity, water_bulk_modulus: 1e6 * 10.0_f64.powf(stiffness), hydraulic_conductivity: 10.0_f64.powf(conductivity), ..Material::default() }, ..ColumnParameters::default() };
        column.load = strain * column.soil.oedometric_modulus();
        let time_factor = 10.0_f64.powf(exponent);
        // A yield front wants a soil that yields, a footing a plate.
        let has_more = [ReferenceKind::YieldFront, ReferenceKind::Footing];
        let is_plain = |kind: &ReferenceKind| !kind.is_manufactured() && !has_more.contains(kind);
        for kind in ReferenceKind::ALL.into_iter().filter(is_plain) {
            if matches!(kind, ReferenceKind::LargeStrain(_)) && exponent > -2.0 {
                // A march a case; its own tests have fewer.
                continue;
            }
            let reference = Reference::new(kind, &column, &[]).unwrap();
            let fields = reference.fields(time_factor, zeta).unwrap();
            prop_assert!(fields.pressure.is_finite() && fields.displacement.is_finite());
            if matches!(kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible) {
                // In two dimensions pressure may rise before it falls (Mandel 1953, Cryer 1963).
                prop_assert!(fields.pressure.abs() < 2.0 * column.load);
                continue;
            }
            if matches!(
                kind,
                ReferenceKind::DynamicColumn
                    | ReferenceKind::DynamicSingleMode
                    | ReferenceKind::StandingWave
            ) {
                // Waves overshoot, by no more than their reflections can add up to.
                prop_assert!(fields.pressure.abs() < 4.0 * column.load);
                continue;
            }
            let ratio = fields.pressure / column.load;
            prop_assert!((-1e-12..=1.0 + 1e-12).contains(&ratio), "{kind} {ratio}");
            // The slab's drained side bulges.
            prop_assert!(fields.displacement <= 1e-12 || kind == ReferenceKind::Mandel);
            let degree = reference.degree_of_consolidation(time_factor).unwrap();
            let later = reference.degree_of_consolidation(1.1 * time_factor).unwrap();
            prop_assert!(degree <= later && later <= 1.0 + 1e-12);
        }
    }
}
