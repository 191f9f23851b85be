//! The large-strain reference against closed forms and its own balances.

use oedometer_exact::large_strain::{LargeStrain, LargeStrainModel, Water};
use oedometer_exact::numerics::integrate;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::solution::Solution;
use oedometer_exact::terzaghi::Terzaghi;
use oedometer_exact::xie_leo::XieLeo;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

const TIMES: [f64; 8] = [1e-6, 0.001, 0.01, 0.05, 0.2, 0.5, 1.0, 3.0];

fn column(load: f64) -> ColumnParameters {
    ColumnParameters { load, height: 2.0, ..ColumnParameters::default() }
}

fn model(law: Law, continuity: Continuity, water: Water) -> LargeStrainModel {
    LargeStrainModel { law, continuity, water }
}

const INCOMPRESSIBLE: LargeStrainModel = LargeStrainModel {
    law: Law::LogLinear,
    continuity: Continuity::Conservative,
    water: Water::Incompressible,
};

#[test]
fn incompressible_limit_is_xie_leo() {
    for load in [1.0, 1e3, 2e5, 4e5] {
        let column = column(load);
        let general = LargeStrain::new(&column, INCOMPRESSIBLE, &TIMES).unwrap();
        let closed = XieLeo::new(&column).unwrap();
        let mut worst = [0.0_f64; 2];
        for time_factor in TIMES {
            for i in 0..=50 {
                let zeta = f64::from(i * i) / 2500.0;
                let a = general.fields(time_factor, zeta).unwrap();
                let b = closed.fields(time_factor, zeta).unwrap();
                worst[0] = worst[0].max((a.pressure - b.pressure).abs() / load);
                let end = closed.final_strain() * column.height;
                worst[1] = worst[1].max((a.displacement - b.displacement).abs() / end);
            }
        }
        let accuracy = general.accuracy(0.5).unwrap();
        assert!(worst[0] < 2e-11 && worst[1] < 2e-11, "{worst:?}");
        // The stated accuracy is the coarser resolution's.
        assert!(worst[0] < accuracy.tail_bound && accuracy.tail_bound < 1e-9);
    }
}

#[test]
fn a_line_to_draw_is_what_it_says_and_takes_fewer_points() {
    // At seven tenths of strain the first two resolutions differ by 3e-6 of the load: too much for a line too.
    let steep =
        ColumnParameters { soil: Material { porosity: 0.8, ..column(1.444_8e6).soil }, ..column(1.444_8e6) };
    for column in [column(1e3), column(2e5), column(4e5), steep] {
        let drawn = LargeStrain::for_lines(&column, INCOMPRESSIBLE, &TIMES).unwrap();
        let closed = XieLeo::new(&column).unwrap();
        let accuracy = drawn.accuracy(0.5).unwrap();
        let worst = TIMES.iter().flat_map(|time| (0..=20).map(|i| (*time, f64::from(i) / 20.0)));
        let worst = worst.fold(0.0_f64, |worst, (time, zeta)| {
            let (a, b) = (drawn.fields(time, zeta).unwrap(), closed.fields(time, zeta).unwrap());
            worst.max((a.pressure - b.pressure).abs() / column.load)
        });
        assert!(worst < accuracy.tail_bound && accuracy.tail_bound < 1e-6, "{worst}, {accuracy:?}");
        let exact = LargeStrain::new(&column, INCOMPRESSIBLE, &TIMES).unwrap();
        assert!(accuracy.terms < exact.accuracy(0.5).unwrap().terms, "{accuracy:?}");
    }
}

#[test]
fn linear_law_is_terzaghi_with_storage() {
    for water_bulk_modulus in [2.2e9, 1.0e6] {
        let column =
            ColumnParameters { soil: Material { water_bulk_modulus, ..column(3.0e3).soil }, ..column(3.0e3) };
        let linear = model(Law::Linear, Continuity::ConstantPorosityGradient, Water::Compressible);
        let general = LargeStrain::new(&column, linear, &TIMES).unwrap();
        let closed = Terzaghi::compressible(&column).unwrap();
        for time_factor in [0.0].into_iter().chain(TIMES) {
            for zeta in [0.0, 0.01, 0.3, 0.77, 1.0] {
                let a = general.fields(time_factor, zeta).unwrap();
                let b = closed.fields(time_factor, zeta).unwrap();
                assert!((a.pressure - b.pressure).abs() < 1e-10 * column.load);
                let end = column.final_settlement();
                assert!((a.displacement - b.displacement).abs() < 1e-10 * end);
            }
            let degree = general.degree_of_consolidation(time_factor).unwrap();
            let expected = closed.degree_of_consolidation(time_factor).unwrap();
            assert!((degree - expected).abs() < 1e-10);
        }
    }
}

#[test]
fn governing_equations_hold() {
    // Finite differences of the published fields, put into the equations as they are printed.
    let column = ColumnParameters {
        soil: Material { water_bulk_modulus: 1.0e7, ..column(2.0e5).soil },
        ..column(2.0e5)
    };
    let (time_factor, zeta) = (0.15, 0.3);
    let (dt, dz) = (1e-4, 1e-3);
    let times = [time_factor - dt, time_factor, time_factor + dt];
    for law in Law::for_columns().skip(1) {
        for continuity in Continuity::ALL {
            let general =
                LargeStrain::new(&column, model(law, continuity, Water::Compressible), &times).unwrap();
            let volume = |t: f64, z: f64| general.volume_ratio(t, z).unwrap();
            let pressure = |t: f64, z: f64| general.fields(t, z).unwrap().pressure;
            let solids = 1.0 - column.soil.porosity;
            let porosity = |z: f64| 1.0 - solids / volume(time_factor, z);
            let discharge = |z: f64| {
                // ∂/∂Y = −(1/H) ∂/∂ζ.
                let gradient = -(pressure(time_factor, z + dz) - pressure(time_factor, z - dz))
                    / (2.0 * dz * column.height);
                let ratio = volume(time_factor, z);
                let conductivity = column.soil.hydraulic_conductivity * ratio * ratio;
                -conductivity / (column.soil.unit_weight_of_water() * ratio) * gradient
            };
            let along = |f: &dyn Fn(f64) -> f64| -(f(zeta + dz) - f(zeta - dz)) / (2.0 * dz * column.height);
            let outflow = match continuity {
                Continuity::Conservative => along(&discharge),
                Continuity::ConstantPorosityGradient => {
                    porosity(zeta) * along(&|z| discharge(z) / porosity(z))
                }
            };
            let rate = |f: &dyn Fn(f64, f64) -> f64| {
                (f(times[2], zeta) - f(times[0], zeta)) / column.time(times[2] - times[0])
            };
            let ratio = volume(time_factor, zeta);
            let stored =
                rate(&volume) + porosity(zeta) * ratio / column.soil.water_bulk_modulus * rate(&pressure);
            let misfit = (stored + outflow) / outflow;
            assert!(misfit.abs() < 2e-5, "{misfit:e} for {law:?} {continuity:?}");
            // The stress that the law gives at this volume is the published one.
            let modulus = column.soil.oedometric_modulus();
            let stress = match law {
                Law::LogLinear | Law::Engineering => modulus * ratio.ln(),
                Law::PorosityDependent => modulus * (1.0 - 1.0 / ratio),
                Law::Linear => modulus * (ratio - 1.0),
                Law::NeoHookean | Law::Preconsolidated | Law::VonMises => f64::NAN,
            };
            let published = general.fields(time_factor, zeta).unwrap().effective_stress;
            assert!((stress / published - 1.0).abs() < 1e-12);
            let total = pressure(time_factor, zeta) - column.load;
            assert!((total - published).abs() < 1e-9);
        }
    }
}

#[test]
fn unprepared_times_are_marched_to() {
    let column = column(2.0e5);
    let prepared = LargeStrain::new(&column, INCOMPRESSIBLE, &[0.3, 0.05]).unwrap();
    let closed = XieLeo::new(&column).unwrap();
    for time_factor in [0.0, 0.02, 0.05, 0.11, 0.3, 0.7, 60.0] {
        let difference = prepared.settlement(time_factor).unwrap() - closed.settlement(time_factor).unwrap();
        assert!(difference.abs() < 1e-11, "{difference:e} at {time_factor}");
    }
}

/// Relative L2 difference of two pressure profiles.
fn distance(time_factor: f64, a: &LargeStrain, b: &XieLeo) -> f64 {
    let (mut squares, mut norm) = (0.0, 0.0);
    for i in 0..400 {
        let zeta = (f64::from(i) + 0.5) / 400.0;
        let exact = b.fields(time_factor, zeta).unwrap().pressure;
        squares += (a.fields(time_factor, zeta).unwrap().pressure - exact).powi(2);
        norm += exact * exact;
    }
    (squares / norm).sqrt()
}

#[test]
fn traps_are_as_far_off_as_measured() {
    let column = ColumnParameters { load: 2.0e5, ..ColumnParameters::default() };
    let times = [0.05, 0.2, 0.5, 1.0];
    let closed = XieLeo::new(&column).unwrap();
    let figures = |law, continuity| {
        let general = LargeStrain::new(&column, model(law, continuity, Water::Compressible), &times).unwrap();
        times.map(|time_factor| {
            let settlement =
                general.settlement(time_factor).unwrap() / closed.settlement(time_factor).unwrap() - 1.0;
            (distance(time_factor, &general, &closed), settlement)
        })
    };
    // Relative L2 in pressure and error of settlement against Xie & Leo, at the times above.
    let expected = [
        (
            Law::LogLinear,
            Continuity::Conservative,
            [1.46e-4, 9.9e-5, 8.4e-6, 1.24e-4],
            [4.5e-4, 1.02e-4, 2.7e-6, -9.3e-6],
        ),
        (
            Law::LogLinear,
            Continuity::ConstantPorosityGradient,
            [0.046, 0.097, 0.181, 0.238],
            [0.114, 0.105, 0.0587, 0.0178],
        ),
        (
            Law::PorosityDependent,
            Continuity::Conservative,
            [0.0079, 0.0203, 0.0838, 0.230],
            [-0.0228, -0.0235, -0.0313, -0.0502],
        ),
        (
            Law::PorosityDependent,
            Continuity::ConstantPorosityGradient,
            [0.0508, 0.111, 0.245, 0.407],
            [0.0774, 0.0679, 0.0152, -0.0387],
        ),
    ];
    for (law, continuity, pressures, settlements) in expected {
        let computed = figures(law, continuity);
        for (i, (pressure, settlement)) in computed.into_iter().enumerate() {
            let near = |value: f64, printed: f64| (value - printed).abs() < 0.03 * printed.abs();
            assert!(near(pressure, pressures[i]), "{law:?} {continuity:?} {computed:?}");
            assert!(near(settlement, settlements[i]), "{law:?} {continuity:?} {computed:?}");
        }
    }
}

#[test]
fn loads_near_the_limit_still_converge() {
    for law in Law::for_columns() {
        for continuity in Continuity::ALL {
            let column = column(3.2e5);
            let general = LargeStrain::new(&column, model(law, continuity, Water::Compressible), &TIMES);
            assert!(general.is_ok_and(|g| g.accuracy(0.1).is_ok_and(|a| a.tail_bound < 1e-8)));
        }
    }
    let closing = LargeStrain::new(&column(4.4e5), LargeStrainModel::XIE_LEO, &[]);
    assert!(closing.is_err());
}

/// A linear ramp of Terzaghi's column by superposition: the mean of the step's answers so far.
#[test]
fn a_growing_load_at_small_strain_is_terzaghi_s_mean() {
    let column = ColumnParameters {
        soil: Material { water_bulk_modulus: 1.0e7, ..column(3.0e3).soil },
        ..column(3.0e3)
    };
    let duration = 0.08;
    let growing = ColumnParameters { loading_time: column.time(duration), ..column };
    let linear = model(Law::Linear, Continuity::Conservative, Water::Compressible);
    let times = [0.004, 0.05, 0.08, 0.0801, 0.3, 2.0];
    let general = LargeStrain::new(&growing, linear, &times).unwrap();
    let step = Terzaghi::compressible(&column).unwrap();
    for time_factor in times {
        // In u² the integrand is smooth at the moment that each share of the load comes on.
        let since = (time_factor - duration).max(0.0).sqrt();
        let mean = |value: &dyn Fn(f64) -> f64| {
            integrate(|u| 2.0 * u * value(u * u), since, time_factor.sqrt(), 100) / duration
        };
        for zeta in [0.0, 0.03, 0.4, 1.0] {
            let fields = general.fields(time_factor, zeta).unwrap();
            let pressure = mean(&|t| step.fields(t, zeta).unwrap().pressure);
            let displacement = mean(&|t| step.fields(t, zeta).unwrap().displacement);
            assert!((fields.pressure - pressure).abs() < 1e-9 * column.load, "{time_factor} {zeta}");
            assert!((fields.displacement - displacement).abs() < 1e-9 * column.final_settlement());
            let total = fields.pressure - fields.effective_stress;
            assert!((total / column.load - (time_factor / duration).min(1.0)).abs() < 1e-12);
        }
    }
}

#[test]
fn a_growing_load_ends_like_a_sudden_load_and_is_refined_to_its_bound() {
    let sudden = ColumnParameters {
        soil: Material { porosity: 0.7, ..Material::default() },
        load: 8.4e5,
        height: 1.0,
        ..ColumnParameters::default()
    };
    let growing = ColumnParameters { loading_time: sudden.time(0.05), ..sudden };
    let times = [0.01, 0.05, 0.2, 1.0, 8.0];
    for continuity in Continuity::ALL {
        let model = model(Law::LogLinear, continuity, Water::Compressible);
        let general = LargeStrain::new(&growing, model, &times).unwrap();
        assert!(general.accuracy(0.2).unwrap().tail_bound < 1e-8, "{:?}", general.accuracy(0.2));
        let at_once = LargeStrain::new(&sudden, model, &times).unwrap();
        let gap = |time_factor: f64| {
            at_once.settlement(time_factor).unwrap() - general.settlement(time_factor).unwrap()
        };
        assert!(gap(0.05) > 0.01 && gap(0.2) > 0.0 && gap(8.0).abs() < 1e-9);
        // After a short ramp it is as if the load had acted at once in the middle of it.
        let short = ColumnParameters { loading_time: sudden.time(1e-3), ..sudden };
        let short = LargeStrain::new(&short, model, &times).unwrap();
        let moved = short.settlement(0.2).unwrap() - at_once.settlement(0.2 - 5e-4).unwrap();
        assert!(moved.abs() < 1e-4, "{moved:e}");
    }
}

#[test]
fn governing_equation_holds_while_the_load_grows() {
    let column = ColumnParameters {
        soil: Material { water_bulk_modulus: 1.0e7, ..column(2.0e5).soil },
        ..column(2.0e5)
    };
    let growing = ColumnParameters { loading_time: column.time(0.3), ..column };
    let (time_factor, zeta, dt, dz) = (0.15, 0.3, 1e-4, 1e-3);
    let general = LargeStrain::new(
        &growing,
        LargeStrainModel::XIE_LEO,
        &[time_factor - dt, time_factor, time_factor + dt],
    )
    .unwrap();
    let volume = |t: f64, z: f64| general.volume_ratio(t, z).unwrap();
    let pressure = |t: f64, z: f64| general.fields(t, z).unwrap().pressure;
    let discharge = |z: f64| {
        let gradient =
            -(pressure(time_factor, z + dz) - pressure(time_factor, z - dz)) / (2.0 * dz * column.height);
        let conductivity = column.soil.hydraulic_conductivity * volume(time_factor, z);
        -conductivity / column.soil.unit_weight_of_water() * gradient
    };
    let outflow = -(discharge(zeta + dz) - discharge(zeta - dz)) / (2.0 * dz * column.height);
    let rate = |f: &dyn Fn(f64, f64) -> f64| {
        (f(time_factor + dt, zeta) - f(time_factor - dt, zeta)) / column.time(2.0 * dt)
    };
    let pores = volume(time_factor, zeta) - (1.0 - column.soil.porosity);
    let stored = rate(&volume) + pores / column.soil.water_bulk_modulus * rate(&pressure);
    assert!(((stored + outflow) / outflow).abs() < 2e-5, "{}", (stored + outflow) / outflow);
}
