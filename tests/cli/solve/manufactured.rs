//! The manufactured scenes as a user asks for them.

use crate::program::call;
use std::path::Path;

/// Exit code, standard output and standard error.
fn told(arguments: &[&str]) -> (i32, String, String) {
    let told = call(Path::new("."), arguments);
    (told.code, told.out, told.err)
}

#[test]
fn the_fields_of_a_motion_are_printed_along_its_wall_and_anywhere() {
    let (code, out, err) = told(&[
        "exact",
        "manufactured-box",
        "--time-factor",
        "0.25",
        "--zeta",
        "0.5,0.75",
        "--x",
        "0.5,0.25",
    ]);
    assert_eq!(code, 0, "{err}");
    let header = out.lines().next().unwrap_or_default();
    assert!(header.ends_with("x,horizontal_displacement_ratio,vertical_displacement_ratio,effective_stress_ratio_xx,effective_stress_ratio_yy,effective_stress_ratio_xy"), "{header}");
    let rows: Vec<Vec<f64>> = out
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|number| number.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    assert_eq!(rows.len(), 4);
    // In the middle at ωt = π/4: u_x = A/(2π) = u_y, and no pressure.
    let middle = &rows[0];
    assert!((middle[6] - 0.125 / std::f64::consts::PI).abs() < 1e-15, "{middle:?}");
    assert!(middle[2].abs() < 1e-15);
    // At X = Y = 1/4 the pressure is P_0/2, and F = 1 + A g/√2 both ways.
    let corner = &rows[3];
    assert!((corner[2] - 0.5).abs() < 1e-15, "{corner:?}");
    let stress = (0.4 * 4.0) * (1.0 + 0.125 * 0.5_f64.sqrt()).ln() / 0.2;
    assert!((corner[8] - stress).abs() < 1e-14 && corner[10] == 0.0, "{corner:?}");
    let (code, out, err) = told(&["exact", "manufactured-vortex", "--time-factor", "0.5", "--zeta", "1"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!(out.lines().count(), 2);
}

#[test]
fn what_a_motion_cannot_have_is_refused_in_sentences() {
    for (arguments, sentence) in [
        (
            &["manufactured-box", "--set", "column.load=1.0"][..],
            "the problem `manufactured-box` has no [column]",
        ),
        (
            &["manufactured-box", "--set", "points.offset=0.1"],
            "the problem `manufactured-box` has no [points]",
        ),
        (&["manufactured-box", "--set", "manufactured.amplitude=1.0"], "only \"manufactured-vortex\" has it"),
        (&["manufactured-vortex", "--set", "manufactured.amplitude_x=0.1"], "has no `amplitude_x`"),
        (&["manufactured-box", "--set", "manufactured.amplitude_x=1.2"], "from 1 on it folds the body"),
        (&["manufactured-box", "--set", "manufactured.amplitude_x=0.7"], "the motion would close the pores"),
        (&["manufactured-shear", "--set", "material.law=log-linear"], "not known in closed form"),
        (&["xie-leo", "--set", "material.law=neo-hookean"], "it belongs to the manufactured solutions"),
        (&["xie-leo", "--set", "manufactured.pressure=1.0"], "has no [manufactured]"),
        (
            &["manufactured-box", "--method", "TL-GIMP-SRI-patch", "--set", "integrator.affine=true"],
            "APIC needs a single set of points",
        ),
        (
            &["xie-leo", "--integrator", "explicit", "--set", "integrator.affine=true"],
            "the critical step with APIC or stress slopes is not predicted",
        ),
        (
            &["manufactured-box", "--method", "CPDI-SRI-patch", "--set", "integrator.stress_slopes=true"],
            "stress slopes need GIMP domains",
        ),
        (
            &["xie-leo", "--integrator", "explicit", "--set", "integrator.stress_slopes=true"],
            "the critical step with APIC or stress slopes is not predicted",
        ),
        (&["manufactured-box", "--integrator", "semi-implicit"], "at different times"),
        (&["manufactured-box", "--set", "material.conductivity_mean=chord"], "the chord mean is for a flux"),
    ] {
        let (code, _, err) = told(&[&["solve"], arguments, &["--cells", "4"]].concat());
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(err.contains(sentence), "{arguments:?}: {err}");
    }
    let (code, _, err) = told(&["stability", "manufactured-box", "--cells", "4"]);
    assert_eq!(code, 2);
    assert!(err.contains("predicted, not observed"), "{err}");
}

#[test]
fn a_sheared_square_and_a_vortex_run_by_their_names_and_keys() {
    for (scene, key) in [
        ("manufactured-shear", "manufactured.amplitude_y=-0.1"),
        ("manufactured-vortex", "manufactured.amplitude=0.5"),
    ] {
        let (code, out, err) = told(&[
            "solve",
            scene,
            "--method",
            "GIMP-SRI-patch",
            "--cells",
            "8",
            "--time-factor",
            "0.1",
            "--set",
            key,
            "--format",
            "csv",
        ]);
        assert_eq!(code, 0, "{err}");
        let row = format!("0.1,displacement,points,l2,{scene},");
        let value = out.lines().find_map(|line| line.strip_prefix(&row)).expect("a row");
        let error: f64 = value.parse().expect("a number");
        assert!(error > 0.0 && error < 0.5, "{scene}: {error}");
    }
}
