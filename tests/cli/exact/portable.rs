//! The same values on every machine: none may hang on the platform's elementary functions.

use crate::program::{Told, call_with, table_without_times};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// What is solved: every way to values that led through a logarithm, an exponential or a power.
const CALLS: [&[&str]; 6] = [
    &["exact", "dynamic-column", "--set", "column.loading_time=0.002", "--format", "json"],
    &["exact", "mandel", "--time-factor", "0.001,0.01,0.1,1", "--format", "json"],
    &["exact", "cosine-layer", "--x", "0,0.5", "--format", "json"],
    &["exact", "xie-leo", "--set", "column.load=2e5", "--format", "json"],
    &["exact", "large-strain", "--set", "column.load=2e5", "--time-factor", "0.1", "--format", "json"],
    &["schema", "study"],
];

const STUDY: &str = r#"
title = "Short"
scene = "xie-leo"

[column]
load = 1.0e5

[output]
time_factors = [0.05]

[[sweep]]
method = ["GIMP"]
integrator = ["implicit"]
cells = [4, 8, 16]
"#;

/// A C library that is off in the last place, compiled; nothing where the platform has no compiler or
/// loads no library before its own.
fn perturbed_library(folder: &Path) -> Option<PathBuf> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/exact/perturbed_libm.c");
    let library = folder.join("perturbed_libm.so");
    let compiled = Command::new("cc")
        .args(["-O1", "-fno-builtin", "-shared", "-fPIC", "-o"])
        .args([&library, &source])
        .args(["-ldl", "-lm"])
        .status();
    compiled.is_ok_and(|status| status.success()).then_some(library)
}

/// A call with the platform's own library and one with the perturbed.
fn both(folder: &Path, library: &Path, arguments: &[&str]) -> [Told; 2] {
    let preload = library.to_str().expect("a path in words");
    [call_with(folder, &[], arguments), call_with(folder, &[("LD_PRELOAD", preload)], arguments)]
}

#[test]
#[expect(clippy::print_stderr, reason = "a test that cannot run here says so")]
fn a_c_library_off_by_one_unit_in_the_last_place_changes_no_value() {
    let folder = TempDir::new().expect("a folder");
    let Some(library) = perturbed_library(folder.path()) else {
        eprintln!("skipped: no C compiler whose library could be loaded before the platform's");
        return;
    };
    for arguments in CALLS {
        let [plain, perturbed] = both(folder.path(), &library, arguments);
        assert_eq!(plain.code, 0, "{arguments:?}: {}", plain.err);
        assert_eq!(plain.out, perturbed.out, "{arguments:?}");
    }
    std::fs::write(folder.path().join("short.toml"), STUDY).expect("a file");
    let preload = library.to_str().expect("a path in words");
    let mut tables = Vec::new();
    for (out, variables) in [("plain", vec![]), ("perturbed", vec![("LD_PRELOAD", preload)])] {
        let told = call_with(folder.path(), &variables, &["run", "short.toml", "--out", out]);
        assert_eq!(told.code, 0, "{}", told.err);
        let table = table_without_times(&folder.path().join(out).join("short/short.csv"));
        tables.push(table);
    }
    assert!(tables[0].lines().count() > 10, "{}", tables[0]);
    assert_eq!(tables[0], tables[1]);
}

#[test]
fn matrices_are_multiplied_by_no_instruction_that_only_some_processors_have() {
    // With `std` come products that are fused where the processor can, and with them other last bits.
    let manifest: toml::Table = toml::from_str(include_str!("../../../Cargo.toml")).expect("a manifest");
    let nalgebra = &manifest["workspace"]["dependencies"]["nalgebra"];
    assert_eq!(nalgebra["default-features"].as_bool(), Some(false));
    let features = nalgebra["features"].as_array().expect("features");
    assert!(features.iter().all(|feature| feature.as_str() != Some("std")), "{features:?}");
    // Features add up over the workspace: no crate may ask for its own.
    let crates = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("crates")).expect("the crates");
    for folder in crates.map(|entry| entry.expect("an entry").path()) {
        let text = std::fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest");
        let manifest: toml::Table = toml::from_str(&text).expect("a manifest");
        if let Some(nalgebra) = manifest["dependencies"].get("nalgebra") {
            assert_eq!(nalgebra.to_string(), "{ workspace = true }", "{}", folder.display());
        }
    }
}

#[test]
fn the_exact_slab_is_printed_from_its_middle_to_its_side() {
    let folder = TempDir::new().expect("a folder");
    let arguments = ["exact", "mandel", "--time-factor", "0.05000818181818182", "--x", "0,1"];
    let told = call_with(folder.path(), &[], &arguments);
    assert_eq!(told.code, 0, "{}", told.err);
    let lines: Vec<&str> = told.out.lines().collect();
    assert_eq!(lines[0], "time_factor,x,pressure_ratio,stress_ratio,displacement_ratio,strain_ratio");
    let row: Vec<f64> = lines[1].split(',').map(|cell| cell.parse().expect("a number")).collect();
    // crates/exact/tests/reference/mandel.csv, the seed at T = 0.05.
    for (found, exact) in row[2..].iter().zip([0.543_317_759_436, 1.088_902_890_715, 0.0, 0.272_509_144_159])
    {
        assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
    }
    assert_eq!(lines.len(), 3);
    assert!(told.err.contains("terms, tail below"), "{}", told.err);
}

#[test]
fn the_exact_column_takes_a_load_that_grows() {
    let folder = TempDir::new().expect("a folder");
    let arguments = [
        "exact",
        "dynamic-column",
        "--set",
        "column.loading_time=0.002",
        "--time-factor",
        "0.001",
        "--zeta",
        "1",
    ];
    let told = call_with(folder.path(), &[], &arguments);
    assert_eq!(told.code, 0, "{}", told.err);
    let pressure: f64 = told
        .out
        .lines()
        .nth(1)
        .expect("a row")
        .split(',')
        .nth(2)
        .expect("a pressure")
        .parse()
        .expect("a number");
    // A load that grows over hardly more than the way of the wave presses less than twice its own.
    assert!((0.5..2.0).contains(&pressure), "{pressure}");
}
