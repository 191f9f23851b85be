//! Xie and Leo's column against high-precision values and its limits.

use super::*;
use crate::terzaghi::Terzaghi;
use oedometer_soil::material::Material;
use proptest::prelude::*;

fn column(strain: f64, porosity: f64) -> ColumnParameters {
    ColumnParameters {
        soil: Material { porosity, ..Material::default() },
        load: strain * ColumnParameters::default().soil.oedometric_modulus(),
        ..ColumnParameters::default()
    }
}

/// Time factor, depth, p/q, displacement of a column of 1 m.
const HIGH_PRECISION: [(f64, f64, f64, f64); 7] = [
    (1e-05, 0.002, 0.364_425_169_848_677_1, -0.000_294_638_848_070_485_16),
    (0.01, 0.1, 0.541_227_041_171_035_4, -0.006_129_715_404_146_638),
    (0.05, 0.5, 0.894_205_899_059_427, -0.002_358_912_429_162_455_5),
    (0.2, 0.25, 0.320_027_796_964_611_8, -0.044_890_473_758_123_81),
    (0.5, 0.9, 0.385_824_170_010_131_9, -0.009_683_092_182_163_91),
    (1.0, 1.0, 0.116_360_916_717_204_65, 6.025_670_131_653_330_6e-64),
    (3.0, 0.75, 0.000_780_647_387_017_535, -0.038_350_524_943_950_34),
];

#[test]
fn published_case_settles_as_published() {
    // m_v q = 1/6 for the seed column under 200 kPa: 0.15352 m in the end.
    let large = XieLeo::new(&column(1.0 / 6.0, 0.3)).unwrap();
    assert!((large.settlement(50.0).unwrap() - 0.153_518_275_109_385_93).abs() < 1e-15);
}

#[test]
fn fields_match_high_precision_values() {
    // mpmath, 40 digits: ln(1 + (e^m − 1) W)/m and −(1 − e^−m)[(1 − ζ) − I], m = 1/6.
    let large = XieLeo::new(&column(1.0 / 6.0, 0.3)).unwrap();
    let load = 2.0e5;
    for (time_factor, zeta, pressure, displacement) in HIGH_PRECISION {
        let fields = large.fields(time_factor, zeta).unwrap();
        assert!((fields.pressure / load - pressure).abs() < 1e-15);
        assert!((fields.displacement - displacement).abs() < 1e-16);
        assert_eq!(fields.effective_stress, fields.pressure - load);
    }
}

#[test]
fn small_loads_give_terzaghi() {
    let small = column(1e-12, 0.3);
    let large = XieLeo::new(&small).unwrap();
    let linear = Terzaghi::incompressible(&small).unwrap();
    for (time_factor, zeta) in [(1e-6, 0.001), (0.05, 0.2), (0.5, 0.9), (5.0, 0.3)] {
        let a = large.fields(time_factor, zeta).unwrap();
        let b = linear.fields(time_factor, zeta).unwrap();
        assert!((a.pressure / b.pressure - 1.0).abs() < 2e-12);
        assert!((a.displacement - b.displacement).abs() < 2e-12 * small.final_settlement());
    }
}

#[test]
fn a_load_that_closes_the_pores_is_refused() {
    assert!(XieLeo::new(&column(0.356, 0.3)).is_ok());
    let error = XieLeo::new(&column(0.4, 0.3)).unwrap_err().to_string();
    assert!(error.contains("must stay below -ln(1 - n) = 0.35667"), "{error}");
}

#[test]
fn a_load_that_grows_is_refused_with_the_way_out() {
    let growing = ColumnParameters { loading_time: 3.0, ..column(0.1, 0.3) };
    let error = XieLeo::new(&growing).unwrap_err().to_string();
    assert!(error.contains("load is sudden") && error.contains("`large-strain`"), "{error}");
}

proptest! {
    #[test]
    fn pressure_and_volume_agree(
        strain in 1e-9..0.7_f64,
        exponent in -6.0..1.0_f64,
        zeta in 0.0..=1.0_f64,
    ) {
        let parameters = column(strain, 0.55);
        let large = XieLeo::new(&parameters).unwrap();
        let time_factor = 10.0_f64.powf(exponent);
        let fields = large.fields(time_factor, zeta).unwrap();
        let ratio = large.volume_ratio(time_factor, zeta).unwrap();
        // σ' = E_oed ln J.
        let stress = parameters.soil.oedometric_modulus() * ratio.ln();
        prop_assert!((fields.effective_stress - stress).abs() < 1e-9);
        prop_assert!((0.0..=parameters.load * (1.0 + 1e-14)).contains(&fields.pressure));
    }
}
