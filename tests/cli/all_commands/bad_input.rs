//! Bad input ends with exit code 2 and a sentence that says where and what would be right; nothing
//! goes to standard output and nothing panics.

use crate::program::{Told, assert_snapshot, call};
use std::path::Path;
use tempfile::TempDir;

/// A study that runs; what a test breaks is put in the place of one of its lines.
const SOUND: &str = r#"title = "Sound"
scene = "terzaghi"

[material]
porosity = 0.3

[output]
time_factors = [0.001]

[[sweep]]
method = ["GC-SRI-patch"]
cells = [2]
points_per_cell = [2]
time_step = [{ stable = 0.8 }]
"#;

/// What a refused command wrote to standard error.
fn refused_in(folder: &Path, arguments: &[&str]) -> String {
    let Told { code, out, err: told } = call(folder, arguments);
    assert_eq!(code, 2, "{arguments:?}: {told}");
    assert_eq!(out, "", "{arguments:?}: nothing on standard output");
    assert!(told.starts_with("error: "), "{arguments:?}: {told}");
    told
}

fn refused(arguments: &[&str]) -> String {
    refused_in(TempDir::new().expect("a folder").path(), arguments)
}

/// What `run` says of a study; it must leave no folder of results behind.
fn refused_study(text: impl AsRef<[u8]>) -> String {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("study.toml"), text).expect("a file");
    let told = refused_in(folder.path(), &["run", "study.toml"]);
    assert!(!folder.path().join("out").exists(), "nothing is written for a study that is refused");
    let planned = refused_in(folder.path(), &["plan", "study.toml"]);
    assert_eq!(planned, told, "`plan` refuses in the words of `run`");
    told
}

/// What `run` says of the sound study with one line replaced.
fn refused_with(line: &str, replacement: &str) -> String {
    assert!(SOUND.contains(line), "{line}");
    let text = SOUND.replacen(line, replacement, 1);
    let told = refused_study(&text);
    let (before, _) = text.split_once(replacement).expect("it was put there");
    let number = before.matches('\n').count() + 1;
    let reached = number + replacement.lines().count();
    let placed = (number..=reached).any(|number| told.contains(&format!("study.toml:{number}:")));
    assert!(placed, "line {number} of\n{text}is not named by\n{told}");
    assert!(told.contains('^'), "no caret: {told}");
    told
}

fn assert_says(told: &str, parts: &[&str]) {
    for part in parts {
        assert!(told.contains(part), "`{part}` is missing in\n{told}");
    }
}

#[test]
fn the_sound_study_is_taken() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("study.toml"), SOUND).expect("a file");
    assert_eq!(call(folder.path(), &["run", "study.toml"]).code, 0);
}

#[test]
fn misspelt_keys_are_refused_with_the_nearest_key() {
    let told = refused_with("porosity = 0.3", "porosty = 0.3");
    assert_snapshot("bad_input_misspelt_key", &told);
    assert_says(&told, &["unknown key `porosty`", "did you mean `porosity`?"]);
    let told = refused_with("cells = [2]", "cell = [2]");
    assert_says(&told, &["unknown key `cell`", "did you mean `cells`?"]);
    let told = refused_with("[material]", "[materials]");
    assert_says(&told, &["unknown key `materials`", "did you mean `material`?"]);
    let told = refused_with("time_factors = [0.001]", "time_factor = [0.001]");
    assert_says(&told, &["did you mean `time_factors`?"]);
    let told = refused_with("{ stable = 0.8 }", "{ stabel = 0.8 }");
    assert_says(&told, &["did you mean `stable`?"]);
}

/// What `run` says of the sound study with an expectation.
fn refused_expectation(keys: &str) -> String {
    refused_study(format!("{SOUND}\n[[expect]]\ntime_factor = 0.001\n{keys}\n"))
}

#[test]
fn a_value_without_a_reference_must_be_one_number_and_nothing_else_has_an_uncertainty() {
    for (keys, part) in [
        ("reference = \"none\"\nuncertainty = { below = 0.1 }", "the pressure is not a single number"),
        ("reference = \"none\"\nprobe = 1.5\nuncertainty = { below = 0.1 }", "a probe at a depth of 1.5"),
        ("reference = \"none\"\nprobe = nan\nuncertainty = { below = 0.1 }", "a probe at a depth of NaN"),
        ("probe = 0.5\norder = { value = 2.0 }", "compared with no reference"),
        ("quantity = \"settlement\"\nuncertainty = { below = 0.1 }", "needs no uncertainty"),
        (
            "quantity = \"settlement\"\nreference = \"none\"\nat = { cells = 2, below = 0.1 }",
            "no error for `at`",
        ),
        (
            "quantity = \"settlement\"\nreference = \"none\"\nuncertainty = { below = -1.0 }",
            "positive number",
        ),
        ("quantity = \"settlement\"\nreference = \"none\"", "demands nothing"),
        (
            "reference = \"next-finer\"\norder = { value = 2.0 }",
            "the next finer level has its samples at \
          other places",
        ),
    ] {
        assert_says(&refused_expectation(keys), &[part]);
    }
}

#[test]
fn unknown_keys_without_a_near_one_are_told_the_keys_there_are() {
    let told = refused_with("porosity = 0.3", "colour = 0.3");
    assert_snapshot("bad_input_unknown_key", &told);
    assert_says(&told, &["unknown key `colour`", "youngs_modulus", "hydraulic_conductivity"]);
}

#[test]
fn impossible_materials_are_refused_with_what_is_possible() {
    let told = refused_with("porosity = 0.3", "porosity = 1.4");
    assert_snapshot("bad_input_porosity", &told);
    for (line, parts) in [
        ("porosity = 0.0", ["`material.porosity` is 0", "between 0 and 1"]),
        ("porosity = nan", ["`material.porosity` is NaN", "between 0 and 1"]),
        ("poissons_ratio = 0.5", ["`material.poissons_ratio` is 0.5", "between -1 and 0.5"]),
        ("poissons_ratio = -1", ["`material.poissons_ratio` is -1", "between -1 and 0.5"]),
        ("youngs_modulus = -1e6", ["`material.youngs_modulus` is -1000000 Pa", "positive and finite"]),
        ("youngs_modulus = inf", ["`material.youngs_modulus` is inf", "positive and finite"]),
        ("grain_density = 0", ["`material.grain_density` is 0", "positive and finite"]),
        ("water_density = nan", ["`material.water_density` is NaN", "positive and finite"]),
        ("water_bulk_modulus = -2.2e9", ["`material.water_bulk_modulus` is", "positive and finite"]),
        ("hydraulic_conductivity = inf", ["`material.hydraulic_conductivity` is inf", "positive and finite"]),
        ("hydraulic_conductivity = 0", ["`material.hydraulic_conductivity` is 0 m/s", "positive and finite"]),
        ("gravity = 0", ["`material.gravity` is 0", "positive and finite"]),
        ("youngs_modulus = 1.0", ["no soil has a Young's modulus of 1 Pa", "like \"5 MPa\""]),
        ("hydraulic_conductivity = 1e4", ["conductivity of 10000 m/s", "metres per second"]),
        ("water_bulk_modulus = 2.2", ["no liquid has a bulk modulus of 2.2 Pa", "like \"2.2 GPa\""]),
        ("law = \"linaer\"", ["no law is called `linaer`", "did you mean `linear`?"]),
        ("continuity = \"exact\"", ["no continuity is called `exact`", "`conservative`"]),
    ] {
        let told = refused_with("porosity = 0.3", line);
        assert_says(&told, &parts);
        assert_eq!(told.matches("error: ").count(), 1, "one complaint for one fault: {told}");
    }
}

#[test]
fn impossible_columns_are_refused() {
    for (line, part) in [
        ("column.height = 0", "`column.height` is 0 m"),
        ("column.height = -1", "`column.height` is -1 m"),
        ("column.load = nan", "`column.load` is NaN Pa"),
        ("column.load = inf", "`column.load` is inf Pa"),
    ] {
        let told = refused_with("\n[material]", &format!("{line}\n[material]"));
        assert_says(&told, &[part, "positive and finite"]);
    }
}

#[test]
fn impossible_discretisations_are_refused() {
    let told = refused_with("cells = [2]", "cells = [2, 0]");
    assert_snapshot("bad_input_zero_cells", &told);
    assert_says(&refused_with("cells = [2]", "cells = [-4]"), &["`cells` is -4", "between 1 and"]);
    assert_says(&refused_with("cells = [2]", "cells = [1000000000000]"), &["`cells` is 1000000000000"]);
    assert_says(
        &refused_with("cells = [2]", "cells = [2.5]"),
        &["`cells` takes a whole number", "not `2.5`"],
    );
    assert_says(&refused_with("cells = [2]", "cells = 2"), &["`cells` takes a list", "write `cells = [2]`"]);
    assert_says(&refused_with("points_per_cell = [2]", "points_per_cell = [0]"), &["`points_per_cell` is 0"]);
    assert_says(&refused_with("points_per_cell = [2]", "points_per_cell = [99]"), &["between 1 and 16"]);
}

#[test]
fn impossible_times_are_refused() {
    let told = refused_with("[0.001]", "[0.1, -0.05]");
    assert_snapshot("bad_input_negative_time_factor", &told);
    for (list, part) in [
        ("[nan]", "a time factor of NaN"),
        ("[inf]", "a time factor of inf"),
        ("[1e9]", "a time factor of 1000000000"),
        ("[]", "no time factor"),
    ] {
        assert_says(&refused_with("[0.001]", list), &[part]);
    }
}

#[test]
fn time_steps_that_are_none_are_refused() {
    let told = refused_with("{ stable = 0.8 }", "{ stable = 0.8, seconds = 1e-6 }");
    assert_snapshot("bad_input_two_step_rules", &told);
    for (rule, parts) in [
        ("{}", ["a time step with 0 rules", "give exactly one"]),
        ("{ stable = -0.5 }", ["a time step of -0.5", "positive and finite"]),
        ("{ stable = 0 }", ["a time step of 0", "positive and finite"]),
        ("{ seconds = nan }", ["a time step of NaN", "positive and finite"]),
        ("{ courant = inf }", ["a time step of inf", "positive and finite"]),
        ("{ growth = 0.05 }", ["cannot let its steps grow", "zip both axes with `path`"]),
    ] {
        assert_says(&refused_with("{ stable = 0.8 }", rule), &parts);
    }
}

#[test]
fn names_that_are_none_are_refused_with_the_names_there_are() {
    let told = refused_with("\"GC-SRI-patch\"", "\"GC-SRI-pach\"");
    assert_snapshot("bad_input_unknown_method", &told);
    for (line, replacement, parts) in [
        (
            "scene = \"terzaghi\"",
            "scene = \"tezaghi\"",
            ["no scene is called `tezaghi`", "did you mean `terzaghi`?"],
        ),
        ("cells = [2]", "cells = [2]\nintegrator = [\"implict\"]", ["no integrator is called", "`explicit`"]),
        ("cells = [2]", "cells = [2]\ntier = \"big\"", ["no tier is called `big`", "`smoke`, `ci`, `full`"]),
        ("cells = [2]", "cells = [2]\ndrag = [\"none\"]", ["no drag is called `none`", "`implicit`"]),
        ("cells = [2]", "cells = [2]\nflip = [1.5]", ["a FLIP share of 1.5", "between 0 (PIC) and 1 (FLIP)"]),
        (
            "cells = [2]",
            "cells = [2]\npath = [\"cell\"]",
            ["no axis is called `cell`", "did you mean `cells`?"],
        ),
        ("[\"GC-SRI-patch\"]", "[{ basis = \"hat\" }]", ["`strain` is missing", "standard"]),
        (
            "time_factors = [0.001]",
            "references = [\"xie-leo\"]",
            ["no reference is called `xie-leo`", "`terzaghi-incompressible`"],
        ),
    ] {
        assert_says(&refused_with(line, replacement), &parts);
    }
}

#[test]
fn a_path_whose_axes_differ_in_length_is_refused() {
    let told = refused_with("cells = [2]", "cells = [2, 4, 8]\npath = [\"cells\", \"time_step\"]");
    assert_says(&told, &["`time_step` has 1 values", "equal lengths"]);
}

#[test]
fn empty_sweeps_and_lists_are_refused() {
    let told = refused_with("cells = [2]", "cells = []");
    assert_snapshot("bad_input_empty_list", &told);
    let (without_sweep, _) = SOUND.split_once("[[sweep]]").expect("a sweep");
    let told = refused_study(without_sweep);
    assert_snapshot("bad_input_no_sweep", &told);
    let told = refused_study(format!("{without_sweep}[[sweep]]\n"));
    assert_snapshot("bad_input_empty_sweep", &told);
    assert_says(&refused_with("[\"GC-SRI-patch\"]", "[]"), &["`method` is empty", "at least one"]);
    assert_says(&refused_with("[{ stable = 0.8 }]", "[]"), &["`time_step` is empty"]);
}

#[test]
fn every_complaint_is_made_at_once() {
    let text = SOUND.replace("porosity = 0.3", "porosity = 1.4").replace("cells = [2]", "cells = [0]");
    let told = refused_study(text);
    assert_says(&told, &["study.toml:5:", "study.toml:12:"]);
    assert_eq!(told.matches("error: ").count(), 2, "{told}");
}

#[test]
fn what_is_no_study_at_all_is_refused() {
    let told = refused_with("scene = \"terzaghi\"", "scene = terzaghi");
    assert_snapshot("bad_input_not_toml", &told);
    assert_says(&refused_with("title = \"Sound\"\n", ""), &["`title` is missing", "add `title ="]);
    assert_says(&refused_study(""), &["is missing in the study"]);
    assert_says(&refused_study("# Heading\n\nSome *Markdown*, and no study.\n"), &["study.toml:3:", "^"]);
    assert_says(&refused_study([0_u8, 159, 146, 150, 255, 1, 2, 3]), &["study.toml", "UTF-8"]);
    let nested = format!("title = {}1{}\n", "[".repeat(5000), "]".repeat(5000));
    assert_says(&refused_study(nested), &["study.toml:1:"]);
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let folder = TempDir::new().expect("a folder");
    for command in ["run", "plan"] {
        let told = refused_in(folder.path(), &[command, "nowhere.toml"]);
        assert_says(&told, &["nowhere.toml", "no such file"]);
        let told = refused_in(folder.path(), &[command, "."]);
        assert_says(&told, &["the folder . contains no study", "oedometer new"]);
    }
    // A sound study beside a missing one: nothing of it is run.
    std::fs::write(folder.path().join("study.toml"), SOUND).expect("a file");
    refused_in(folder.path(), &["run", "study.toml", "nowhere.toml"]);
    assert!(!folder.path().join("out").exists());
}

#[test]
fn shards_and_numbers_of_jobs_that_are_none_are_refused() {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("study.toml"), SOUND).expect("a file");
    for shard in ["3/2", "0/2", "1/0", "1", "a/b", "1/2/3", "-1/2", ""] {
        let told = refused_in(folder.path(), &["run", "study.toml", &format!("--shard={shard}")]);
        assert_says(&told, &["is not a shard", "like 2/3"]);
    }
    for option in ["--jobs=0", "--jobs=-1", "--jobs=many", "--tier=big"] {
        refused_in(folder.path(), &["run", "study.toml", option]);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn assignments_are_judged_like_a_study() {
    let told = refused(&["solve", "terzaghi", "--set", "material.porosty=0.4"]);
    assert_snapshot("bad_input_set_misspelt_key", &told);
    for (assignment, parts) in [
        ("material.porosity", ["has no value", "KEY=VALUE"]),
        ("material.porosity=", ["`material.porosity`", "command line"]),
        ("=3", ["`` is not a key", "dotted key"]),
        ("a b=3", ["`a b` is not a key", "dotted key"]),
        ("material.porosity=1.4", ["`material.porosity` is 1.4", "between 0 and 1"]),
        ("material.porosity=nan", ["`material.porosity` is NaN", "between 0 and 1"]),
        ("material.law=elastic", ["no law is called `elastic`", "`log-linear`"]),
        ("column.load=-1", ["`column.load` is -1 Pa", "positive and finite"]),
        ("weather.rain=1", ["unknown key `weather`", "the keys here are"]),
        ("integrator.drag=1", ["`drag` takes a word in quotes", "command line"]),
    ] {
        for command in ["solve", "exact"] {
            let told = refused(&[command, "terzaghi", "--set", assignment]);
            // `exact` has the same lines at other numbers.
            let parts: Vec<&str> =
                if assignment.ends_with('=') { vec!["command line"] } else { parts.to_vec() };
            assert_says(&told, &parts);
        }
    }
}

#[test]
fn impossible_arguments_of_solve_are_refused() {
    for (arguments, parts) in [
        (&["tezaghi"][..], ["no scene is called `tezaghi`", "did you mean `terzaghi`?"]),
        (&["terzaghi", "--method", "FEM"], ["no method is called `FEM`", "`GC-SRI-patch`"]),
        (&["terzaghi", "--integrator", "rk4"], ["no integrator is called `rk4`", "`explicit`"]),
        (&["terzaghi", "--reference", "xie-leo"], ["no reference is called", "`terzaghi`"]),
        (&["terzaghi", "--cells", "0"], ["`cells` is 0", "between 1 and"]),
        (&["terzaghi", "--cells", "-10"], ["`cells` is -10", "between 1 and"]),
        (&["terzaghi", "--points-per-cell", "0"], ["`points_per_cell` is 0", "between 1 and"]),
        (&["terzaghi", "--time-factor", "-0.1"], ["a time factor of -0.1", "between 0 and 100"]),
        (&["terzaghi", "--time-factor", "nan"], ["a time factor of NaN", "between 0 and 100"]),
        (&["terzaghi", "--time-factor", "0.1,,0.2"], ["`` in", "is not a number"]),
        (&["terzaghi", "--time-factor", "soon"], ["`soon` in", "is not a number"]),
        (&["terzaghi", "--time-step", "stable=-1"], ["a time step of -1", "positive and finite"]),
        (&["terzaghi", "--time-step", "stable=0.5,seconds=1"], ["is not a step rule", "write stable=0.5"]),
        (&["terzaghi", "--time-step", "0.5"], ["`0.5` is not a step rule", "write stable=0.5"]),
        (
            &["terzaghi", "--time-step", "hours=1"],
            ["unknown key `hours`", "the keys here are courant, growth"],
        ),
        (&["terzaghi", "--format", "xml"], ["'xml'", "table, csv, json"]),
    ] {
        let mut all = vec!["solve"];
        all.extend(arguments);
        assert_says(&refused(&all), &parts);
    }
}

#[test]
fn impossible_arguments_of_exact_are_refused() {
    for (arguments, parts) in [
        (&["tezaghi"][..], ["there is no exact solution `tezaghi`", "terzaghi-incompressible"]),
        (&["terzaghi", "--zeta", "1.5"], ["relative depth must lie between 0", "got 1.5"]),
        (&["terzaghi", "--zeta", "nan"], ["relative depth must lie between 0", "got NaN"]),
        (&["terzaghi", "--zeta", "deep"], ["`deep` in", "is not a number"]),
        (&["terzaghi", "--time-factor", "-1"], ["time factor must be finite and not negative", "got -1"]),
        (&["terzaghi", "--time-factor", "inf"], ["time factor must be finite and not negative", "got inf"]),
        (&["mandel", "--x", "1.5"], ["distance x/a must lie between 0", "got 1.5"]),
        (&["mandel", "--zeta", "0.5"], ["depend on the distance from the middle", "--x"]),
        (&["terzaghi", "--x", "0.5"], ["depends only on depth", "`mandel`"]),
        (&["terzaghi", "--degree", "1.5"], ["degree of consolidation", "below 1"]),
        (&["terzaghi", "--degree", "0.5", "--time-factor", "1"], ["--degree", "cannot be used with"]),
    ] {
        let mut all = vec!["exact"];
        all.extend(arguments);
        assert_says(&refused(&all), &parts);
    }
    // A load under which the pores would close has no large-strain solution.
    let told = refused(&["exact", "xie-leo", "--set", "column.load=600e3"]);
    assert_says(&told, &["expel more water than the pores hold"]);
    let told = refused(&["exact", "xie-leo", "--set", "column.loading_time=3"]);
    assert_says(&told, &["load is sudden", "`large-strain`, whose load may grow"]);
}

#[test]
fn an_unknown_command_is_refused_with_the_nearest() {
    assert_says(&refused(&["slove"]), &["'slove'", "solve"]);
    assert_says(&refused(&["solve"]), &["SCENE"]);
}

#[test]
fn a_mesh_that_no_memory_holds_is_refused() {
    let told = refused(&["solve", "cosine-layer", "--cells", "4000", "--integrator", "implicit"]);
    assert_says(&told, &["4000 cells over the height", "GB of memory", "use fewer"]);
}
