//! What is said of files of any program: what is missing, what cannot be scored, grids that fit no body.

use crate::program::call;
use crate::score::real_files::{PRESSURE, TEN, are, score, values};
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

/// All good results of `docs/other-solvers.md`, as they are scored there.
#[test]
fn no_good_result_has_a_diagnosis() {
    for arguments in [
        &["ogs/col.pvd", "--preset", "ogs"][..],
        &["ogs-20/col.pvd", "--preset", "ogs"],
        &["ogs-40/col.pvd", "--preset", "ogs"],
        &["ogs-xdmf/col_bulk.xdmf", "--preset", "ogs"],
        &["kratos-vtk/*.vtk", "--preset", "kratos", "--set-time-step", "0.08175"],
        &["kratos-vtu/PorousDomain.porous_computational_model_part.vtm.series", "--preset", "kratos"],
        &["porepy/col.pvd", "--preset", "porepy"],
        &["geotaichi/particles/*.npz", "--preset", "geotaichi", "--set", "column.load=1000"],
        &[
            "geotaichi/*.vtu",
            "--preset",
            "geotaichi",
            "--set",
            "column.load=1000",
            "--set-time-step",
            "2.04166",
        ],
    ] {
        let told = score(arguments);
        assert!(told.code == 0 && !told.err.contains("diagnosis"), "{arguments:?}: {}", told.err);
    }
    // And one that is bad has, so that the word is the right one.
    let told = score(&["ogs/col.pvd", "--preset", "meshio"]);
    assert!(told.err.contains("diagnosis: your p is exactly 0 at"), "{}", told.err);
}

#[test]
fn an_array_that_is_not_there_is_told_with_those_that_are() {
    let folder = TempDir::new().expect("a folder");
    let map = folder.path().join("map.toml");
    let with = |text: &str| {
        fs::write(&map, text).expect("a file");
        let told = score(&["ogs/col.pvd", "--preset", "ogs", "--mapping", map.to_str().expect("a path")]);
        assert_eq!(told.code, 2, "{}", told.out);
        told.err
    };
    let told = with("columns = { p = \"presure\" }\n");
    assert!(
        told.contains("no array `presure`") && told.contains("`pressure_interpolated` on points"),
        "{told}"
    );
    let told = with("columns = { u_y = \"displacement\" }\n");
    assert!(told.contains("2 components") && told.contains("displacement[1]"), "{told}");
    let told = with("columns = { p = \"cells:pressure\" }\n");
    assert!(told.contains("no array `cells:pressure`"), "{told}");
    let told = score(&["porepy/col.pvd", "--preset", "kratos"]);
    assert!(told.code == 2 && told.err.contains("nothing to score"), "{}", told.err);
}

#[test]
fn what_cannot_be_scored_is_answered_with_what_can() {
    for (arguments, told) in [
        (&["ogs"][..], "it is a folder: give the collection in it, ogs/col.pvd"),
        (&["kratos-vtk"], "give its files, 'kratos-vtk/*.vtk' with the quotes"),
        (&["ogs/col_ts_50_t_4.087500.vtu"], "score ogs/col.pvd, which lists it"),
        (&["porepy/col_2_000001.vtu", "--preset", "porepy"], "score porepy/col.pvd, which lists it"),
        (&["geotaichi/particles/*.npz"], "it looks like a file for `--preset geotaichi`"),
        (&["ogs/col.pvd", "--preset", "kratos"], "it looks like a file for `--preset ogs`"),
        (&["kratos-vtk/*.vtk", "--set-time-step", "0.08175"], "it looks like a file for `--preset kratos`"),
    ] {
        let found = score(arguments);
        assert!(found.code == 2 && found.err.contains(told), "{arguments:?}: {}", found.err);
    }
    // Where it can be read all the same, a note tells.
    let told = score(&["ogs/col.pvd"]);
    assert!(told.code == 0 && told.err.contains("it looks like a file for `--preset ogs`"), "{}", told.err);
    assert!(!score(&["ogs/col.pvd", "--preset", "ogs"]).err.contains("it looks like"));
}

#[test]
fn a_slab_and_a_column_in_the_plane_are_scored_without_a_grid_that_fits_them() {
    let folder = TempDir::new().expect("a folder");
    let exact = call(folder.path(), &["exact", "mandel", "--time-factor", "0.1", "--x", "0,0.5,1"]);
    let mut text = "t,x,y,p,u_x\n".to_owned();
    let mut turned = text.clone();
    for row in exact.out.lines().skip(1) {
        let entries: Vec<&str> = row.split(',').collect();
        // From the middle of the slab to its drained side; as many across.
        for across in [0.0, 0.5, 1.0] {
            writeln!(text, "8.175,{},{across},{},0", entries[1], entries[2]).expect("a line");
            writeln!(turned, "8.175,{across},{},{},0", entries[1], entries[2]).expect("a line");
        }
    }
    fs::write(folder.path().join("turned.csv"), turned).expect("a file");
    let told =
        call(folder.path(), &["score", "turned.csv", "--scene", "mandel", "--without", "displacement"]);
    assert!(told.err.contains("are the axes exchanged (of `mandel`"), "{}", told.err);
    fs::write(folder.path().join("slab.csv"), text).expect("a file");
    let told = call(folder.path(), &["score", "slab.csv", "--scene", "mandel", "--format", "csv"]);
    let found = values(&told, ",pressure,points,l2,");
    assert!(found.len() == 1 && found[0] < 1e-12, "{found:?}: {}", told.err);
    let settled = values(&told, ",settlement,");
    assert!(settled.is_empty() && told.err.contains("it is that of the plate"), "{settled:?}: {}", told.err);
    let plane = ["ogs/col.pvd", "--preset", "ogs", "--set", "column.dimensions=2"];
    assert!(are(&values(&score(&plane), PRESSURE), &TEN));
}

#[test]
fn one_column_of_nodes_and_a_settlement_curve_are_told_in_the_mapping() {
    let folder = TempDir::new().expect("a folder");
    let map = folder.path().join("map.toml");
    let curve = folder.path().join("settled.csv");
    fs::write(&curve, "day,mm\n4.0875,1e-4\n8.175,2e-4\n").expect("a file");
    let text = format!(
        "[rows]\nx = 0.0\n[columns]\nu_y = \"\"\n[settlement]\nfile = \"{}\"\nt = \"day\"\ns = \"mm\"\n",
        curve.display()
    );
    fs::write(&map, text).expect("a file");
    let told = score(&["ogs/col.pvd", "--preset", "ogs", "--mapping", map.to_str().expect("a path")]);
    assert!(values(&told, ",displacement,").is_empty());
    let settled = values(&told, ",settlement,");
    assert!(
        settled.len() == 2 && settled.iter().all(|error| *error > 100.0),
        "1e-4 m for 2.5e-7: {settled:?}"
    );
    assert!(told.err.contains("at 2 of 5 times"), "{}", told.err);
    let pressure = values(&told, PRESSURE);
    assert!(are(&pressure[..1], &["2.24e-3"]), "the second column of nodes repeats the first: {pressure:?}");
}

#[test]
fn several_files_of_one_mesh_are_one_pattern() {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    for (cells, step) in [(10, 1), (10, 2), (20, 1), (20, 2)] {
        let time = 0.05 * 81.75 * f64::from(step);
        let exact = call(
            at,
            &[
                "exact",
                "terzaghi",
                "--time-factor",
                &(0.05 * f64::from(step)).to_string(),
                "--zeta",
                "0.1,0.3,0.5,0.7,0.9",
            ],
        );
        let mut text = "t,y,p,u_y\n".to_owned();
        for row in exact.out.lines().skip(1) {
            let entries: Vec<f64> =
                row.split(',').take(3).map(|entry| entry.parse().expect("a number")).collect();
            let pressure = entries[2] * (1.0 + 1.0 / f64::from(cells * cells));
            writeln!(text, "{time},{},{pressure},0", 1.0 - entries[1]).expect("a line");
        }
        fs::create_dir_all(at.join(format!("mesh-{cells}"))).expect("a folder");
        fs::write(at.join(format!("mesh-{cells}/step_{step}.csv")), text).expect("a file");
    }
    let patterns = ["score", "mesh-10/*.csv", "mesh-20/*.csv", "--scene", "terzaghi"];
    let told = call(
        at,
        &[&patterns[..], &["--reference", "terzaghi", "--cells", "10,20", "--format", "csv"]].concat(),
    );
    let errors = values(&told, ",pressure,points,l2,");
    assert!(are(&errors, &["1.0e-2", "1.0e-2", "2.5e-3", "2.5e-3"]), "{errors:?}");
    let told = call(at, &[&patterns[..], &["--cells", "10"]].concat());
    assert!(told.code == 2 && told.err.contains("quoted pattern"), "{}", told.err);
}
