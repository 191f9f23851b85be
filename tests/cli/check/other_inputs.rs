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
    let input =
        found.find("4 cases have other inputs than their golden values, like GIMP-SRI").expect(&told.out);
    assert!(input < found.find("golden values: ").expect(&told.out), "{}", told.out);
    let told = call(folder.path(), &["explain", "cells=6 hydraulic_conductivity=0.00001", "short.toml"]);
    assert!(told.err.contains("Its inputs differ from theirs"), "{}{}", told.out, told.err);
}

#[test]
fn a_case_whose_label_has_the_input_that_changed_is_missing_and_new() {
    let folder = changed("1e-5, 1e-6", "1e-5, 2e-6");
    let told = call(folder.path(), &["check", "short.toml"]);
    let found = told.words();
    assert!(found.contains("are no longer measured, in 2 cases"), "{}", told.out);
    assert!(found.contains("are not in the golden file, in 2 cases"), "{}", told.out);
    assert!(!found.contains("have other inputs") && told.code == 5, "{}", told.out);
}

#[test]
fn golden_values_of_other_inputs_are_to_be_accepted_again_though_all_agree() {
    // Without inertia the density of the grains acts on nothing.
    let folder = changed("youngs_modulus = 1e6\n", "youngs_modulus = 1e6\ngrain_density = 2600.0\n");
    let told = call(folder.path(), &["check", "short.toml"]);
    assert_eq!(told.code, 5, "{}{}", told.out, told.err);
    let found = told.words();
    assert!(found.contains("4 cases have other inputs than their golden values"), "{}", told.out);
    assert!(found.contains("next: oedometer accept short.toml"), "{}", told.out);
}

/// The golden file of the study in layout 3 or 2, with the values of today; `inputs` are those of its header.
fn in_older_layout(text: &str, layout: u32, inputs: &str) -> String {
    let mut lines = text.lines().skip(2);
    let titles = lines.next().expect("titles").replace("case,hash,T_v", "case,T_v");
    let titles = titles.replace(" terzaghi", " l2 terzaghi").replace("surface l2 ", "surface relative ");
    let rows = lines.map(|line| {
        let (case, rest) = line.split_once(',').expect("a case");
        // Two norms that are not kept, and steps times points.
        format!("{case},{},1,2\n", rest.split_once(',').expect("a hash").1)
    });
    format!(
        "# schema = {layout}\n# study = \"short\"\n# reason = \"for a test\"\n# relative_tolerance = 1e-9\n\
         # absolute_tolerance = 1e-12\n# basis = \"a test\"\n# seconds = 0.1\n#\n# [provenance]\n# version = \"0.2.0\"\n\
         {inputs}{titles},point updates,pressure points l1 terzaghi\n{}",
        rows.collect::<String>()
    )
}

#[test]
fn golden_files_of_older_layouts_are_read_and_one_command_writes_them_anew() {
    let folder = changed("1e6", "1.0e6");
    let at = folder.path();
    let path = at.join("golden/short.csv");
    let today = fs::read_to_string(&path).expect("a file");
    for (layout, inputs) in [(2, ""), (3, "#\n# [inputs]\n# youngs_modulus = \"7 Pa\"\n")] {
        fs::write(&path, in_older_layout(&today, layout, inputs)).expect("written");
        // Values are read of it and no inputs: without a hash nothing tells these.
        let told = call(at, &["check", "short.toml"]);
        assert_eq!(told.code, 0, "{layout}: {}{}", told.out, told.err);
        assert!(!told.words().contains("have other inputs"), "{}", told.out);
    }
    let told = call(at, &["accept", "short.toml"]);
    assert!(told.code == 2 && told.err.contains("--reason"), "{}", told.err);
}
