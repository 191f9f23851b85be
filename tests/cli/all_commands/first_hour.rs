//! The first hour of a new user: a study of one's own, a soft soil, a shipped study by its name.

use crate::program::{call, folder_with};
use flate2::read::MultiGzDecoder;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Command;

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
    assert_eq!(call(at, &["new", "studies/gate"]).code, 0, "docs/ci.md begins so");
    fs::remove_dir_all(at.join("studies")).expect("removed");
    let told = call(at, &["check", "my-study.toml"]);
    assert!(told.out.contains("1 of 1 expectations met"), "{}{}", told.out, told.err);
    // At large strain, and in the plane.
    for (name, scene, met) in [
        ("large", "xie-leo", "2 of 2"),
        ("plane", "cosine-layer", "4 of 4"),
        ("plate", "footing", "3 of 3"),
        ("soils", "layered", "1 of 1"),
    ] {
        assert_eq!(call(at, &["new", name, "--scene", scene]).code, 0);
        let told = call(at, &["check", &format!("{name}.toml")]);
        assert!(told.out.contains(&format!("{met} expectations met")), "{scene}: {}{}", told.out, told.err);
    }
    let told = call(at, &["new", "slab", "--scene", "mandel"]);
    assert!(told.code == 2 && told.err.contains("list --show mandel"), "{}", told.err);
    let told = call(at, &["new", "slab", "--scene", "mandle"]);
    assert!(told.code == 2 && told.err.contains("no starter for `mandle`"), "{}", told.err);
    let again = call(at, &["new", "my-study"]);
    assert!(again.code == 2 && again.err.contains("already exists"), "{}", again.err);
    assert_eq!(call(at, &["new", "My Study"]).code, 2);
}

#[test]
fn the_natural_study_of_a_soft_soil_ends_in_seconds_and_who_names_explicit_is_warned() {
    let folder = folder_with(SOFT);
    let at = folder.path();
    let told = call(at, &["run", "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("no integrator is given") && told.err.contains("is used"), "{}", told.err);
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
    let own = include_str!("../../../studies/stability-slow-growth.toml");
    assert_eq!((shown.code, shown.out.as_str()), (0, own));
    let told = call(at, &["plan", "stability-slow-growth"]);
    assert!(told.code == 0 && told.out.contains("stability-slow-growth,"), "{}", told.err);
    let told = call(at, &["plan", "terzaghi-mehs"]);
    assert!(told.code == 2 && told.err.contains("did you mean `terzaghi-mesh`?"), "{}", told.err);
}

/// Says why a test proves nothing here.
#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
fn skipped(why: &str) {
    eprintln!("skipped: {why}");
}

/// A python that has pandas, if there is one: that of the environment, or the one on the path.
fn python_with_pandas() -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let asked = Command::new(&python).args(["-c", "import numpy, pandas"]).output();
    asked.is_ok_and(|output| output.status.success()).then_some(python)
}

#[test]
fn the_examples_of_pandas_print_what_the_manual_shows() {
    let Some(python) = python_with_pandas() else {
        return skipped("no python3 with pandas here (PYTHON names one)");
    };
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = folder.path();
    call(at, &["new", "my-study"]);
    assert_eq!(call(at, &["run", "my-study.toml"]).code, 0);
    let manual = include_str!("../../../docs/csv.md");
    let fences: Vec<&str> = manual.split("```").collect();
    let mut run = 0;
    for place in (0..fences.len()).filter(|place| fences[*place].starts_with("python\n")) {
        let output = Command::new(&python)
            .args(["-c", &fences[place]["python\n".len()..]])
            .current_dir(at)
            .output()
            .expect("python");
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let printed = String::from_utf8_lossy(&output.stdout);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(words(&printed), words(fences[place + 2]), "{printed}{told}");
        run += 1;
    }
    assert_eq!(run, 1);
}

#[test]
fn compressed_tables_have_the_text_of_the_plain_ones() {
    let folder = folder_with(SOFT);
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml"]).code, 0);
    let plain = fs::read(at.join("out/short/profiles.csv")).expect("a table");
    assert_eq!(call(at, &["run", "short.toml", "--resume", "--compress"]).code, 0);
    assert!(!at.join("out/short/short.csv").exists(), "one form of a table is left");
    let packed = fs::read(at.join("out/short/profiles.csv.gz")).expect("a table");
    let mut text = Vec::new();
    MultiGzDecoder::new(packed.as_slice()).read_to_end(&mut text).expect("gzip");
    assert_eq!(text, plain);
}

#[test]
fn a_change_of_a_percent_is_seen_by_golden_values_of_swept_soils() {
    let study = SOFT.replace("youngs_modulus = 0.2e6\n", "").replace(
        "cells = [5, 10]",
        "integrator = [\"implicit\"]\ncells = [5, 10]\nyoungs_modulus = [0.2e6, 1e6]",
    );
    let folder = folder_with(&study);
    let at = folder.path();
    let told = call(at, &["plan", "short.toml"]);
    assert!(
        told.out.contains("youngs_modulus=200000") && told.out.contains("youngs_modulus=1000000"),
        "{}",
        told.out
    );
    let told = call(at, &["explain", "cells=10 youngs_modulus=200000", "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
}

#[test]
fn geometry_is_swept_and_labels_tell_it() {
    let study = SOFT.replace("cells = [5, 10]", "cells = [5, 10]\nheight = [1.0, 2.0]\nload = [1.0, 10.0]");
    let folder = folder_with(&study);
    let told = call(folder.path(), &["run", "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let table = fs::read_to_string(folder.path().join("out/short/short.csv")).expect("a table");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().expect("a head").clone();
    let place = |name: &str| header.iter().position(|column| column == name).expect(name);
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    // In T_v a linear column knows neither its height nor its load.
    let error = |height: &str, load: &str| {
        let is = |row: &&csv::StringRecord| {
            [("height", height), ("load", load), ("cells", "10"), ("quantity", "pressure"), ("norm", "l2")]
                .iter()
                .all(|(name, value)| &row[place(name)] == *value)
        };
        rows.iter().find(is).map(|row| row[place("value")].parse::<f64>().expect("a number")).expect("a row")
    };
    let first = error("1", "1");
    for (height, load) in [("1", "10"), ("2", "1"), ("2", "10")] {
        assert!((error(height, load) / first - 1.0).abs() < 1e-6, "{height} {load}");
    }
    let refused = SOFT.replace("cells = [5, 10]", "cells = [5]\nlength = [1.0]");
    let folder = folder_with(&refused);
    let told = call(folder.path(), &["plan", "short.toml"]);
    assert!(told.code == 2 && told.err.contains("`terzaghi` has no `length`"), "{}", told.err);
    let unnamed = SOFT.replace("cells = [5, 10]", "cells = [5, 10]\nheight = [1.0, 2.0]")
        + "[[expect]]\ntime_factor = 0.1\nat = { cells = 10, below = 1 }\n";
    let told = call(folder_with(&unnamed).path(), &["plan", "short.toml"]);
    assert!(told.code == 2 && told.err.contains("several heights"), "{}", told.err);
}

/// What a shell would be offered for a line.
fn offered(at: &Path, words: &[&str]) -> String {
    let script = "source ./completions; COMP_WORDS=(oedometer \"$@\"); COMP_CWORD=$#; \
                  _oedometer oedometer \"${@: -1}\" \"${COMP_WORDS[COMP_CWORD-1]}\"; echo \"${COMPREPLY[@]}\"";
    let output =
        Command::new("bash").args(["--norc", "-c", script, "bash"]).args(words).current_dir(at).output();
    String::from_utf8_lossy(&output.expect("bash").stdout).trim().to_owned()
}

#[test]
fn bash_offers_options_scenes_and_methods() {
    if Command::new("bash").arg("--version").output().is_err() {
        return skipped("no bash here");
    }
    let folder = folder_with(SOFT);
    let at = folder.path();
    fs::write(at.join("completions"), call(at, &["completions", "bash"]).out).expect("a file");
    assert_eq!(offered(at, &["check", "--jo"]), "--jobs");
    assert_eq!(offered(at, &["list", "--show", "any-s"]), "any-soil");
    assert_eq!(offered(at, &["solve", "cos"]), "cosine-layer");
    assert_eq!(offered(at, &["exact", "mand"]), "mandel");
    assert_eq!(offered(at, &["solve", "terzaghi", "--method", "GC-B"]), "GC-Bbar-patch GC-Bbar-patch-cells");
    assert!(call(at, &["completions", "zsh"]).out.contains("cosine-layer"));
}

#[test]
fn every_help_fits_a_terminal_and_has_no_marks_of_the_source() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let commands = call(folder.path(), &["--help"]).out;
    let names = commands
        .lines()
        .take_while(|line| *line != "Options:")
        .filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    let mut seen = 0;
    for name in names {
        let help = call(folder.path(), &[name, "--help"]).out;
        for line in help.lines().chain(commands.lines()) {
            assert!(line.chars().count() <= 80, "{name}: {line}");
            assert!(!line.contains('`') && !line.contains("]("), "{name}: {line}");
        }
        seen += 1;
    }
    assert!(seen >= 19, "{seen} commands");
}

#[test]
fn mistakes_at_the_command_line_are_answered_with_what_to_type() {
    let folder = folder_with(SOFT);
    let at = folder.path();
    fs::create_dir(at.join("empty")).expect("a folder");
    for (typed, parts) in [
        (&["check", "short"][..], &["did you mean the file `short.toml`?"][..]),
        (&["check", "shrt.toml"], &["did you mean `short.toml`?"]),
        (&["check", "terzaghi-mesh.toml"], &["the built-in study is called `terzaghi-mesh`"]),
        (&["run", "empty"], &["the folder empty contains no study"]),
        (&["run", "nothing-like-it"], &["`oedometer new NAME`"]),
        (&["run", "short.toml", "--case", "zzz"], &["no case has a hash that begins with `zzz`"]),
        (&["explain", "zzz", "short.toml"], &["no case of `short` matches `zzz`"]),
        (&["solve", "terzaghi", "--cells", "ten"], &["invalid digit found in string"]),
        (&["solve", "terzaghi", "--method", "mpm"], &["did you mean `MPM`?", "`oedometer list` has all"]),
        (&["solve", "terzaghi", "--set", "porosity=0.4"], &["belongs to [material]", "material.porosity"]),
        (&["score", "none.csv", "--scene", "terzaghi"], &["none.csv: No such file or directory\n"]),
    ] {
        let told = call(at, typed);
        assert!(told.code == 2 || told.code == 4, "{typed:?}: {}", told.code);
        for part in parts {
            assert!(told.err.contains(part), "{typed:?}: no `{part}` in {}", told.err);
        }
        for word in ["os error", "expected", "literal"] {
            assert!(!told.err.contains(word), "{typed:?}: `{word}` in {}", told.err);
        }
    }
}
