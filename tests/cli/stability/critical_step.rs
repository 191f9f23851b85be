//! `stability` through the door: predicted and observed critical steps agree, for every method, and
//! have the values that an independent implementation measured (numerics, section 2).

use std::path::Path;

/// Rows of the CSV: predicted, observed, `h/c`, share, status.
fn stability(arguments: &[&str]) -> (i32, Vec<Vec<String>>) {
    let command = ["stability", "terzaghi", "--format", "csv", "--time-factor", "1e-3"];
    let told = crate::program::call(Path::new("."), &[&command, arguments].concat());
    let rows = told.out.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect();
    (told.code, rows)
}

fn number(row: &[String], column: usize) -> f64 {
    row[column].parse().expect("a number")
}

#[test]
fn every_method_agrees_with_its_prediction_within_two_percent() {
    let methods = "MPM,GIMP,GIMP-SRI,GIMP-SRI-patch,GC-SRI-patch,uGC-SRI-patch,TL-GC-SRI-patch";
    for settings in ["integrator.drag=explicit", "integrator.drag=implicit", "integrator.drag=centred"] {
        let (code, rows) = stability(&["--method", methods, "--cells", "6", "--set", settings]);
        assert_eq!(code, 0, "{settings}");
        assert_eq!(rows.len(), 14);
        for row in rows {
            assert!((number(&row, 4) / number(&row, 3) - 1.0).abs() < 0.02, "{row:?}");
            let expected = if row[8] == "0.97" { "ok" } else { "unstable" };
            assert_eq!(row[9], expected, "{row:?}");
        }
    }
}

#[test]
fn the_limits_are_those_that_were_measured() {
    // Nearly undamped, nc = 8: over h/c at 1, 2 and 4 points per cell, with and without mapping back.
    for (mapping_back, expected) in [("true", [2.04, 1.74, 1.66]), ("false", [0.71, 0.76, 0.78])] {
        let mapping = format!("integrator.mapping_back={mapping_back}");
        let (code, rows) = stability(&[
            "--method",
            "MPM",
            "--points-per-cell",
            "1,2,4",
            "--set",
            "material.hydraulic_conductivity=9.0",
            "--set",
            &mapping,
        ]);
        assert_eq!(code, 0, "no false alarm where nothing damps");
        for (row, expected) in rows.iter().step_by(2).zip(expected) {
            assert!((number(row, 3) / number(row, 5) / expected - 1.0).abs() < 0.02, "{row:?}");
        }
    }
    // Implicit drag takes its limit away; explicit drag rules from k = 1e-6 down.
    for (conductivity, drag, limit) in [
        ("1e-4", "implicit", 1.8 * 6.145e-5),
        ("1e-10", "implicit", 1.8 * 6.145e-5),
        ("1e-6", "explicit", 5.9e-7),
        ("1e-10", "explicit", 5.9e-11),
    ] {
        let (code, rows) = stability(&[
            "--method",
            "MPM",
            "--points-per-cell",
            "4",
            "--set",
            &format!("material.hydraulic_conductivity={conductivity}"),
            "--set",
            &format!("integrator.drag={drag}"),
        ]);
        assert_eq!(code, 0);
        assert!((number(&rows[0], 3) / limit - 1.0).abs() < 0.02, "{conductivity} {drag}: {:?}", rows[0]);
    }
}

#[test]
fn points_on_faces_with_a_constant_in_each_cell_have_no_stable_step_and_that_is_said() {
    let (code, rows) = stability(&[
        "--method",
        "GIMP-SRI",
        "--set",
        "points.offset=-0.5",
        "--set",
        "integrator.drag=implicit",
    ]);
    assert_eq!(code, 1, "no agreement where every step leaves");
    assert!(rows.iter().all(|row| row[9] == "unstable"), "{rows:?}");
}
