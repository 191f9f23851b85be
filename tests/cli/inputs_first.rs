//! What `check` and `explain` say first when an input of a study is another than that of its golden values.

use crate::program::{call, folder_with};
use oedometer::{GoldenFile, RunOptions, Study, StudySource, Tier, run_study};
use std::fs;
use tempfile::TempDir;

const STUDY: &str = "title = \"A short study\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[material]\n\
                     youngs_modulus = 1e6\n\n[[sweep]]\nmethod = [\"GIMP-SRI\"]\nintegrator = [\"implicit\"]\n\
                     cells = [3, 6]\nhydraulic_conductivity = [1e-5, 1e-6]\n";

/// A folder with golden values of the study, which then has another text.
fn changed(from: &str, to: &str) -> TempDir {
    let folder = folder_with(STUDY);
    let source = StudySource { name: "short.toml".to_owned(), text: STUDY.to_owned() };
    let study = Study::check(&source).expect("a sound study");
    let records = run_study(&study, &RunOptions::whole(Tier::Ci, 1), None, &|_| {}).records;
    GoldenFile::of("short", &records, "for a test").write(&folder.path().join("golden")).expect("written");
    assert!(STUDY.contains(from));
    fs::write(folder.path().join("short.toml"), STUDY.replace(from, to)).expect("written");
    folder
}

#[test]
fn an_input_that_changed_is_told_before_the_values_that_moved() {
    let folder = changed("1e6", "1.1e6");
    let told = call(folder.path(), &["check", "short.toml"]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    let found = told.words();
    let input = found
        .find("inputs that changed since the golden values were taken youngs_modulus 1e6 Pa → 1.1e6 Pa in 4 cases")
        .expect(&told.out);
    assert!(input < found.find("golden values that differ").expect(&told.out), "{}", told.out);
    let told = call(folder.path(), &["explain", "cells=6 hydraulic_conductivity=0.00001", "short.toml"]);
    let first: Vec<&str> = told.out.lines().take(4).collect();
    assert!(
        first[0].starts_with("inputs that differ") && told.out.contains("1.1e6 Pa"),
        "{}{}",
        told.out,
        told.err
    );
}

#[test]
fn a_case_whose_label_has_the_input_that_changed_is_compared_with_its_nearest() {
    let folder = changed("1e-5, 1e-6", "1e-5, 2e-6");
    let told = call(folder.path(), &["check", "short.toml"]);
    let found = told.words();
    assert!(found.contains("hydraulic_conductivity 1e-6 m/s → 2e-6 m/s in 2 cases"), "{}", told.out);
    assert!(!found.contains("no longer measured") && !found.contains("not in the golden"), "{}", told.out);
    let told = call(folder.path(), &["explain", "cells=6 hydraulic_conductivity=0.000002", "short.toml"]);
    assert!(told.words().contains("| 1e-6 m/s | 2e-6 m/s |"), "{}{}", told.out, told.err);
}

#[test]
fn golden_values_of_other_inputs_are_to_be_accepted_again_though_all_agree() {
    // Without inertia the density of the grains acts on nothing.
    let folder = changed("youngs_modulus = 1e6\n", "youngs_modulus = 1e6\ngrain_density = 2600.0\n");
    let told = call(folder.path(), &["check", "short.toml"]);
    assert_eq!(told.code, 5, "{}{}", told.out, told.err);
    let found = told.words();
    assert!(found.contains("grain_density 2650 kg/m³ → 2600 kg/m³ in 4 cases"), "{}", told.out);
    assert!(found.contains("next: oedometer accept short.toml"), "{}", told.out);
}

#[test]
fn a_golden_file_of_layout_2_is_read_and_knows_no_inputs() {
    let folder = changed("1e6", "1.1e6");
    let path = folder.path().join("golden/short.csv");
    let text = fs::read_to_string(&path).expect("a file");
    let (header, table) = text.split_once("case,T_v").expect("a table");
    let header = header.split("# [inputs]").next().expect("a header").replace("schema = 3", "schema = 2");
    fs::write(&path, format!("{header}case,T_v{table}")).expect("written");
    let told = call(folder.path(), &["check", "short.toml"]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    assert!(
        !told.out.contains("inputs that changed") && told.out.contains("golden values that differ"),
        "{}",
        told.out
    );
}
