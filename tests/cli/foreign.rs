//! `score` on real files of other programs: their errors, and what is said of their pitfalls.

use crate::program::{Told, call};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn files() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign")
}

/// Scores files of a seed column against Terzaghi's solution.
fn score(arguments: &[&str]) -> Told {
    let common = ["--scene", "terzaghi", "--reference", "terzaghi", "--format", "csv"];
    call(&files(), &[&["score"], arguments, &common].concat())
}

/// Values of the rows of a quantity and norm, by time; of several results one after the other.
fn values(told: &Told, row: &str) -> Vec<f64> {
    assert_eq!(told.code, 0, "{}", told.err);
    let header = told.out.lines().next().expect("a header");
    let column = header.split(',').position(|name| name == "value").expect("a column of values");
    let rows = told.out.lines().filter(|line| line.contains(row));
    rows.map(|line| line.split(',').nth(column).expect("a value").parse().expect("a number")).collect()
}

/// Whether numbers are those of a table, to the half of its last digit; a sign counts.
fn are(found: &[f64], table: &[&str]) -> bool {
    let as_shown = |(value, shown): (&f64, &&str)| {
        let digits = shown.split('e').next().unwrap_or_default().split('.').nth(1).map_or(0, str::len);
        let number: f64 = shown.parse().expect("a number");
        let unit =
            10_f64.powf(number.abs().log10().floor()) * 10_f64.powi(-i32::try_from(digits).expect("few"));
        (value - number).abs() <= 0.501 * unit
    };
    found.len() == table.len() && found.iter().zip(table).all(as_shown)
}

const PRESSURE: &str = ",pressure,nodes,l2,";
/// Q2–P1 elements in backward Euler steps of 0.001, computed with another program (scikit-fem).
const TEN: [&str; 5] = ["2.24e-3", "1.85e-3", "1.66e-3", "1.04e-3", "2.70e-5"];

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

/// Pressures of ten finite volumes after backward Euler steps of 4.0875 s: computed here anew.
fn finite_volumes(steps: usize) -> Vec<f64> {
    let (cells, spread) = (10, 1e-4 * 1.2e6 / 9810.0);
    let mut pressure = vec![1.0_f64; cells];
    let share = spread * 4.0875 * 100.0;
    for _ in 0..steps {
        let mut diagonal: Vec<f64> = (0..cells).map(|_| 1.0 + 2.0 * share).collect();
        (diagonal[0], diagonal[9]) = (1.0 + share, 1.0 + 3.0 * share);
        for cell in 1..cells {
            let factor = -share / diagonal[cell - 1];
            diagonal[cell] += factor * share;
            pressure[cell] -= factor * pressure[cell - 1];
        }
        pressure[9] /= diagonal[9];
        for cell in (0..9).rev() {
            pressure[cell] = (pressure[cell] + share * pressure[cell + 1]) / diagonal[cell];
        }
    }
    pressure
}

/// The files hold 20 steps of `ΔT_v` = 0.05, so that every state's error is that of the same scheme made here.
#[test]
fn pore_py_has_its_pressures_on_cells() {
    let told = score(&["porepy/col.pvd", "--preset", "porepy"]);
    let found = values(&told, ",pressure,centres,l2,");
    let depths: Vec<String> = (0..10).map(|cell| ((9.5 - f64::from(cell)) / 10.0).to_string()).collect();
    let states = [("0.05", 1), ("0.1", 2), ("0.2", 4), ("0.5", 10), ("1", 20)];
    assert_eq!(found.len(), states.len());
    for (found, (time_factor, steps)) in found.iter().zip(states) {
        let exact =
            call(&files(), &["exact", "terzaghi", "--time-factor", time_factor, "--zeta", &depths.join(",")]);
        let exact = exact
            .out
            .lines()
            .skip(1)
            .map(|row| row.split(',').nth(2).expect("p").parse::<f64>().expect("a number"));
        let pairs: Vec<(f64, f64)> = finite_volumes(steps).into_iter().zip(exact).collect();
        let sum = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
        let own = (sum(&|(a, b)| (a - b).powi(2)) / sum(&|(_, b)| b * b)).sqrt();
        assert!((found / own - 1.0).abs() < 1e-3, "T_v = {time_factor}: {found} and {own}");
    }
    assert!(told.err.contains("no settlement is judged"), "{}", told.err);
}

#[test]
fn geo_taichi_has_its_displacements_from_the_first_state_and_points_missing() {
    let load = ["--preset", "geotaichi", "--set", "column.load=1000"];
    for (file, step) in [("geotaichi/particles/*.npz", None), ("geotaichi/*.vtu", Some("2.04166"))] {
        let step = step.map_or(vec![], |step| vec!["--set-time-step", step]);
        let told = score(&[&[file], &load[..], &step].concat());
        let found = values(&told, ",pressure,points,l2,");
        assert!(are(&found[2..], &["6.5e-2"]), "{file}: {found:?}");
        let moved = values(&told, ",displacement,points,l2,");
        assert!(moved.last().is_some_and(|error| *error < 0.1), "{file}: {moved:?}");
        assert!(
            told.err.contains("volume-differs") && told.err.contains("1.84 % are missing"),
            "{}",
            told.err
        );
        assert_eq!(told.err.contains("`state_vars`"), step.is_empty(), "the pickled member: {}", told.err);
    }
    let told = score(&[&["geotaichi/particles/MPMParticle000002.npz"], &load[..]].concat());
    assert!(told.code == 0 && told.err.contains("give the first state too"), "{}", told.err);
    assert!(!told.out.contains("displacement"), "{}", told.out);
}

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
    assert!(told.err.contains("are the axes exchanged?"), "{}", told.err);
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
