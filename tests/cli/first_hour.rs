//! The first hour of a new user: a study of one's own, a soft soil, a shipped study by its name.

use crate::program::{call, folder_with};
use std::fs;

const SOFT: &str = r#"title = "A softer soil"
scene = "terzaghi"

[material]
youngs_modulus = 0.2e6
hydraulic_conductivity = 1e-6

[[sweep]]
method = ["GC-SRI-patch"]
cells = [5, 10]
"#;

#[test]
fn a_starter_runs_and_meets_what_it_expects() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    assert_eq!(call(at, &["new", "my-study"]).code, 0);
    let told = call(at, &["check", "my-study.toml"]);
    assert!(told.out.contains("1 of 1 expectations met"), "{}{}", told.out, told.err);
    let again = call(at, &["new", "my-study"]);
    assert!(again.code == 2 && again.err.contains("is there already"), "{}", again.err);
    assert_eq!(call(at, &["new", "My Study"]).code, 2);
}

#[test]
fn the_natural_study_of_a_soft_soil_ends_in_seconds_and_who_names_explicit_is_warned() {
    let folder = folder_with(SOFT);
    let at = folder.path();
    let told = call(at, &["run", "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(
        told.err.contains("the sweep names no integrator") && told.err.contains("is taken"),
        "{}",
        told.err
    );
    let table = fs::read_to_string(at.join("out/short/short.csv")).expect("a table");
    assert!(table.lines().skip(1).all(|line| line.contains(",implicit,")), "{table}");
    fs::write(at.join("short.toml"), SOFT.replace("cells", "integrator = [\"explicit\"]\ncells"))
        .expect("a file");
    let told = call(at, &["plan", "short.toml"]);
    assert!(
        told.out.contains(" explicit ") && told.err.contains("integrator = [\"implicit\"]"),
        "{}",
        told.err
    );
    assert!(told.err.contains(" h") && told.err.contains("2 cases: about"), "{}", told.err);
}

#[test]
fn a_shell_offers_methods_scenes_and_integrators() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let told = call(folder.path(), &["completions", "bash"]);
    for name in ["GC-SRI-patch", "cosine-layer", "semi-implicit"] {
        assert!(told.out.contains(name), "{name}");
    }
}

#[test]
fn a_shipped_study_is_there_by_its_name() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    let shown = call(at, &["list", "--show", "stability-slow-growth"]);
    let own = include_str!("../../studies/stability-slow-growth.toml");
    assert_eq!((shown.code, shown.out.as_str()), (0, own));
    let told = call(at, &["plan", "stability-slow-growth"]);
    assert!(told.code == 0 && told.out.contains("stability-slow-growth,"), "{}", told.err);
    let told = call(at, &["plan", "terzaghi-mehs"]);
    assert!(told.code == 2 && told.err.contains("did you mean `terzaghi-mesh`?"), "{}", told.err);
}
