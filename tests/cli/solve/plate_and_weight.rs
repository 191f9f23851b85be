//! Mandel's slab, own weight and rest, as a user asks for them.

use crate::program::call;
use oedometer::{Norm, Quantity, Record, RunOptions, Sample, Study, StudySource, Tier, run_study};
use std::path::Path;

/// Exit code, standard output and standard error.
fn told(arguments: &[&str]) -> (i32, String, String) {
    let told = call(Path::new("."), arguments);
    (told.code, told.out, told.err)
}

/// The value of the row of a CSV that begins with a text.
fn value(csv: &str, row: &str) -> f64 {
    let found: Vec<&str> = csv.lines().filter_map(|line| line.strip_prefix(row)).collect();
    assert_eq!(found.len(), 1, "one row `{row}` in\n{csv}");
    found[0].parse().expect("a number")
}

const STEPS: [&str; 6] = ["--integrator", "implicit", "--time-step", "growth=0.02", "--format", "csv"];

#[test]
fn mandels_slab_is_solved_to_what_is_known_of_ten_cells() {
    let slab = ["solve", "mandel", "--method", "GIMP-SRI", "--cells", "10", "--time-factor", "0.05,0.1"];
    let (code, out, err) = told(&[&slab[..], &STEPS].concat());
    assert_eq!(code, 0, "{err}");
    // A semi-discrete bilinear element with one point for the pressure, exact in time: 4.4e-3, 2.7e-3, 1.3e-3.
    for (row, known) in [
        ("0.05,pressure,centres,l2,mandel,", 4.4e-3),
        ("0.1,pressure,centres,l2,mandel,", 2.7e-3),
        ("0.05,settlement,surface,relative,mandel,", -1.27e-3),
    ] {
        assert!((value(&out, row) / known - 1.0).abs() < 0.02, "{row}{}", value(&out, row));
    }
}

#[test]
fn what_a_slab_or_a_weight_cannot_have_is_refused_in_sentences() {
    for (arguments, sentence) in [
        (&["mandel", "--set", "column.self_weight=true"][..], "the problem `mandel` has no `self_weight`"),
        (&["single-mode", "--set", "column.self_weight=true"], "has no `self_weight`"),
        (&["mandel", "--set", "column.dimensions=1"], "`mandel` has two dimensions"),
        (&["mandel", "--set", "layer.length=1.0"], "the problem `mandel` has no [layer]"),
    ] {
        let (code, _, err) = told(&[&["solve"], arguments, &["--cells", "10"]].concat());
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(err.contains(sentence), "{arguments:?}: {err}");
    }
}

#[test]
fn a_weight_changes_the_stress_and_neither_excess_pressure_nor_settlement() {
    let column = ["solve", "terzaghi", "--method", "GIMP-SRI-patch", "--cells", "8", "--time-factor", "0.1"];
    let load = ["--set", "column.load=1e3", "--set"];
    let of = |weight: &str| {
        let (code, out, err) = told(&[&column[..], &load, &[weight], &STEPS].concat());
        assert_eq!(code, 0, "{err}");
        out
    };
    let (light, heavy) = (of("column.self_weight=false"), of("column.self_weight=true"));
    for row in ["0.1,pressure,points,l2,terzaghi,", "0.1,settlement,surface,relative,terzaghi,"] {
        assert!((value(&heavy, row) / value(&light, row) - 1.0).abs() < 1e-6, "{row}");
    }
    // The same absolute error over a stress of the weight.
    let row = "0.1,effective_stress,points,l2,terzaghi,";
    assert!(value(&heavy, row) < 0.2 * value(&light, row));
}

/// A label without what it says of a weight.
fn weightless(label: &str) -> String {
    [", own weight", "own weight, ", " (own weight)"]
        .iter()
        .fold(label.to_owned(), |rest, word| rest.replace(word, ""))
}

/// Errors of the pressure at the points of the cases of a shipped study, by their labels without the weight.
fn errors_of(study: &str) -> Vec<(String, f64)> {
    let source = StudySource { name: "weight.toml".to_owned(), text: study.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    let records = run_study(&study, &RunOptions::whole(Tier::Ci, 2), None, &|_| {}).records;
    assert!(!records.is_empty());
    let of_pressure = |record: &Record| {
        let found = record.errors.iter().rfind(|row| {
            row.quantity == Quantity::Pressure && row.sample == Sample::Points && row.norm == Norm::L2
        });
        found.map_or(f64::NAN, |row| row.value)
    };
    records.iter().map(|record| (weightless(&record.case.label()), of_pressure(record))).collect()
}

#[test]
fn with_every_other_option_a_weight_leaves_the_excess_pressure_as_it_is() {
    let mut compared = 0;
    for (heavy, within) in [
        (include_str!("../../../studies/self-weight-options.toml"), 0.02),
        (include_str!("../../../studies/self-weight-plane.toml"), 0.01),
    ] {
        // Steps of waves are too many without optimisation; the study has them.
        let heavy = heavy.split("[[sweep]]                    # with steps of waves").next().unwrap_or(heavy);
        let light = errors_of(&heavy.replace("self_weight = true", "self_weight = false"));
        for ((label, heavy), (same, light)) in errors_of(heavy).into_iter().zip(light) {
            assert_eq!(label, same);
            // Points off their lattice, and those of splines, integrate no weight exactly.
            if ["jittered", "bspline"].iter().any(|inexact| label.contains(inexact)) {
                assert!(heavy > 0.9 * light, "{label}: {heavy} for {light}");
                continue;
            }
            assert!((heavy / light - 1.0).abs() < within, "{label}: {heavy} for {light}");
            compared += 1;
        }
    }
    assert!(compared > 24, "{compared}");
}

#[test]
fn a_column_at_rest_stays_there_and_says_how_still() {
    let rest = ["solve", "at-rest", "--method", "GIMP-SRI-patch", "--cells", "4", "--time-factor", "1e-4"];
    let more = ["--set", "integrator.drag=implicit", "--format", "json"];
    let (code, out, err) = told(&[&rest[..], &more].concat());
    assert_eq!(code, 0, "{err}");
    let json: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    let spurious = json["balance"][0]["spurious_velocity"].as_f64().expect("a velocity");
    assert!(spurious > 0.0 && spurious < 1e-11, "{spurious}");
}
