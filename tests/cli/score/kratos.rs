//! Kratos 10.4.4: finite elements, poromechanics and material points, written by the program.

use crate::program::call;
use crate::score::real_files::{PRESSURE, TEN, are, score, values};
use crate::score::written_files::{self, foreign};

#[test]
fn kratos_has_its_steps_in_names_or_a_series_and_suction_positive() {
    let step = ["--preset", "kratos", "--set-time-step", "0.08175"];
    let found = values(&score(&[&["kratos-vtk/*.vtk"], &step[..]].concat()), PRESSURE);
    assert!(are(&found, &TEN), "{found:?}");
    let told =
        score(&["kratos-vtu/PorousDomain.porous_computational_model_part.vtm.series", "--preset", "kratos"]);
    let found = values(&told, PRESSURE);
    assert!(found.len() == 4 && are(&found[..1], &["1.67e-2"]), "ten times the step: {found:?}");
    for said in ["16 of its 20 files are missing", "left out the block", "10 cells"] {
        assert!(told.err.contains(said), "{said}: {}", told.err);
    }
    let told = score(&["kratos-vtk/porous_computational_model_part_0_50.vtk", "--preset", "kratos"]);
    assert!(told.code == 2 && told.err.contains("--set-time-step"), "{}", told.err);
}

#[test]
fn kratos_poromechanics_counts_compression_positive() {
    // Of four-node elements with backward Euler steps; the other application's preset knows another name.
    let of = |preset: &str| {
        let more = ["--preset", preset, "--set-time-step", "0.08175", "--below", "5e-2"];
        written_files::score(&foreign("kratos-poro"), &["*.vtk"], &more)
    };
    let told = of("kratos-poro");
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    for quantity in ["pressure", "displacement", "settlement"] {
        assert_eq!(
            told.out.lines().filter(|line| line.split_whitespace().nth(1) == Some(quantity)).count(),
            4
        );
    }
    let told = of("kratos");
    assert!(told.code == 1 && told.err.contains("there is no `p`"), "{}{}", told.out, told.err);
    assert!(told.err.contains("--preset kratos-poro"), "{}", told.err);
}

/// A drained column of 1000 kg/m³ under its weight: the stress at the end of a consolidation under the same buoyant weight.
#[test]
fn kratos_mpm_has_its_arrays_on_vertices_in_text_and_packed() {
    for file in ["column_0_2.vtk", "binary_0_2.vtk"] {
        let told = call(
            &foreign("kratos-mpm"),
            &[
                "score",
                file,
                "--scene",
                "terzaghi",
                "--preset",
                "kratos-mpm",
                "--set-time-step",
                "1e4",
                "--set",
                "column.load=1e-3",
                "--set",
                "column.self_weight=true",
                "--set",
                "material.grain_density=2428.5714285714284",
                "--format",
                "csv",
            ],
        );
        assert_eq!(told.code, 0, "{file}: {}", told.err);
        // A stress that is constant in each of five cells is a tenth off a linear one. The scene's displacement is that
        // of the load alone.
        let row = told.out.lines().find(|line| line.contains("effective_stress") && line.contains(",l2,"));
        let row = row.unwrap_or_else(|| panic!("{file}: {}{}", told.out, told.err));
        let error: f64 = row.rsplit(',').next().expect("a value").parse().expect("a number");
        assert!(error < 0.11, "{file}: {row}");
        assert!(told.err.contains("u_y = MP_DISPLACEMENT[1] on cells"), "{}", told.err);
        assert!(!told.out.contains("pressure"), "it has none");
    }
}
