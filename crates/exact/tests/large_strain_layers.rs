//! Layers at large strain against the column of one soil, the exact layered column and finite volumes.

use oedometer_exact::large_strain::{LargeStrain, LargeStrainModel};
use oedometer_exact::layered::LayeredColumn;
use oedometer_exact::numerics::integrate;
use oedometer_exact::parameters::{ColumnParameters, Drainage};
use oedometer_exact::solution::Solution;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;

const TIMES: [f64; 4] = [0.05, 0.2, 0.4, 1.0];

fn layers(list: &[SoilLayer]) -> SoilLayers {
    SoilLayers::from_slice(list).expect("few")
}

/// A column of 2 m under a load that grows to the time factor 0.2.
fn column(load: f64, list: &[SoilLayer]) -> ColumnParameters {
    let seed = ColumnParameters { load, height: 2.0, soils: layers(list), ..ColumnParameters::default() };
    let soil = Material { porosity: 0.5, water_bulk_modulus: 1e8, ..seed.soil };
    let seed = ColumnParameters { soil, ..seed };
    ColumnParameters { loading_time: seed.time(0.2), ..seed }
}

/// A layer that is softer and lets water through ten times as fast, over one of the column's soil.
fn soft_over_tight() -> [SoilLayer; 2] {
    let soft = SoilLayer {
        thickness: 0.8,
        youngs_modulus: Some(6e5),
        porosity: Some(0.6),
        hydraulic_conductivity: Some(1e-3),
        ..SoilLayer::default()
    };
    [SoilLayer { thickness: 1.2, hydraulic_conductivity: Some(1e-4), ..SoilLayer::default() }, soft]
}

#[test]
fn layers_of_one_soil_are_the_column_without_them() {
    for law in [Law::LogLinear, Law::PorosityDependent, Law::Linear] {
        let model = LargeStrainModel { law, ..LargeStrainModel::XIE_LEO };
        let cut = [0.5, 1.1, 0.4].map(|thickness| SoilLayer { thickness, ..SoilLayer::default() });
        let (single, split) = (column(4e5, &[]), column(4e5, &cut));
        let [single, split] = [single, split].map(|column| LargeStrain::new(&column, model, &TIMES).unwrap());
        for time_factor in TIMES {
            for zeta in [0.0, 0.01, 0.2, 0.3, 0.5, 0.75, 0.9, 1.0] {
                let [a, b] = [&single, &split].map(|column| column.fields(time_factor, zeta).unwrap());
                assert!((a.pressure - b.pressure).abs() < 1e-9 * 4e5, "{law:?} {time_factor} {zeta}");
                assert!((a.displacement - b.displacement).abs() < 1e-9, "{law:?} {time_factor} {zeta}");
                let [a, b] = [&single, &split].map(|column| column.volume_ratio(time_factor, zeta).unwrap());
                assert!((a - b).abs() < 1e-9);
            }
            let [a, b] = [&single, &split].map(|column| column.degree_of_consolidation(time_factor).unwrap());
            assert!((a - b).abs() < 1e-9);
        }
        assert!(split.accuracy(0.2).unwrap().bound() < 1e-8);
    }
}

#[test]
fn a_linear_law_gives_the_exact_layered_column_under_a_load_that_grows() {
    let column = column(3e3, &soft_over_tight());
    let linear = LargeStrainModel { law: Law::Linear, ..LargeStrainModel::XIE_LEO };
    let large_strain = LargeStrain::new(&column, linear, &TIMES).unwrap();
    let soils: Vec<_> =
        column.soils.iter().map(|layer| (layer.thickness, layer.soil(&column.soil))).collect();
    let exact = LayeredColumn::new(column.load, &soils, Drainage::Top).unwrap();
    for time_factor in [0.4, 1.0] {
        for zeta in [0.05, 0.4, 0.41, 0.7, 1.0] {
            // Every share of the load consolidates by itself (Duhamel).
            let mean = |function: &dyn Fn(f64) -> f64| {
                let at = |share: f64| function(column.time(time_factor) - share * column.loading_time);
                integrate(at, 0.0, 1.0, 8)
            };
            let pressure = mean(&|seconds| exact.fields_after(seconds, 2.0 * (1.0 - zeta)).unwrap().pressure);
            let settlement = mean(&|seconds| exact.settlement_after(seconds).unwrap());
            let fields = large_strain.fields(time_factor, zeta).unwrap();
            assert!((fields.pressure - pressure).abs() < 1e-9 * column.load, "{time_factor} {zeta}");
            assert!((large_strain.settlement(time_factor).unwrap() / settlement - 1.0).abs() < 1e-8);
        }
    }
}

/// Pressures over the load in the middles of `cells` cells per layer, from the base up, and the settlement over the
/// height: finite volumes in material coordinates with the law `σ' = E ln J`, `k = k_0 J²`, and explicit steps of the
/// classical method of order four.
fn finite_volumes(column: &ColumnParameters, time_factor: f64, cells: usize) -> (Vec<f64>, f64) {
    let mut soils = Vec::new();
    for layer in column.soils.iter() {
        soils.extend(std::iter::repeat_n((layer.soil(&column.soil), layer.thickness / cells as f64), cells));
    }
    let (end, growth) = (column.time(time_factor), column.load / column.loading_time);
    let load = |time: f64| growth * time.min(column.loading_time);
    let ratio = |soil: &Material, stress: f64| (stress / soil.oedometric_modulus()).exp();
    let rate = |pressure: &[f64], time: f64| -> Vec<f64> {
        let acting = load(time);
        let rate_of_load = if time < column.loading_time { growth } else { 0.0 };
        let volume: Vec<f64> =
            soils.iter().zip(pressure).map(|((soil, _), pressure)| ratio(soil, pressure - acting)).collect();
        // Resistances of half cells in series.
        let half = |i: usize| {
            let (soil, size) = &soils[i];
            0.5 * size * soil.unit_weight_of_water() / (soil.hydraulic_conductivity * volume[i])
        };
        let flux = |i: usize| match pressure.get(i + 1) {
            Some(above) => (pressure[i] - above) / (half(i) + half(i + 1)),
            None => pressure[i] / half(i),
        };
        (0..pressure.len())
            .map(|i| {
                let (soil, size) = &soils[i];
                let outflow = flux(i) - if i == 0 { 0.0 } else { flux(i - 1) };
                let compliance = volume[i] / soil.oedometric_modulus();
                let pores = volume[i] - (1.0 - soil.porosity);
                (compliance * rate_of_load - outflow / size) / (compliance + pores / soil.water_bulk_modulus)
            })
            .collect()
    };
    let fastest = soils.iter().map(|(soil, size)| size * size / soil.coefficient_of_consolidation());
    let longest = 0.4 * fastest.fold(f64::INFINITY, f64::min);
    let mut pressure = vec![0.0; soils.len()];
    // A step ends where the growth does.
    for (from, to) in [(0.0, end.min(column.loading_time)), (end.min(column.loading_time), end)] {
        let steps =
            (0..31).map(|power| 1_u32 << power).find(|steps| to - from <= longest * f64::from(*steps));
        let steps = steps.expect("not that many");
        let dt = (to - from) / f64::from(steps);
        for step in 0..steps {
            let time = from + f64::from(step) * dt;
            let moved = |by: &[f64], share: f64| -> Vec<f64> {
                pressure.iter().zip(by).map(|(pressure, rate)| pressure + share * dt * rate).collect()
            };
            // The load of the last stage still grows.
            let late = (time + dt).min(to * (1.0 - 1e-15));
            let k1 = rate(&pressure, time);
            let k2 = rate(&moved(&k1, 0.5), time + 0.5 * dt);
            let k3 = rate(&moved(&k2, 0.5), time + 0.5 * dt);
            let k4 = rate(&moved(&k3, 1.0), late);
            for i in 0..pressure.len() {
                pressure[i] += dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
    }
    let acting = load(end);
    let shortened =
        soils.iter().zip(&pressure).map(|((soil, size), p)| size * (1.0 - ratio(soil, p - acting)));
    let settlement = shortened.sum::<f64>() / column.height;
    (pressure.iter().map(|pressure| pressure / column.load).collect(), settlement)
}

#[test]
fn finite_volumes_converge_to_it_with_the_square_of_their_size() {
    let column = column(1.5e5, &soft_over_tight());
    let reference = LargeStrain::new(&column, LargeStrainModel::XIE_LEO, &[0.1, 0.4]).unwrap();
    for time_factor in [0.1, 0.4] {
        let errors = [10_usize, 20, 40].map(|cells| {
            let (pressures, settlement) = finite_volumes(&column, time_factor, cells);
            let mut worst = 0.0_f64;
            let mut base = 0.0;
            for (layer, pressures) in column.soils.iter().zip(pressures.chunks(cells)) {
                let size = layer.thickness / cells as f64;
                for (i, pressure) in pressures.iter().enumerate() {
                    let zeta = 1.0 - (base + (i as f64 + 0.5) * size) / column.height;
                    let exact = reference.fields(time_factor, zeta).unwrap().pressure / column.load;
                    worst = worst.max((pressure - exact).abs());
                }
                base += layer.thickness;
            }
            let exact = reference.settlement(time_factor).unwrap() / column.height;
            [worst, (settlement / exact - 1.0).abs()]
        });
        for quantity in 0..2 {
            let orders = [0, 1].map(|i| (errors[i][quantity] / errors[i + 1][quantity]).log2());
            assert!(orders.iter().all(|order| (1.8..2.3).contains(order)), "{orders:?} of {errors:?}");
            assert!(errors[2][quantity] < 3e-4, "{errors:?}");
        }
    }
    // A fifth of the soft layer's height has gone, and the strain jumps at the interface.
    let [above, below] = [0.399, 0.401].map(|zeta| reference.volume_ratio(0.4, zeta).unwrap());
    assert!(above < 0.83 && below > 0.87, "{above} {below}");
}

#[test]
fn what_has_no_solution_is_refused_with_a_sentence() {
    let sound = column(1.5e5, &soft_over_tight());
    let said = |column: &ColumnParameters, continuity| {
        let model = LargeStrainModel { continuity, ..LargeStrainModel::XIE_LEO };
        LargeStrain::new(column, model, &[0.4]).expect_err("refused").to_string()
    };
    let at_once = ColumnParameters { loading_time: 0.0, ..sound };
    assert!(said(&at_once, Continuity::Conservative).contains("give a loading time"));
    assert!(said(&sound, Continuity::ConstantPorosityGradient).contains("jumps of the porosity"));
    let heavy = ColumnParameters { self_weight: true, ..sound };
    assert!(said(&heavy, Continuity::Conservative).contains("has no weight here"));
    let gap = ColumnParameters { height: 3.0, ..sound };
    assert!(said(&gap, Continuity::Conservative).contains("they must fill it"));
    // The soft layer's pores close where those of the column's soil would not.
    let heavy = ColumnParameters { load: 7e5, ..sound };
    assert!(said(&heavy, Continuity::Conservative).contains("more water than the pores hold"));
    let closed = oedometer_exact::xie_leo::XieLeo::new(&at_once).expect_err("refused").to_string();
    assert!(closed.contains("no closed form"), "{closed}");
}
