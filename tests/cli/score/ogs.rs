//! `OpenGeoSys`: files written by the program.

use crate::program::call;
use crate::score::real_files::{PRESSURE, TEN, are, files, score, values};
use std::fs;
use tempfile::TempDir;

#[test]
fn open_geo_sys_is_what_the_same_elements_give_elsewhere() {
    for file in ["ogs/col.pvd", "ogs-xdmf/col_bulk.xdmf"] {
        let told = score(&[file, "--preset", "ogs"]);
        let found = values(&told, PRESSURE);
        assert!(are(&found, &TEN), "{file}: {found:?}");
        let settled = values(&told, ",settlement,");
        assert!(are(&settled[..2], &["1.7e-3", "8.5e-4"]) && are(&settled[4..], &["1.5e-4"]), "{settled:?}");
        assert!(told.err.contains("p = pressure on points") && told.err.contains("10 cells"), "{}", told.err);
        assert!(told.err.contains("the state at t = 0 is left out"), "{}", told.err);
        assert!(!told.err.contains("warning"), "{}", told.err);
    }
    let stress = values(&score(&["ogs/col.pvd", "--preset", "ogs"]), ",effective_stress,nodes,l2,");
    assert!(stress.iter().all(|error| *error < 0.03), "{stress:?}");
}

#[test]
fn two_meshes_of_one_program_make_a_series_without_telling_their_cells() {
    let told = call(
        &files(),
        &[
            "score",
            "ogs/col.pvd",
            "ogs-20/col.pvd",
            "--preset",
            "ogs",
            "--scene",
            "terzaghi",
            "--reference",
            "terzaghi",
        ],
    );
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.out.contains("10 cells"), "{}", told.out);
    assert!(told.out.contains("2 levels with the order 0.40 between them"), "{}", told.out);
    let twenty = values(&score(&["ogs-20/col.pvd", "--preset", "ogs"]), PRESSURE);
    assert!(are(&twenty[4..], &["2.29e-3"]), "{twenty:?}");
    // From an error above the exact field to one below it: three meshes tell no growth from a limit.
    let three = ["ogs/col.pvd", "ogs-20/col.pvd", "ogs-40/col.pvd", "--preset", "ogs", "--scene", "terzaghi"];
    let told = call(&files(), &[&["score"], &three[..], &["--reference", "terzaghi"]].concat());
    assert!(told.out.contains("towards a limit") && !told.out.contains("divergent"), "{}", told.out);
    // Forty elements, as the same elements in scikit-fem.
    let told = score(&["ogs-40/col.pvd", "--preset", "ogs"]);
    let forty = values(&told, PRESSURE);
    assert!(are(&forty, &["1.76e-3", "1.14e-3", "7.28e-4", "1.49e-3", "2.85e-3"]), "{forty:?}");
    let settled = values(&told, ",settlement,");
    assert!(are(&settled[..2], &["-2.2e-3", "-1.1e-3"]) && are(&settled[4..], &["-2.0e-4"]), "{settled:?}");
}

#[test]
fn zeros_at_the_middle_of_sides_are_warned_of_and_fail_a_gate() {
    for (file, preset) in [("ogs/col.pvd", "meshio"), ("ogs-xdmf/col.h5", "ogs")] {
        let told = score(&[file, "--preset", preset]);
        let found = values(&told, PRESSURE).into_iter().chain(values(&told, ",pressure,points,l2,"));
        assert!((found.last().expect("a row") - 7.65e-1).abs() < 5e-4);
        assert!(
            told.err.contains("warning: zeros-inside") && told.err.contains("corners = true"),
            "{}",
            told.err
        );
        assert_eq!(score(&[file, "--preset", preset, "--strict"]).code, 1);
    }
    let folder = TempDir::new().expect("a folder");
    let map = folder.path().join("map.toml");
    fs::write(&map, "columns = { p = \"pressure_interpolated\" }\n").expect("a file");
    let told = score(&["ogs/col.pvd", "--preset", "meshio", "--mapping", map.to_str().expect("a path")]);
    let found = values(&told, PRESSURE);
    assert!(are(&found[..1], &["2.39e-3"]) && are(&found[4..], &["1.88e-3"]), "all nodes: {found:?}");
    assert!(!told.err.contains("zeros-inside"), "{}", told.err);
}
