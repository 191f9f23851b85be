//! Scenes of several soils and of a soil that remembers, by the program.

use crate::program::{Told, call};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SOFT_OVER_STIFF: &str = "column.soils=[{thickness=0.5,youngs_modulus=3e7},{thickness=0.5}]";

fn solve(arguments: &[&str]) -> Told {
    call(Path::new("."), &[&["solve"], arguments, &["--integrator", "implicit", "--format", "csv"]].concat())
}

/// Error of the pressures of the points.
fn error_of(told: &Told) -> f64 {
    assert_eq!(told.code, 0, "{}", told.err);
    let line = told.out.lines().find(|line| line.contains("pressure,points,l2")).expect("a row");
    line.rsplit(',').next().expect("a value").parse().expect("a number")
}

#[test]
fn patches_that_keep_to_their_soil_are_of_second_order_where_others_are_of_first() {
    let orders = ["GIMP-SRI-patch", "GIMP-SRI-patch-soils"].map(|method| {
        let [coarse, fine] = ["21", "63"].map(|cells| {
            let case = ["layered", "--method", method, "--cells", cells, "--time-factor", "0.1"];
            error_of(&solve(&[&case[..], &["--time-step", "growth=0.02", "--set", SOFT_OVER_STIFF]].concat()))
        });
        (coarse / fine).ln() / 3.0_f64.ln()
    });
    assert!((orders[0] - 1.0).abs() < 0.1 && orders[1] > 1.9, "{orders:?}");
}

#[test]
fn a_yield_front_and_a_sealed_element_match_their_solutions() {
    let front = ["yield-front", "--method", "GIMP-SRI-patch", "--cells", "160", "--time-factor", "0.002"];
    assert!(error_of(&solve(&front)) < 1e-3);
    let sealed = ["sealed-element", "--method", "GIMP-SRI", "--cells", "1", "--time-factor", "1"];
    let stiff = [&sealed[..], &["--set", "material.water_bulk_modulus=1e6"]].concat();
    assert!(error_of(&solve(&stiff)) < 1e-6);
}

#[test]
fn a_sealed_element_scores_another_programs_one_number() {
    let folder = TempDir::new().expect("a folder");
    // p = 1/(1 + 0.3 · 1.2) of the load, and OpenSees' 10.0 for 7.88 in its proportion.
    for (pressure, code) in [(1.0 / 1.36, 0), (10.0 / 7.88 / 1.36, 1)] {
        let strain = -(1.0 - 1.0 / 1.36) / 1.2e6;
        let row = |y: f64| format!("1,{y},{pressure},{}\n", strain * y);
        let text = format!("t,y,p,u_y\n{}{}", row(0.25), row(0.75));
        fs::write(folder.path().join("result.csv"), text).expect("a file");
        let set = ["--set", "material.water_bulk_modulus=1e6", "--cells", "1", "--below", "1e-6"];
        let told =
            call(folder.path(), &[&["score", "result.csv", "--scene", "sealed-element"], &set[..]].concat());
        assert_eq!(told.code, code, "{pressure}: {} {}", told.out, told.err);
    }
}

#[test]
fn impossible_soils_are_refused_at_their_place() {
    let layers = |list: &str| format!("column.soils={list}");
    let thin = layers("[{thickness=0.5},{thickness=0.4}]");
    let dense = layers("[{thickness=0.5},{thickness=0.5,porosity=1.4}]");
    let two = layers("[{thickness=0.5},{thickness=0.5}]");
    for (scene, set, more, part) in [
        ("layered", thin.as_str(), "0.1", "make the last layer 0.5 m thick"),
        ("layered", &dense, "0.1", "it is layer 2 from the base"),
        ("terzaghi", &two, "0.1", "has no `soils`"),
        ("yield-front", "material.reload_modulus=1e5", "0.001", "below the modulus of first loading"),
        ("yield-front", "material.preconsolidation=2", "0.001", "no yield front"),
        ("yield-front", "column.initial_stress=0.1", "1", "ask for earlier time factors"),
        ("layered", "material.preconsolidation=2", "0.1", "has no `preconsolidation`"),
        ("terzaghi", "column.initial_stress=2", "0.1", "has no `initial_stress`"),
        ("terzaghi", "material.law=preconsolidated", "0.1", "belongs to no other problem"),
    ] {
        let told = solve(&[scene, "--cells", "10", "--set", set, "--time-factor", more]);
        assert_eq!((told.code, told.out.as_str()), (2, ""), "{set}: {}", told.err);
        assert!(told.err.contains(part), "{set}: {}", told.err);
    }
}

#[test]
fn a_footing_prints_its_load_and_locks_with_full_integration() {
    let loads = |method: &str| -> Vec<f64> {
        let told = call(
            Path::new("."),
            &["solve", "footing", "--cells", "4", "--method", method, "--format", "csv"],
        );
        assert_eq!(told.code, 0, "{}", told.err);
        let of_load = told.out.lines().filter(|line| line.contains(",load_factor,surface,value,"));
        of_load.map(|line| line.rsplit(',').next().expect("a value").parse().expect("a number")).collect()
    };
    let exact = 2.0 + std::f64::consts::PI;
    let [_, before, after] = loads("GIMP-SRI")[..] else { panic!("three outputs") };
    assert!((after / exact - 1.0).abs() < 0.1 && (after - before).abs() < 0.02, "{before} {after}");
    let [_, before, after] = loads("GIMP")[..] else { panic!("three outputs") };
    assert!(after > 1.15 * exact && after > before, "{before} {after}");
    // Its fields have no exact solution: there is no mapping to score them by, and no file is read.
    let folder = TempDir::new().expect("a folder");
    let solved = call(folder.path(), &["solve", "footing", "--cells", "4", "--fields", "f"]);
    assert_eq!((solved.code, folder.path().join("f/mapping.toml").exists()), (0, false), "{}", solved.err);
    let scored = call(folder.path(), &["score", "f/fields.pvd", "--scene", "footing"]);
    assert!(scored.code == 2 && scored.err.contains("only the collapse load"), "{}", scored.err);
}

#[test]
fn impossible_footings_are_refused_at_their_place() {
    for (scene, more, part) in [
        ("footing", &["--cells", "5"][..], "use an even number"),
        ("footing", &["--cells", "4", "--set", "layer.plate_width=5"], "the layer ends under the footing"),
        ("footing", &["--cells", "4", "--set", "layer.load=5"], "has no `load`"),
        ("footing", &["--cells", "4", "--set", "points.offset=0.1"], "has no [points]"),
        ("footing", &["--cells", "4", "--set", "material.law=linear"], "is `von-mises`"),
        ("footing", &["--cells", "4", "--integrator", "explicit"], "the integrator is `implicit`"),
        ("footing", &["--cells", "4", "--method", "PPP"], "a pressure projection"),
        ("footing", &["--cells", "4", "--method", "CE-SRI-patch"], "which total stress needs"),
        ("cosine-layer", &["--cells", "4", "--set", "layer.plate=smooth"], "has no `plate`"),
        (
            "terzaghi",
            &["--cells", "4", "--set", "material.undrained_strength=1e4"],
            "has no `undrained_strength`",
        ),
    ] {
        let told = call(Path::new("."), &[&["solve", scene, "--format", "csv"], more].concat());
        assert_eq!((told.code, told.out.as_str()), (2, ""), "{more:?}: {}", told.err);
        assert!(told.err.contains(part), "{more:?}: {}", told.err);
    }
}
