//! `score`, `explain`, `merge`, `schema`, `completions` and `run --case` through the program.

use crate::packs::{change_records, members, only_pack, tampered};
use crate::program::{assert_snapshot, assert_words, call, folder_with, table_without_times};
use oedometer::Record;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

const STUDY: &str = r#"title = "Short"
scene = "terzaghi"
[output]
time_factors = [0.02]
[[sweep]]
method = ["MPM", "GC-SRI-patch"]
cells = [3, 4, 5]
"#;

fn place() -> TempDir {
    folder_with(STUDY)
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The example of the README, in the words that it shows.
#[test]
fn the_other_solver_of_the_examples_is_of_second_order_against_its_own_theory() {
    let folder = root().join("examples/other-solver");
    let files = ["column-10.csv", "column-20.csv", "column-40.csv"];
    let common = ["--scene", "terzaghi", "--mapping", "mapping.toml"];
    let told = call(&folder, &[&["score"], &files[..], &common, &["--cells", "10,20,40"]].concat());
    assert_eq!(told.code, 0, "{}", told.err);
    assert_snapshot("score_example", &format!("{}{}", told.out, told.err));
    let own = [&common[..], &["--reference", "terzaghi-incompressible", "--format", "csv"]].concat();
    let mut errors = Vec::new();
    for file in files {
        let told = call(&folder, &[&["score", file], &own[..]].concat());
        assert_eq!(told.code, 0, "{}", told.err);
        let row = told
            .out
            .lines()
            .find(|line| line.starts_with("0.1,pressure,nodes,l2,") || line.contains(",pressure,nodes,l2,"));
        errors
            .push(row.expect("a row").rsplit(',').next().expect("a value").parse::<f64>().expect("a number"));
    }
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.05, "{errors:?}");
    }
}

#[test]
fn a_score_can_be_a_gate() {
    let folder = root().join("examples/other-solver");
    let gate = |below: &str| {
        call(
            &folder,
            &["score", "column-20.csv", "--scene", "terzaghi", "--mapping", "mapping.toml", "--below", below],
        )
    };
    assert_eq!(gate("5e-3").code, 0);
    let told = gate("1e-4");
    assert_eq!(told.code, 1);
    assert!(told.err.contains("not below 1e-4"), "{}", told.err);
    assert_eq!(gate("-1").code, 2);
}

#[test]
fn what_solve_computes_scores_as_solve_says() {
    let folder = place();
    let told = call(
        folder.path(),
        &["exact", "terzaghi", "--time-factor", "0.1", "--zeta", "0.125,0.375,0.625,0.875"],
    );
    let mut rows = csv::Reader::from_reader(told.out.as_bytes());
    let mut text = "t,x,y,p,u_y\n".to_owned();
    for row in rows.records() {
        let row = row.expect("a row");
        let zeta: f64 = row[1].parse().expect("a number");
        let pressure: f64 = row[2].parse().expect("a number");
        writeln!(text, "8.175,0,{},{},0", 1.0 - zeta, 1.01 * pressure).expect("a line");
    }
    fs::write(folder.path().join("result.csv"), text).expect("a file");
    let told = call(folder.path(), &["score", "result.csv", "--scene", "terzaghi", "--format", "csv"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("no --mapping"), "what is taken for granted is told: {}", told.err);
    let header = told.out.lines().next().expect("a header");
    assert_eq!(header, "time_factor,quantity,sample,norm,reference,value");
    for norm in ["l1", "l2", "linf"] {
        let row = told.out.lines().find(|line| line.contains(&format!(",pressure,points,{norm},terzaghi,")));
        let value: f64 = row.expect("a row").rsplit(',').next().expect("a value").parse().expect("a number");
        assert!((value - 0.01).abs() < 1e-9, "one percent everywhere is one percent in {norm}: {value}");
    }
}

#[test]
fn a_bad_result_or_mapping_is_exit_code_two_with_its_place() {
    let folder = place();
    let score = |text: &str, options: &[&str]| {
        fs::write(folder.path().join("result.csv"), text).expect("a file");
        let told = call(folder.path(), &[&["score", "result.csv", "--scene", "terzaghi"], options].concat());
        assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
        told.err
    };
    assert!(score("t,x,y,p,u_y\n1,0,0.5,nan,0\n", &[]).contains("result.csv:2: `nan` in the column `p`"));
    assert!(score("t,x,y,p\n1,0,0.5,1\n", &[]).contains("no column `u_y`"));
    assert!(score("t,x,y,p,u_y\n1,0,500,1,0\n", &[]).contains("outside the column of 1 m"));
    assert!(score("t,x,y,p,u_y\n", &[]).contains("there are no rows"));
    assert!(score("", &[]).contains("empty"));
    fs::write(folder.path().join("map.toml"), "[columns]\ny = \"y\"\npp = \"p\"\n").expect("a file");
    let told = score("t,y,p\n1,0.5,1\n", &["--mapping", "map.toml"]);
    assert!(told.contains("map.toml:3:1") && told.contains("unknown key `pp`"), "{told}");
    assert!(score("t,x,y,p,u_y\n1,0,0.5,1,0\n", &["--cells", "10,20"]).contains("2 numbers for 1 results"));
}

#[test]
fn merged_shards_are_the_whole_and_holes_are_told() {
    let folder = place();
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml", "--out", "whole"]).code, 0);
    for shard in ["1/2", "2/2"] {
        let out = format!("part-{}", &shard[..1]);
        call(at, &["run", "short.toml", "--shard", shard, "--out", &out]);
    }
    let told = call(at, &["merge", "short.toml", "part-1", "--out", "merged"]);
    assert_eq!(told.code, 6, "{}", told.err);
    assert!(told.err.contains("no result of"), "{}", told.err);
    let merge = ["merge", "short.toml", "part-1", "part-2", "--out", "merged"];
    assert_eq!(call(at, &merge).code, 0);
    let table = |folder: &str| table_without_times(&at.join(folder).join("short/short.csv"));
    assert_eq!(table("merged"), table("whole"));
    let merged = || only_pack(&at.join("merged"), "short");
    let before = merged();
    assert_eq!(call(at, &merge).code, 0, "merging again changes nothing");
    assert!((table("merged"), merged()) == (table("whole"), before));
    assert_eq!(call(at, &["merge", "short.toml", "nowhere"]).code, 2);
    // A record that was changed by hand is no result, and takes nothing from those that are.
    let (path, pack) = only_pack(&at.join("part-1"), "short");
    let first = members(&pack).remove(0);
    let by_hand = tampered(&pack[first.clone()], |text| text.replacen("\"steps\":", "\"steps\":1", 1), None);
    fs::write(path, [&by_hand, &pack[first.end..]].concat()).expect("written");
    assert_eq!(call(at, &merge).code, 0);
    assert_eq!(table("merged"), table("whole"));
}

#[test]
fn sound_records_that_disagree_are_no_merge() {
    let folder = place();
    let at = folder.path();
    for out in ["one", "other"] {
        assert_eq!(call(at, &["run", "short.toml", "--out", out]).code, 0);
    }
    let merge = |out: &str| call(at, &["merge", "short.toml", "one", "other", "--out", out]);
    assert_eq!(merge("agreed").code, 0, "equal records from two folders are one record");
    // An error in the last digit, from a build that is not told apart by anything else.
    change_records(&at.join("other"), "short", |_, record| {
        record.errors[0].value = record.errors[0].value.next_up();
    });
    let told = merge("disagreed");
    assert_eq!(told.code, 6, "{}", told.err);
    assert!(told.err.contains("one/short and other/short have different results of"), "{}", told.err);
    assert!(told.err.contains("although both name the same program"), "{}", told.err);
    assert!(!at.join("disagreed/short/short.csv").exists(), "no table of results that nobody can trust");
    // The same numbers from other sources are another program's all the same.
    change_records(&at.join("other"), "short", |_, record| {
        record.errors[0].value = record.errors[0].value.next_down();
        record.provenance.sources = "0123456789abcdef".to_owned();
    });
    assert_eq!(merge("of-two-builds").code, 6);
    // What is merged already is held against what comes: nothing overwrites it.
    let before = table_without_times(&at.join("agreed/short/short.csv"));
    assert_eq!(merge("agreed").code, 6);
    assert_eq!(table_without_times(&at.join("agreed/short/short.csv")), before);
}

#[test]
fn one_case_can_be_explained_and_run_again() {
    let folder = place();
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml"]).code, 0);
    let before = table_without_times(&at.join("out/short/short.csv"));
    let told = call(at, &["explain", "GC-SRI-patch cells=4", "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.out.contains("worst at ζ") && told.out.contains("cells=4"), "{}", told.out);
    assert!(told.err.contains("no golden values"), "{}", told.err);
    let command =
        told.err.lines().find_map(|line| line.strip_prefix("run it again: oedometer ")).expect("a command");
    let arguments: Vec<&str> = command.split(' ').collect();
    let again = call(at, &arguments);
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(again.err.contains("short: 1 case (0 reused"), "{}", again.err);
    assert_eq!(table_without_times(&at.join("out/short/short.csv")), before, "the table keeps the others");
    let several = call(at, &["explain", "cells=4", "short.toml"]);
    assert_eq!(several.code, 2);
    assert!(several.err.contains("matches 2 cases"), "{}", several.err);
    assert_eq!(call(at, &["explain", "cells=77", "short.toml"]).code, 4);
}

#[test]
fn an_explanation_says_what_changed_against_the_golden_values() {
    use oedometer::{GoldenFile, RunOptions, Study, StudySource, Tier, run_study};
    let folder = place();
    let source = StudySource { name: "short.toml".to_owned(), text: STUDY.to_owned() };
    let study = Study::check(&source).expect("sound");
    let options = RunOptions::whole(Tier::Ci, 1);
    let mut golden =
        GoldenFile::of("short", &run_study(&study, &options, None, &|_| {}).records, "for a test");
    let name = "MPM explicit cells=4 points=2 stable=0.8 | pressure centres terzaghi T_v=0.02";
    let found = golden.values.iter_mut().find(|(key, _)| key.to_string() == name);
    *found.expect("a value").1 *= 0.9;
    golden.write(&folder.path().join("golden")).expect("written");
    let told = call(folder.path(), &["explain", name, "short.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("1 values differ from the golden ones"), "{}", told.err);
    assert!(told.out.contains("moved") && told.out.contains(name), "{}", told.out);
    let first = told.out.lines().nth(2).unwrap_or_default().split_whitespace().take(2);
    assert_eq!(first.collect::<Vec<_>>(), ["pressure", "centres"], "it is about that value: {}", told.out);
    assert_words("explain_changed", &told.out);
    let other = call(folder.path(), &["explain", "MPM cells=5", "short.toml"]);
    assert!(other.err.contains("golden values of the case agree"), "{}", other.err);
}

/// The kernel that visits every point rounds everywhere else: what it gives agrees within tolerances that
/// were derived from last digits alone.
#[test]
fn tolerances_from_last_digits_hold_for_another_kernel() {
    use oedometer::{
        GoldenFile, Kernel, LastDigit, Study, StudySource, Tier, compare, run_case, spread_by_group,
        values_of,
    };
    let source = StudySource { name: "short.toml".to_owned(), text: STUDY.to_owned() };
    let study = Study::check(&source).expect("sound");
    let records_by = |study: &Study, kernel: Kernel| -> Vec<Record> {
        let run = |case| run_case(case, &study.references, kernel, true, &|_, _| true).expect("a record");
        study.cases(Tier::Ci).into_iter().map(run).collect()
    };
    let perturbed =
        LastDigit::ALL.map(|digit| values_of(&records_by(&study.perturbed(digit), Kernel::Fastest)));
    let golden = GoldenFile::of("short", &records_by(&study, Kernel::Fastest), "for a test");
    let spread = spread_by_group(&golden.values, &perturbed);
    assert!(!spread.is_empty(), "last digits move something");
    let golden = golden.widened_by(spread);
    assert_eq!(compare(&golden, &values_of(&records_by(&study, Kernel::PointWise))), []);
    // And they are narrow: ten times as far in one place is seen there and nowhere else.
    for key in golden.values.keys() {
        let mut values = golden.values.clone();
        let value = values.get_mut(key).expect("a value");
        *value += 10.0 * golden.tolerance(key, value.abs());
        let places: Vec<_> = compare(&golden, &values).into_iter().map(|one| one.key).collect();
        assert_eq!(places, std::slice::from_ref(key));
    }
}

#[test]
fn schemas_and_completions_are_printed() {
    let folder = place();
    for document in ["study", "record", "mapping"] {
        let told = call(folder.path(), &["schema", document]);
        let schema: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
        assert_eq!(schema["type"], "object", "{document}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let told = call(folder.path(), &["completions", shell]);
        assert!(told.code == 0 && told.out.contains("explain"), "{shell}");
    }
    assert_eq!(call(folder.path(), &["completions", "sh"]).code, 2);
}

#[test]
fn help_reads_as_a_terminal_shows_it() {
    let folder = place();
    let commands = [
        "run",
        "report",
        "check",
        "accept",
        "exact",
        "solve",
        "score",
        "stability",
        "plan",
        "merge",
        "explain",
    ];
    for command in commands {
        let told = call(folder.path(), &[command, "--help"]);
        assert!(told.code == 0 && told.out.contains("Usage: "), "{command}: {}", told.err);
        assert!(!told.out.contains('`'), "{command}: {}", told.out);
    }
    assert!(call(folder.path(), &["check", "--help"]).out.contains("$GITHUB_STEP_SUMMARY"));
}
