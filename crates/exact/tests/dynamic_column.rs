//! The dynamic column against 20-digit values and its own limits.
#![allow(clippy::print_stderr, reason = "a test tells how far it was off")]

use oedometer_exact::FieldValues;
use oedometer_exact::dynamic_column::{DynamicColumn, DynamicFields, Start};
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::single_mode::SingleMode;
use oedometer_exact::solution::Solution;
use oedometer_exact::terzaghi::Terzaghi;
use oedometer_soil::material::Material;

/// time factor, height, `u_solid/q`, `u_water/q`, p/q of the seed column.
fn published() -> impl Iterator<Item = [f64; 5]> {
    include_str!("reference/dynamic_column.csv").lines().skip(1).map(|line| {
        let mut row = [0.0; 5];
        for (value, cell) in row.iter_mut().zip(line.split(',')) {
            *value = cell.parse().unwrap();
        }
        row
    })
}

#[test]
fn seed_column_matches_high_precision_values() {
    let seed = ColumnParameters::default();
    let times: Vec<f64> = published().map(|row| row[0]).collect();
    let column = DynamicColumn::new(&seed, Start::Step, &times).unwrap();
    let end = seed.final_settlement();
    let mut worst = [0.0_f64; 3];
    for [time_factor, height, solid, water, pressure] in published() {
        let fields = column.dynamic_fields(time_factor, 1.0 - height).unwrap();
        let errors = [
            (fields.solid.displacement - solid) / end,
            (fields.water_displacement - water) / end,
            fields.solid.pressure - pressure,
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
        assert!(column.accuracy(time_factor).unwrap().tail_bound < 1e-16);
    }
    eprintln!("worst errors of u, U_w over the final settlement and of p/q: {worst:?}");
    assert!(worst.iter().all(|&worst| worst < 1e-12), "{worst:?}");
}

/// Relative L2 difference of two pressure profiles.
fn difference(a: impl Fn(f64) -> f64, b: impl Fn(f64) -> f64) -> f64 {
    let (mut squares, mut norm) = (0.0, 0.0);
    for i in 0..200 {
        let zeta = (f64::from(i) + 0.5) / 200.0;
        squares += (a(zeta) - b(zeta)).powi(2);
        norm += b(zeta).powi(2);
    }
    (squares / norm).sqrt()
}

#[test]
fn seed_column_departs_from_terzaghi_as_measured() {
    let seed = ColumnParameters::default();
    let dynamic = DynamicColumn::new(&seed, Start::Step, &[0.05, 0.0005]).unwrap();
    let storage = Terzaghi::compressible(&seed).unwrap();
    let plain = Terzaghi::incompressible(&seed).unwrap();
    let late = difference(
        |zeta| dynamic.fields(0.05, zeta).unwrap().pressure,
        |zeta| storage.fields(0.05, zeta).unwrap().pressure,
    );
    assert!((1.2e-6..1.5e-6).contains(&late), "{late:e}");
    let early = difference(
        |zeta| dynamic.fields(0.0005, zeta).unwrap().pressure,
        |zeta| plain.fields(0.0005, zeta).unwrap().pressure,
    );
    assert!((0.19..0.25).contains(&early), "{early}");
}

#[test]
fn sluggish_columns_become_terzaghis() {
    // k from 1e-6 down: inertia leaves the picture, overdamped slow roots and fast drag roots stay.
    for (hydraulic_conductivity, allowed) in [(1e-6, 1e-9), (1e-8, 1e-13), (1e-10, 5e-15)] {
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity, ..Material::default() },
            ..ColumnParameters::default()
        };
        let dynamic = DynamicColumn::new(&column, Start::Step, &[0.05, 0.5]).unwrap();
        let storage = Terzaghi::compressible(&column).unwrap();
        // Before T_v ≈ 0.03 undrained waves still run: their attenuation is as slow as the drainage.
        for time_factor in [0.05, 0.5] {
            for zeta in [0.0, 0.1, 0.5, 1.0] {
                let a = dynamic.fields(time_factor, zeta).unwrap();
                let b = storage.fields(time_factor, zeta).unwrap();
                assert!((a.pressure - b.pressure).abs() < allowed);
                assert!((a.effective_stress - b.effective_stress).abs() < allowed);
                let end = column.final_settlement();
                assert!((a.displacement - b.displacement).abs() < allowed * end);
            }
        }
    }
}

#[test]
fn waves_run_in_permeable_columns() {
    // k = 1e-2 at T_v = 0.05: fronts are still sharp, and the reference says so.
    let column = ColumnParameters {
        soil: Material { hydraulic_conductivity: 1e-2, ..Material::default() },
        ..ColumnParameters::default()
    };
    let dynamic = DynamicColumn::new(&column, Start::Step, &[0.05, 5.0]).unwrap();
    assert!(dynamic.accuracy(0.05).unwrap().tail_bound > 1e-6);
    assert!(dynamic.accuracy(5.0).unwrap().tail_bound < 1e-16);
    // Nothing has reached the base before the fastest wave has.
    let arrival = column.height / 2034.0;
    let before = column.time_factor(0.8 * arrival);
    let fields = dynamic.fields(before, 1.0).unwrap();
    assert!(fields.pressure.abs() < 1e-3, "{fields:?}");
    let surface = dynamic.fields(before, 0.5).unwrap();
    assert!(surface.pressure > 0.5, "{surface:?}");
}

#[test]
fn start_is_at_rest() {
    let seed = ColumnParameters::default();
    for start in [Start::Step, Start::Ramp { duration: 0.1 }] {
        let column = DynamicColumn::new(&seed, start, &[]).unwrap();
        let fields = column.dynamic_fields(0.0, 0.3).unwrap();
        assert_eq!(fields.solid.pressure, 0.0);
        assert_eq!(fields.solid.displacement, 0.0);
        assert_eq!(fields.velocities.water, 0.0);
        assert_eq!(column.degree_of_consolidation(0.0).unwrap(), 0.0);
    }
}

#[test]
fn velocities_are_the_displacements_rates() {
    let seed = ColumnParameters::default();
    let duration = 0.2;
    for (start, time) in [
        (Start::Step, 0.5),
        (Start::Mode, 0.1),
        (Start::StandingWave, 1.3e-3),
        (Start::Ramp { duration }, 0.15),
        (Start::Ramp { duration }, 0.4),
    ] {
        let column = DynamicColumn::new(&seed, start, &[]).unwrap();
        let at = |time: f64| column.dynamic_fields(seed.time_factor(time), 0.05).unwrap();
        let step = 1e-6;
        let (before, now, after) = (at(time - step), at(time), at(time + step));
        let slope = |f: fn(&DynamicFields) -> f64| (f(&after) - f(&before)) / (2.0 * step);
        let solid = slope(|f| f.solid.displacement);
        let water = slope(|f| f.water_displacement);
        assert!((solid / now.velocities.solid - 1.0).abs() < 1e-5, "{start:?}");
        assert!((water / now.velocities.water - 1.0).abs() < 1e-5, "{start:?}");
    }
}

#[test]
fn ramp_is_the_mean_of_steps() {
    // Duhamel: the response to a ramp is the mean over its duration of the responses to steps.
    let seed = ColumnParameters::default();
    let step = DynamicColumn::new(&seed, Start::Step, &[]).unwrap();
    let duration = 0.3;
    let ramp = DynamicColumn::new(&seed, Start::Ramp { duration }, &[]).unwrap();
    let mean = |time: f64, zeta: f64, parts: u32, field: fn(&FieldValues) -> f64| {
        // Over τ = (√x)², for the step's fields start like √t.
        let from = (time - duration).max(0.0);
        oedometer_exact::numerics::integrate(
            |root| {
                let fields = step.fields(seed.time_factor(root * root), zeta).unwrap();
                2.0 * root * field(&fields)
            },
            from.sqrt(),
            time.sqrt(),
            parts,
        ) / duration
    };
    // Waves have many kinks at small times. After they have died the mean is exact.
    for (time, zeta, parts, tolerance) in
        [(0.2, 0.02, 20, 1e-3), (0.3, 0.1, 20, 1e-3), (0.5, 0.05, 20, 1e-3), (2.0, 0.1, 5, 1e-12)]
    {
        let fields = ramp.fields(seed.time_factor(time), zeta).unwrap();
        let pressure = mean(time, zeta, parts, |f| f.pressure);
        let displacement = mean(time, zeta, parts, |f| f.displacement);
        assert!((fields.pressure - pressure).abs() < tolerance, "{} {pressure} at {time}", fields.pressure);
        assert!((fields.displacement / displacement - 1.0).abs() < tolerance);
    }
}

#[test]
fn ramp_is_continuous_at_its_end() {
    let seed = ColumnParameters::default();
    let duration = seed.time(0.01);
    let ramp = DynamicColumn::new(&seed, Start::Ramp { duration }, &[]).unwrap();
    let before = ramp.fields(0.01 * (1.0 - 1e-12), 0.3).unwrap();
    let after = ramp.fields(0.01 * (1.0 + 1e-12), 0.3).unwrap();
    assert!((before.pressure - after.pressure).abs() < 1e-9);
    assert!((before.displacement / after.displacement - 1.0).abs() < 1e-9);
}

#[test]
fn released_mode_starts_like_the_single_mode() {
    let seed = ColumnParameters { height: 2.0, load: 50.0, ..ColumnParameters::default() };
    let dynamic = DynamicColumn::new(&seed, Start::Mode, &[]).unwrap();
    let mode = SingleMode::compressible(&seed).unwrap();
    for zeta in [0.0, 0.3, 1.0] {
        let a = dynamic.dynamic_fields(0.0, zeta).unwrap();
        let b = mode.fields(0.0, zeta).unwrap();
        assert!((a.solid.pressure - b.pressure).abs() < 1e-9);
        assert!((a.solid.effective_stress - b.effective_stress).abs() < 1e-9);
        assert!(a.solid.displacement.abs() < 1e-10 * seed.final_settlement(), "{:e}", a.solid.displacement);
        let velocities = mode.velocities(0.0, zeta).unwrap();
        let scale = mode.velocities(0.0, 0.0).unwrap().water;
        assert!((a.velocities.solid - velocities.solid).abs() < 1e-9 * scale);
        assert!((a.velocities.water - velocities.water).abs() < 1e-9 * scale);
        let a = dynamic.fields(0.2, zeta).unwrap();
        let b = mode.fields(0.2, zeta).unwrap();
        assert!((a.pressure - b.pressure).abs() < 1e-4);
        assert!((a.displacement - b.displacement).abs() < 1e-5 * seed.final_settlement());
    }
}

#[test]
fn a_standing_wave_starts_at_rest_and_swings_with_the_undrained_period() {
    // Hardly any water moves against the grains: k = 1e-9, and the period is 4H/√((E_oed + Q)/ρ).
    let column = ColumnParameters {
        soil: Material { hydraulic_conductivity: 1e-9, ..Material::default() },
        load: 7.0,
        ..ColumnParameters::default()
    };
    let wave = DynamicColumn::new(&column, Start::StandingWave, &[]).unwrap();
    let start = wave.dynamic_fields(0.0, 0.4).unwrap();
    assert!((start.solid.pressure / (7.0 * (0.4 * core::f64::consts::FRAC_PI_2).sin()) - 1.0).abs() < 1e-12);
    assert!(start.solid.displacement.abs() < 1e-12 * wave.fields(1.0, 0.4).unwrap().displacement.abs());
    assert!(start.velocities.solid.abs() + start.velocities.water.abs() < 1e-14);
    let density = 0.7 * 2650.0 + 0.3 * 1000.0;
    let speed = ((column.soil.oedometric_modulus() + column.soil.coupling_modulus()) / density).sqrt();
    let period = column.time_factor(4.0 * column.height / speed);
    let at = |periods: f64| wave.fields(periods * period, 1.0).unwrap().pressure / 7.0;
    for (periods, pressure) in [(0.25, 0.0), (0.5, -1.0), (1.0, 1.0), (3.0, 1.0)] {
        assert!((at(periods) - pressure).abs() < 1e-4, "{periods}: {}", at(periods));
    }
}

#[test]
fn critically_damped_modes_are_no_exception() {
    // k between over- and underdamped slow waves of the first mode: scan through the double root.
    let mut last: Option<f64> = None;
    for i in 0..=400 {
        let hydraulic_conductivity = 10.0_f64.powf(-2.2 + 1.2 * f64::from(i) / 400.0);
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity, ..Material::default() },
            ..ColumnParameters::default()
        };
        let mode = DynamicColumn::new(&column, Start::Mode, &[]).unwrap();
        let time_factor = column.time_factor(2.0e-3);
        let pressure = mode.fields(time_factor, 0.7).unwrap().pressure;
        assert!(pressure.abs() < 2.0);
        if let Some(last) = last {
            assert!((pressure - last).abs() < 0.05, "{last} {pressure} at {i}");
        }
        last = Some(pressure);
    }
}

/// Worst errors over all rows of `dynamic_ramp.csv`: displacements over the final settlement, pressure
/// over the load, and what the bound allows.
#[test]
fn a_growing_load_matches_high_precision_values() {
    let mut rows = 0;
    for line in include_str!("reference/dynamic_ramp.csv").lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [conductivity, duration, time, height, solid, water, pressure] = cells[..] else {
            panic!("{line}")
        };
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity: conductivity, ..Material::default() },
            ..ColumnParameters::default()
        };
        let ramp = DynamicColumn::new(&column, Start::Ramp { duration }, &[]).unwrap();
        let time_factor = column.time_factor(time);
        let fields = ramp.dynamic_fields(time_factor, 1.0 - height).unwrap();
        let end = column.final_settlement();
        let errors = [
            (fields.solid.displacement - solid) / end,
            // The water leaves through the surface: it moves further by what the pores hold of it.
            (fields.water_displacement - water) / end,
            (fields.solid.pressure - pressure) / column.load,
        ];
        let bound = ramp.accuracy(time_factor).unwrap().tail_bound;
        assert!(bound < 1e-12, "{line}: {bound:e}");
        assert!(errors.iter().all(|error| error.abs() < 1e-12), "{line}: {errors:?}");
        rows += 1;
    }
    assert_eq!(rows, 135);
}

#[test]
fn a_kink_that_is_sharp_is_bounded() {
    // Before the fastest wave arrives nothing has: what is left at the base is the error.
    for hydraulic_conductivity in [1e-4, 1e-2] {
        let column = ColumnParameters {
            soil: Material { hydraulic_conductivity, ..Material::default() },
            ..ColumnParameters::default()
        };
        for duration in [1e-6, 1e-5, 1e-4, 1e-3] {
            let ramp = DynamicColumn::new(&column, Start::Ramp { duration }, &[]).unwrap();
            for share in [0.3, 0.8] {
                let time_factor = column.time_factor(share * column.height / 2034.0);
                let error = ramp.fields(time_factor, 1.0).unwrap().pressure.abs();
                let bound = ramp.accuracy(time_factor).unwrap().tail_bound;
                eprintln!("{hydraulic_conductivity} {duration} {share}: {error:e} {bound:e}");
                assert!(error <= bound, "{duration} {share}: {error:e} over {bound:e}");
            }
        }
    }
}

/// A column of unequal numbers that is let go from a mode, and what its file says of it: pressure over the load,
/// displacement of the solid over that of the start.
fn released() -> impl Iterator<Item = (Start, ColumnParameters, [f64; 2], [f64; 2])> {
    include_str!("reference/released_waves.csv").lines().skip(1).map(|line| {
        let (start, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<f64> = numbers.split(',').map(|cell| cell.parse().unwrap()).collect();
        let &[hydraulic_conductivity, water_bulk_modulus, time_factor, zeta, pressure, moved] = &*numbers
        else {
            panic!("six numbers: {line}")
        };
        let start = if start == "standing-wave" { Start::StandingWave } else { Start::Mode };
        let column = ColumnParameters {
            soil: Material {
                youngs_modulus: 2.5e6,
                poissons_ratio: 0.2,
                porosity: 0.35,
                grain_density: 2700.0,
                water_density: 1020.0,
                gravity: 9.7,
                water_bulk_modulus,
                hydraulic_conductivity,
                ..Material::default()
            },
            height: 0.7,
            load: 3.0,
            ..ColumnParameters::default()
        };
        (start, column, [time_factor, zeta], [pressure, moved])
    })
}

#[test]
fn phases_of_waves_that_ran_long_are_within_their_stated_bound() {
    let (mut largest_share, mut largest_bound) = (0.0_f64, 0.0_f64);
    for (start, parameters, [time_factor, zeta], [pressure, moved]) in released() {
        let column = DynamicColumn::new(&parameters, start, &[]).unwrap();
        let fields = column.fields(time_factor, zeta).unwrap();
        let wave_number = std::f64::consts::FRAC_PI_2 / parameters.height;
        let start_modulus = if start == Start::Mode {
            parameters.soil.oedometric_modulus()
        } else {
            -parameters.soil.coupling_modulus()
        };
        let at_start = parameters.load / (start_modulus * wave_number);
        let bound = column.accuracy(time_factor).unwrap().bound();
        let off = (fields.pressure / parameters.load - pressure).abs();
        let off_place = (fields.displacement / at_start - moved).abs();
        assert!(
            off <= 1e-14 + bound,
            "{start:?} {parameters:?} T_v = {time_factor}: {off:e}, bound {bound:e}"
        );
        assert!(off_place <= 1e-13 + bound, "{start:?} {parameters:?}: {off_place:e}, bound {bound:e}");
        largest_bound = largest_bound.max(bound);
        if off > 1e-13 {
            largest_share = largest_share.max(off / bound);
        }
    }
    // A bound that is met by a hundredth is one; beyond a radian of phase it would say nothing.
    assert!(largest_share > 1e-2 && (1e-9..1.0).contains(&largest_bound), "{largest_share} {largest_bound}");
}
