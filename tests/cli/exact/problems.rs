//! Exact solutions of layered soil, a yield front and a sealed element, by the program, against independent values.

use crate::program::{Told, call};
use std::path::Path;

fn exact(arguments: &[&str]) -> Told {
    call(Path::new("."), &[&["exact"], arguments].concat())
}

/// The rows of a reference table of a case, as numbers behind the name.
fn rows(text: &str, case: &str) -> Vec<Vec<f64>> {
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let of_case = text.lines().map(cells).filter(|row| row[0] == case);
    of_case.map(|row| row[1..].iter().map(|cell| cell.parse().expect("a number")).collect()).collect()
}

/// Pressure ratio, settlement ratio and degree of the one row that is printed.
fn printed(told: &Told) -> [f64; 3] {
    assert_eq!(told.code, 0, "{}", told.err);
    let line = told.out.lines().nth(1).expect("a row");
    // A degree that means nothing is empty.
    let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    [numbers[2], numbers[3], numbers[4]]
}

#[test]
fn layered_columns_match_forty_digits() {
    let table = include_str!("../../../crates/exact/tests/reference/layered.csv");
    let cases = [
        ("clay-over-sand", "[{thickness=0.5},{thickness=0.5,hydraulic_conductivity=1e-6}]"),
        ("sand-over-clay", "[{thickness=0.5,hydraulic_conductivity=1e-6},{thickness=0.5}]"),
        (
            "sandwich",
            "[{thickness=0.3,youngs_modulus=1e7},{thickness=0.4,youngs_modulus=5e5,porosity=0.5,\
             hydraulic_conductivity=1e-7},{thickness=0.3}]",
        ),
    ];
    for (case, soils) in cases {
        let rows = rows(table, case);
        assert_eq!(rows.len(), 24);
        // The first and the last height at each time are enough for the program: the library's test has all.
        for row in rows.iter().step_by(5) {
            let (time_factor, zeta) = (row[0].to_string(), (1.0 - row[1]).to_string());
            let set = format!("column.soils={soils}");
            let told = exact(&["layered", "--set", &set, "--time-factor", &time_factor, "--zeta", &zeta]);
            let [pressure, _, degree] = printed(&told);
            assert!((pressure - row[2]).abs() < 1e-12, "{case} {row:?}: {pressure}");
            assert!((degree - row[3]).abs() < 1e-12, "{case} {row:?}: {degree}");
        }
    }
}

#[test]
fn yield_fronts_match_thirty_digits() {
    let table = include_str!("../../../crates/exact/tests/reference/yield_front.csv");
    // E₁, E₂, k, n, σ'_0, σ'_pc.
    let cases = [
        ("stiff-until-yield", [1.2e6, 1.2e7, 1e-7, 0.5, 2e4, 6e4]),
        ("late-yield", [1.2e6, 6e6, 1e-8, 0.4, 0.0, 9e4]),
        ("early-yield", [2e6, 1e7, 1e-8, 0.4, 3e4, 3.1e4]),
    ];
    for (case, [virgin, reload, conductivity, porosity, initial, preconsolidation]) in cases {
        for row in rows(table, case).iter().step_by(4) {
            // With ν = 0 the oedometric modulus is Young's.
            let time_factor = (row[0] * conductivity * virgin / 9810.0).to_string();
            let zeta = row[1].to_string();
            let sets = [
                "material.law=preconsolidated".to_owned(),
                "material.poissons_ratio=0".to_owned(),
                "column.load=1e5".to_owned(),
                format!("material.youngs_modulus={virgin}"),
                format!("material.reload_modulus={reload}"),
                format!("material.hydraulic_conductivity={conductivity}"),
                format!("material.porosity={porosity}"),
                format!("column.initial_stress={initial}"),
                format!("material.preconsolidation={preconsolidation}"),
            ];
            let mut arguments = vec!["yield-front", "--time-factor", &time_factor, "--zeta", &zeta];
            arguments.extend(sets.iter().flat_map(|set| ["--set", set.as_str()]));
            let [pressure, ..] = printed(&exact(&arguments));
            assert!((pressure - row[2] / 1e5).abs() < 1e-12, "{case} {row:?}: {pressure}");
        }
    }
}

#[test]
fn a_sealed_element_carries_its_load_for_ever() {
    let told = exact(&["sealed-element", "--set", "material.water_bulk_modulus=1e6", "--time-factor", "0,3"]);
    let [pressure, settlement, _] = printed(&told);
    assert!((pressure - 1.0 / (1.0 + 0.3 * 1.2e6 / 1e6)).abs() < 1e-15);
    assert!((settlement - (1.0 - pressure) / 1.2e6).abs() < 1e-20);
    let values: Vec<&str> =
        told.out.lines().skip(1).map(|line| line.split(',').nth(2).expect("p/q")).collect();
    assert!(values.iter().all(|value| *value == values[0]), "{values:?}");
}

fn refused(arguments: &[&str], part: &str) {
    let told = exact(arguments);
    assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
    assert!(told.err.contains(part), "{}", told.err);
}

#[test]
fn impossible_problems_are_refused_in_sentences() {
    refused(&["layered", "--set", "column.soils=[{thickness=0.5},{thickness=0.4}]"], "they must fill it");
    refused(&["layered", "--set", "column.soils=[{porosity=0.4}]"], "`thickness` is missing in soils");
    refused(&["layered", "--set", "column.soils=[{thickness=1.0,porosity=1.4}]"], "between 0 and 1");
    refused(&["layered", "--set", "material.poissons_ration=0.2"], "poissons_ratio");
    refused(&["layered", "--set", "material.preconsolidation=1e4"], "has no `preconsolidation`");
    let front =
        ["yield-front", "--set", "material.preconsolidation=0.5", "--set", "material.reload_modulus=1e5"];
    refused(&front, "below the modulus of first loading");
    let never =
        ["yield-front", "--set", "material.preconsolidation=2", "--set", "material.reload_modulus=2e6"];
    refused(&never, "no yield front");
    refused(&["sealed-element", "--x", "0.5"], "depends only on depth");
}

#[test]
fn every_scene_has_an_exact_solution_to_print() {
    for scene in oedometer::scenes::NAMES {
        let told = exact(&[scene]);
        assert_eq!(told.code, 0, "{scene}: {}", told.err);
        assert!(told.out.lines().count() > 1, "{scene}: {}", told.out);
    }
}

#[test]
fn a_front_that_feels_its_base_is_refused() {
    let told = exact(&["yield-front", "--time-factor", "0.001,0.5"]);
    assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
    assert!(told.err.contains("T_v = 0.5") && told.err.contains("half-space"), "{}", told.err);
    let told = exact(&["yield-front"]);
    let times = told.out.lines().skip(1).step_by(11).map(|line| line.split(',').next().unwrap_or_default());
    assert_eq!(times.collect::<Vec<_>>(), ["0.0005", "0.001", "0.002", "0.004"]);
    assert!(!exact(&["terzaghi"]).err.contains("warning"));
}

#[test]
fn a_degree_is_empty_where_it_means_nothing() {
    let empty = [
        "sealed-element",
        "at-rest",
        "standing-wave",
        "dynamic-column",
        "dynamic-single-mode",
        "seabed",
        "injection",
        "manufactured-box",
    ];
    for scene in oedometer::scenes::NAMES.into_iter().chain(["seabed", "injection"]) {
        let told = exact(&[scene, "--format", "csv"]);
        let place = told
            .out
            .lines()
            .next()
            .and_then(|line| line.split(',').position(|name| name.starts_with("degree")));
        let Some(place) = place else { continue };
        let cell = told.out.lines().nth(1).and_then(|line| line.split(',').nth(place)).unwrap_or("none");
        let is_motion = scene.starts_with("manufactured");
        assert_eq!(cell.is_empty(), empty.contains(&scene) || is_motion, "{scene}: {}", told.out);
        let json = exact(&[scene, "--format", "json"]).out;
        assert_eq!(json.contains("\"degree_of_consolidation\": null"), cell.is_empty(), "{scene}");
    }
}

#[test]
fn dimensionless_problems_and_mandels_grains_are_taken() {
    let told = exact(&[
        "terzaghi",
        "--set",
        "material.youngs_modulus=7.2",
        "--set",
        "material.water_bulk_modulus=8",
    ]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("warning: no soil has a Young's modulus of 7.2 Pa"), "{}", told.err);
    assert!(told.err.contains("in a dimensionless problem it is right"), "{}", told.err);
    // Undrained, the same everywhere: p = F/a · 3α/(2((3K_u + G)/M)).
    let set = [
        "material.biot_coefficient=0.6",
        "material.grain_bulk_modulus=8e6",
        "material.water_bulk_modulus=3e6",
    ];
    let mut arguments = vec!["mandel", "--time-factor", "0", "--x", "0.5"];
    arguments.extend(set.iter().flat_map(|set| ["--set", set]));
    let told = exact(&arguments);
    let (bulk, shear) = (1e6 / 1.5, 4e5);
    let storage = 0.3 / 3e6 + 0.3 / 8e6;
    let wanted = 1.5 * 0.6 / (3.0 * (bulk * storage + 0.36) + shear * storage);
    let found: f64 =
        told.out.lines().nth(1).and_then(|line| line.split(',').nth(2)?.parse().ok()).expect("p");
    assert!((found / wanted - 1.0).abs() < 1e-14, "{found} {wanted}");
    refused(&["mandel", "--set", "material.grain_bulk_modulus=5e5"], "grains are stiffer than the skeleton");
    let soft =
        ["biot-column", "--set", "material.biot_coefficient=0.8", "--set", "material.grain_bulk_modulus=5e5"];
    refused(&soft, "grains are stiffer than the skeleton");
}
