//! `run` and `plan`: records and tidy CSV, resuming, shards, exit codes; the same bytes whatever
//! the number of jobs.

use crate::packs::{change_records, members, only_pack, records, tampered};
use crate::program::{Told, call, folder_with, table_without_times};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Eight short cases.
const STUDY: &str = r#"title = "Eight short cases"
scene = "terzaghi"

[output]
time_factors = [0.01, 0.02]

[[sweep]]
method = ["MPM", "GIMP-SRI", "GIMP-SRI-patch", "GC-SRI-patch"]
cells = [3, 4]
points_per_cell = [2]
time_step = [{ stable = 0.8 }]
"#;

/// A folder with a study in it and a place for its results.
struct Place {
    folder: TempDir,
}

impl Place {
    fn with(study: &str) -> Self {
        Self { folder: folder_with(study) }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn call(&self, arguments: &[&str]) -> Told {
        call(self.path(), arguments)
    }

    /// Runs the study; nothing of `run` is data.
    fn run(&self, options: &[&str]) -> Told {
        let told = self.call(&[&["run", "short.toml"], options].concat());
        assert_eq!(told.out, "");
        told
    }

    fn hashes_planned(&self) -> Vec<String> {
        let told = self.call(&["plan", "short.toml"]);
        assert_eq!(told.code, 0);
        assert!(told.err.contains(" cases: about "), "{}", told.err);
        let mut reader = csv::Reader::from_reader(told.out.as_bytes());
        let header = reader.headers().expect("a header").clone();
        let expected = ["study", "case", "estimated_point_updates", "label", "estimated_seconds"];
        assert_eq!(header.iter().collect::<Vec<_>>(), expected);
        reader.records().map(|row| row.expect("a row")[1].to_owned()).collect()
    }

    /// Every record by its hash, as text without wall times.
    fn records(&self, out: &str) -> BTreeMap<String, String> {
        records(&self.path().join(out), "short")
    }

    fn table(&self, out: &str) -> String {
        table_without_times(&self.path().join(out).join("short").join("short.csv"))
    }

    /// Values of one column of the tidy CSV.
    fn column(&self, out: &str, name: &str) -> Vec<String> {
        let table = self.table(out);
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let place = reader.headers().expect("a header").iter().position(|column| column == name);
        let place = place.unwrap_or_else(|| panic!("no column `{name}`"));
        reader.records().map(|row| row.expect("a row")[place].to_owned()).collect()
    }
}

fn sorted(mut words: Vec<String>) -> Vec<String> {
    words.sort();
    words.dedup();
    words
}

#[test]
fn a_run_leaves_one_record_a_case_and_one_tidy_table() {
    let place = Place::with(STUDY);
    let told = place.run(&[]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("short: 8 cases (0 reused, 0 failed)"), "{}", told.err);
    let planned = place.hashes_planned();
    assert_eq!(planned.len(), 8);
    let records = place.records("out");
    let stored: Vec<String> = records.keys().cloned().collect();
    assert_eq!(stored, sorted(planned.clone()), "`plan` and `run` agree on the hashes");
    for (hash, text) in &records {
        let record: serde_json::Value = serde_json::from_str(text).expect("JSON");
        assert_eq!(record["hash"], hash.as_str());
        assert_eq!(record["status"], "ok");
        for key in
            ["schema", "case", "counters", "groups", "start", "balance", "errors", "references", "provenance"]
        {
            assert!(!record[key].is_null(), "`{key}` is missing");
        }
        let folder = place.path().to_string_lossy();
        assert!(!text.contains(folder.as_ref()), "no absolute path in a record");
        assert!(!text.contains("wall"), "wall times change from day to day, a record does not");
    }
    assert_eq!(sorted(place.column("out", "case")), stored);
    let order = place.column("out", "case");
    let firsts: Vec<&String> = order.chunk_by(|a, b| a == b).map(|chunk| &chunk[0]).collect();
    assert_eq!(firsts, planned.iter().collect::<Vec<_>>(), "the table keeps the order of the study");
    // 8 cases × 2 times × 2 references × (27 errors of fields + the settlement).
    assert_eq!(order.len(), 8 * 2 * 2 * 28);
    assert!(place.column("out", "value").iter().all(|value| value.parse::<f64>().is_ok_and(f64::is_finite)));
    let files = fs::read_dir(place.path().join("out/short")).expect("a folder").flatten();
    assert!(!files.map(|file| file.file_name()).any(|name| name.to_string_lossy().contains(".part")));
}

#[test]
fn results_do_not_depend_on_the_number_of_jobs() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&["--jobs", "1", "--out", "one"]).code, 0);
    assert_eq!(place.run(&["--jobs", "2", "--out", "two"]).code, 0);
    assert_eq!(place.run(&["--jobs", "64", "--out", "many"]).code, 0);
    for out in ["two", "many"] {
        assert_eq!(place.records("one"), place.records(out), "{out}");
        assert_eq!(place.table("one"), place.table(out), "{out}");
    }
}

#[test]
fn resuming_takes_finished_records_and_runs_the_rest() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&[]).code, 0);
    let (records, table) = (place.records("out"), place.table("out"));
    let told = place.run(&["--resume"]);
    assert_eq!(told.code, 0);
    assert!(told.err.contains("8 cases (8 reused, 0 failed)"), "{}", told.err);
    assert_eq!(place.records("out"), records);
    // What is spoilt in any way is run again: one that is gone, garbage, half a record, nothing, that of another case.
    let (path, pack) = only_pack(&place.path().join("out"), "short");
    let all = members(&pack);
    let member = |number: usize| &pack[all[number].clone()];
    let mut garbage = member(1).to_vec();
    garbage[60..].fill(0xff);
    let half = &member(2)[..member(2).len() / 2];
    let (nothing, other) =
        (tampered(member(3), |_| String::new(), None), tampered(member(5), |text| text, Some(member(4))));
    let rest = &pack[all[5].start..];
    fs::write(path, [&garbage, half, &nothing, &other, rest].concat()).expect("written");
    let told = place.run(&["--resume"]);
    assert_eq!(told.code, 0);
    assert!(told.err.contains("8 cases (3 reused, 0 failed)"), "{}", told.err);
    assert_eq!(place.records("out"), records);
    assert_eq!(place.table("out"), table);
    // Without being asked to, nothing is taken up.
    let told = place.run(&[]);
    assert!(told.err.contains("(0 reused"), "{}", told.err);
}

#[test]
fn a_record_of_other_sources_or_of_an_older_layout_is_run_again() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&[]).code, 0);
    let records = place.records("out");
    change_records(&place.path().join("out"), "short", |number, record| match number {
        0 => record.provenance.sources = "other".to_owned(),
        1 => record.schema = 0,
        _ => {}
    });
    let told = place.run(&["--resume"]);
    assert!(told.err.contains("(6 reused"), "{}", told.err);
    assert_eq!(place.records("out"), records);
}

#[test]
fn a_resumed_run_follows_the_study_and_not_the_folder() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&[]).code, 0);
    // Same meaning in other words and another order: the same cases.
    let reworded =
        STUDY.replace("Eight", "8").replace("[0.01, 0.02]", "[0.02, 1e-2]").replace("[3, 4]", "[4, 3]");
    fs::write(place.path().join("short.toml"), reworded).expect("written");
    assert!(place.run(&["--resume"]).err.contains("(8 reused"));
    // Another load: other cases.
    let other = STUDY.replace("[output]", "[column]\nload = 2.0\n\n[output]");
    fs::write(place.path().join("short.toml"), other).expect("written");
    assert!(place.run(&["--resume"]).err.contains("8 cases (0 reused"));
}

#[test]
fn shards_part_the_cases_exactly() {
    let place = Place::with(STUDY);
    for count in [1, 2, 3] {
        let mut seen = Vec::new();
        for index in 1..=count {
            let out = format!("shard-{index}-of-{count}");
            let told = place.run(&["--shard", &format!("{index}/{count}"), "--out", &out]);
            let hashes: Vec<String> = place.records(&out).into_keys().collect();
            assert_eq!(told.code, 0, "an empty share is no failure: {}", told.err);
            seen.extend(hashes);
        }
        assert_eq!(seen.len(), 8, "no case twice");
        assert_eq!(sorted(seen), sorted(place.hashes_planned()), "no case missing");
    }
}

#[test]
fn a_failed_case_is_told_and_the_others_go_on() {
    let text =
        STUDY.replace("[{ stable = 0.8 }]", "[{ stable = 0.8 }, { stable = 1.2 }]").replace("[3, 4]", "[3]");
    let place = Place::with(&text);
    let told = place.run(&["--jobs", "2"]);
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(told.err.contains("8 cases (0 reused, 4 failed)"), "{}", told.err);
    let failures: Vec<&str> = told.err.lines().filter(|line| line.contains("unstable at step")).collect();
    assert_eq!(failures.len(), 4, "{}", told.err);
    assert!(failures.iter().all(|line| line.contains("stable=1.2") && line.contains("t = ")), "{}", told.err);
    assert_eq!(place.records("out").len(), 8, "a failed case has its record too");
    let (cases, statuses) = (place.column("out", "case"), place.column("out", "status"));
    let by_case: BTreeMap<&String, &String> = cases.iter().zip(&statuses).collect();
    assert_eq!(by_case.len(), 8);
    assert_eq!(by_case.values().filter(|status| **status == "unstable").count(), 4);
    assert_eq!(by_case.values().filter(|status| **status == "ok").count(), 4);
    // Resuming does not hide the failures.
    let told = place.run(&["--resume"]);
    assert_eq!(told.code, 3);
    assert!(told.err.contains("(8 reused, 4 failed)"), "{}", told.err);
}

#[test]
fn nothing_selected_is_exit_code_four() {
    let place = Place::with(&STUDY.replace("[[sweep]]\n", "[[sweep]]\ntier = \"full\"\n"));
    let told = place.run(&["--tier", "smoke"]);
    assert_eq!(told.code, 4, "{}", told.err);
    assert!(told.err.contains("this test level and shard contain no case"), "{}", told.err);
    assert_eq!(place.call(&["plan", "short.toml", "--tier", "ci"]).code, 4);
    assert_eq!(place.call(&["plan", "short.toml", "--tier", "full"]).code, 0);
}

#[test]
fn results_that_cannot_be_written_are_told() {
    let place = Place::with(STUDY);
    fs::write(place.path().join("out"), "a file in the way").expect("written");
    let told = place.run(&[]);
    assert!(told.code == 2 || told.code == 3, "exit code {}: {}", told.code, told.err);
    assert!(told.err.contains("error: cannot ") && told.err.contains("out"), "{}", told.err);
    assert_eq!(fs::read_to_string(place.path().join("out")).expect("the file"), "a file in the way");
}

#[test]
fn several_studies_run_at_once_each_to_its_own_table() {
    let place = Place::with(STUDY);
    let other = STUDY.replace("terzaghi", "single-mode").replace("[3, 4]", "[3]");
    fs::write(place.path().join("mode.toml"), other).expect("written");
    let told = place.call(&["run", "short.toml", "mode.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("short: 8 cases") && told.err.contains("mode: 4 cases"), "{}", told.err);
    let table = fs::read_to_string(place.path().join("out/mode/mode.csv")).expect("a table");
    assert!(table.lines().skip(1).all(|line| line.starts_with("mode,") && line.contains("single-mode")));
}

#[test]
fn a_plan_is_the_same_whatever_the_folder_and_has_every_shipped_study() {
    let (one, other) = (Place::with(STUDY), Place::with(STUDY));
    assert_eq!(one.hashes_planned(), other.hashes_planned());
    let told = one.call(&["plan", "--shipped"]);
    assert_eq!(told.code, 0);
    assert!(told.out.lines().skip(1).any(|line| line.starts_with("terzaghi-mesh,")));
    assert!(told.out.lines().skip(1).any(|line| line.starts_with("single-mode,")));
}

#[test]
fn a_later_run_of_less_takes_nothing_from_the_table() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&[]).code, 0);
    let whole = place.table("out");
    assert_eq!(place.run(&["--shard", "1/3"]).code, 0);
    assert_eq!(place.table("out"), whole, "a shard adds to the table");
    assert_eq!(place.run(&["--tier", "smoke"]).code, 4);
    assert_eq!(place.table("out"), whole, "nothing selected, nothing written");
    let fresh = place.run(&["--tier", "smoke", "--out", "fresh"]);
    assert_eq!(fresh.code, 4);
    assert!(!place.path().join("fresh").exists(), "nothing selected, nothing written");
}

#[test]
fn shards_into_one_folder_add_up_to_the_whole_table() {
    let place = Place::with(STUDY);
    assert_eq!(place.run(&["--out", "whole"]).code, 0);
    for shard in ["1/3", "2/3", "3/3"] {
        place.run(&["--shard", shard]);
    }
    assert_eq!(place.table("out"), place.table("whole"));
}
