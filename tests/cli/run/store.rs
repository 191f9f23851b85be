//! What is kept and taken together: names of studies, origins of records, sweeps that are too large, a disk
//! that is full, a reference that refuses; and the list of faults that these tests are held against.

use crate::packs::change_records;
use crate::program::{PROGRAM, Told, call, folder_with, table_without_times};
use oedometer::exact::reference::ReferenceKind;
use oedometer::{
    CheckEnd, Failure, FailureKind, GoldenFile, Origins, RecordStore, RunOptions, Selected, Status, Study,
    StudyCheck, StudySource, Tier, run_studies, run_study,
};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Eight short cases.
const STUDY: &str = r#"title = "Eight short cases"
scene = "terzaghi"

[output]
time_factors = [0.01, 0.02]

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
cells = [3, 4, 5, 6]
time_step = [{ stable = 0.8 }]
"#;

/// A load that grows within a microsecond, held against its reference long after it and within it: there
/// the reference does not converge, and says so.
const REFUSING: &str = r#"title = "Refusing"
scene = "xie-leo"

[column]
loading_time = 1.0e-6

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [2]
time_step = [{ growth = 0.5 }]
time_factors = [1.0e-8]

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [3]
time_step = [{ growth = 0.5 }]
time_factors = [0.1]
"#;

fn study() -> Study {
    Study::check(&StudySource { name: "short.toml".to_owned(), text: STUDY.to_owned() }).expect("sound")
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() { files.extend(files_below(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

fn provenance_of(results: &Path) -> Vec<oedometer::Provenance> {
    let store = RecordStore::new(results, "short");
    study().cases(Tier::Full).into_iter().filter_map(|case| store.origin(case)).collect()
}

// ---- names ----

#[test]
fn a_name_that_is_not_plain_is_refused_before_any_work() {
    let folder = folder_with(STUDY);
    let at = folder.path().join("inner");
    fs::create_dir(&at).expect("a folder");
    for name in ["...toml", ".toml", "profiles.toml"] {
        fs::write(at.join(name), STUDY).expect("a file");
        for command in
            [&["run", name, "--out", "out"][..], &["report", name], &["check", name], &["plan", name]]
        {
            let before = files_below(folder.path());
            let Told { code, out, err } = call(&at, command);
            assert_eq!((code, out.as_str()), (2, ""), "{command:?}: {err}");
            assert!(err.starts_with(&format!("error: the study {name} cannot be called `")), "{err}");
            assert_eq!(files_below(folder.path()), before, "{command:?} leaves nothing behind");
        }
        fs::remove_file(at.join(name)).expect("removed");
    }
}

#[test]
fn two_studies_of_one_name_are_refused_with_both_paths() {
    let folder = folder_with(STUDY);
    fs::create_dir(folder.path().join("other")).expect("a folder");
    fs::write(folder.path().join("other/short.toml"), STUDY).expect("a file");
    for command in ["run", "report", "check", "plan", "merge"] {
        let told = call(folder.path(), &[command, "short.toml", "other/short.toml", "other"]);
        let told = if command == "merge" {
            told
        } else {
            call(folder.path(), &[command, "short.toml", "other/short.toml"])
        };
        // A check judges the first of them.
        assert!(
            told.code == 2 && (command == "check" || told.out.is_empty()),
            "{command}: {}{}",
            told.out,
            told.err
        );
        assert!(told.err.contains("short.toml and other/short.toml are both called `short`"), "{}", told.err);
        assert!(!folder.path().join("out").exists(), "{command}");
    }
    // Accepting would overwrite golden values.
    let accept = ["accept", "short.toml", "other/short.toml", "--reason", "a test"];
    assert_eq!(call(folder.path(), &accept).code, 2);
    assert!(!folder.path().join("golden").exists());
}

#[cfg(unix)]
#[test]
fn a_study_comes_from_a_pipe_and_never_from_what_does_not_end() {
    let folder = folder_with(STUDY);
    let told = call(folder.path(), &["plan", "/dev/zero"]);
    assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
    assert!(
        told.err.contains("the study /dev/zero: it is not a regular file: a device or a pipe may never end"),
        "{}",
        told.err
    );
    let made = Command::new("mkfifo").arg(folder.path().join("pipe.toml")).status().expect("mkfifo");
    assert!(made.success());
    let told = call(folder.path(), &["plan", "pipe.toml"]);
    assert!(told.code == 2 && told.err.contains("a device or a pipe may never end"), "{}", told.err);
    let large = format!("{STUDY}# {}", "x".repeat(16_000_000));
    fs::write(folder.path().join("large.toml"), large).expect("a file");
    assert_eq!(call(folder.path(), &["plan", "large.toml"]).code, 2);
    let mut command = Command::new(PROGRAM);
    let mut child = command
        .args(["plan", "/dev/stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    child.stdin.take().expect("a pipe").write_all(STUDY.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 9);
}

// ---- sweeps ----

fn listed(count: usize, value: impl Fn(usize) -> String) -> String {
    let values: Vec<String> = (0..count).map(value).collect();
    format!("[{}]", values.join(", "))
}

fn refusal_of(sweeps: &str) -> String {
    let text = format!("title = \"Large\"\nscene = \"terzaghi\"\n{sweeps}");
    let folder = folder_with(&text);
    let told = call(folder.path(), &["plan", "short.toml"]);
    assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
    told.err
}

#[test]
fn a_sweep_of_too_many_cases_is_refused_at_its_line_and_never_made() {
    let axis = |key: &str, count: usize, value: &dyn Fn(usize) -> String| {
        format!("{key} = {}\n", listed(count, value))
    };
    let small = |i: usize| format!("{:.4}", 0.1 + 1e-4 * i as f64);
    let whole = |i: usize| (i + 1).to_string();
    let mut wraps = "[[sweep]]\nmethod = [\"MPM\"]\n".to_owned() + &axis("cells", 256, &whole);
    for key in
        ["porosity", "poissons_ratio", "flip", "offset", "hydraulic_conductivity", "water_bulk_modulus"]
    {
        wraps += &axis(key, 256, &small);
    }
    wraps += &axis("mapping_back", 256, &|_| "true".to_owned());
    let told = refusal_of(&wraps);
    assert!(told.contains("short.toml:3:1") && told.contains("more cases than can be counted"), "{told}");
    let mut billion = "[[sweep]]\nmethod = [\"MPM\"]\n".to_owned() + &axis("cells", 1000, &whole);
    billion += &(axis("porosity", 1000, &small) + &axis("hydraulic_conductivity", 1000, &small));
    let told = refusal_of(&billion);
    assert!(told.contains("has 1000000000 cases"), "{told}");
    assert!(told.contains("a study has at most 1000000"), "{told}");
}

#[test]
fn sweeps_are_counted_together() {
    let mut text = String::new();
    for key in ["porosity", "flip"] {
        let small = listed(1000, |i| format!("{:.4}", 0.1 + 1e-4 * i as f64));
        let cells = listed(if key == "flip" { 1000 } else { 1 }, |i| (i + 1).to_string());
        writeln!(text, "[[sweep]]\nmethod = [\"MPM\"]\ncells = {cells}\n{key} = {small}").expect("a line");
    }
    let told = refusal_of(&text);
    assert!(told.contains("short.toml:7:1"), "the sweep that is too much: {told}");
    assert!(told.contains("1000000 cases, with 1000 of the sweeps before it"), "{told}");
}

#[test]
fn a_case_of_two_sweeps_is_one_of_the_smaller_tier() {
    let sweep = |tier: &str, cells: &str| {
        format!("[[sweep]]\nmethod = [\"MPM\"]\ncells = {cells}\noffset = [0.0, -0.0]\ntier = \"{tier}\"\n")
    };
    let text = format!(
        "title = \"Twice\"\nscene = \"terzaghi\"\n{}{}{}",
        sweep("ci", "[3, 4]"),
        sweep("smoke", "[4, 5]"),
        sweep("full", "[3, 6]")
    );
    let study = Study::check(&StudySource { name: "twice.toml".to_owned(), text }).expect("sound");
    let tiers: Vec<(usize, Tier)> =
        study.planned.iter().map(|planned| (planned.case.cells, planned.tier)).collect();
    assert_eq!(tiers, [(3, Tier::Ci), (4, Tier::Smoke), (5, Tier::Smoke), (6, Tier::Full)]);
}

#[test]
fn the_estimated_work_of_every_shipped_study_can_be_added_up() {
    let folder = folder_with(STUDY);
    let told = call(folder.path(), &["plan", "--shipped"]);
    let mut sums: BTreeMap<String, u64> = BTreeMap::new();
    for row in csv::Reader::from_reader(told.out.as_bytes()).records() {
        let row = row.expect("a row");
        let updates: u64 = row[2].parse().expect("a number");
        let sum = sums.entry(row[0].to_owned()).or_default();
        *sum = sum.checked_add(updates).expect("no overflow");
    }
    assert!(sums.len() > 40 && sums.values().all(|sum| *sum < 1_000_000_000_000_000), "{sums:?}");
}

// ---- what is run and what is taken up ----

#[test]
fn an_empty_case_is_no_case() {
    let folder = folder_with(STUDY);
    for hash in ["", " "] {
        let told = call(folder.path(), &["run", "short.toml", "--case", hash]);
        assert_eq!(told.code, 2, "{}", told.err);
        assert!(told.err.contains("`--case` needs a hash"), "{}", told.err);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_key_of_solve_has_its_effect_or_is_refused() {
    let folder = folder_with(STUDY);
    let long = ["solve", "terzaghi", "--cells", "40", "--time-factor", "10", "--point-wise"];
    let told = call(folder.path(), &[&long[..], &["--set", "case_seconds=0.05"]].concat());
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(told.err.contains("the case failed (timed-out)") && told.err.contains("0.05 s"), "{}", told.err);
    for (command, key) in [
        (&["solve", "terzaghi"][..], "task=stability"),
        (&["solve", "terzaghi"], "timing.repeats=3"),
        (&["stability", "terzaghi"], "timing.repeats=3"),
        (&["exact", "terzaghi", "--time-factor", "0.1", "--zeta", "0.5"], "case_seconds=1"),
        (&["score", "none.csv", "--scene", "terzaghi"], "task=stability"),
    ] {
        let told = call(folder.path(), &[command, &["--set", key]].concat());
        let key = key.split('=').next().expect("a key");
        assert_eq!(told.code, 2, "{command:?}: {}", told.err);
        assert!(told.err.contains(&format!("`--set {key}` has no effect here")), "{}", told.err);
    }
}

#[test]
fn resuming_runs_cases_of_other_sources_again_and_says_how_many() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml"]).code, 0);
    let table = table_without_times(&at.join("out/short/short.csv"));
    change_records(&at.join("out"), "short", |number, record| match number {
        0 | 1 => record.provenance.sources = "0123456789abcdef".to_owned(),
        2 => record.provenance.version = "0.0.1".to_owned(),
        _ => {}
    });
    let told = call(at, &["run", "short.toml", "--resume"]);
    assert_eq!(told.code, 0);
    assert!(told.err.contains("8 cases (5 reused"), "{}", told.err);
    let sentence = "short: not reused, so run again: 3 records of another version or of other sources";
    assert!(told.err.contains(sentence), "{}", told.err);
    assert_eq!(table_without_times(&at.join("out/short/short.csv")), table);
    let told = call(at, &["run", "short.toml", "--resume"]);
    assert!(told.err.contains("(8 reused") && !told.err.contains("not reused"), "{}", told.err);
}

#[test]
fn resuming_takes_up_records_of_another_build_and_says_so_without_their_wall_times() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml", "--jobs", "1"]).code, 0);
    change_records(&at.join("out"), "short", |number, record| match number {
        0 | 1 => record.provenance.profile = "another".to_owned(),
        2 => record.provenance.compiler = "rustc 0.0.0".to_owned(),
        _ => {}
    });
    let told = call(at, &["run", "short.toml", "--resume"]);
    assert_eq!(told.code, 0);
    assert!(told.err.contains("8 cases (8 reused"), "{}", told.err);
    let lines: Vec<&str> = told.err.lines().filter(|line| line.contains("other builds")).collect();
    assert_eq!(lines.len(), 1, "{}", told.err);
    assert!(lines[0].contains("compiler `rustc 0.0.0` in 1 instead of"), "{}", lines[0]);
    assert!(lines[0].contains("profile `another` in 2 instead of"), "{}", lines[0]);
    let store = RecordStore::new(&at.join("out"), "short");
    let timed = |case| store.finished(case).expect("a record").wall.len();
    let walls: usize = study().cases(Tier::Full).into_iter().map(timed).sum();
    assert_eq!(walls, 5, "a time is of the build that took it");
}

#[test]
fn a_case_that_was_late_is_run_again() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml"]).code, 0);
    change_records(&at.join("out"), "short", |number, record| {
        if number == 4 {
            record.status = Status::Failed(Failure {
                kind: FailureKind::TimedOut,
                step: 1,
                time: 1.0,
                growth: None,
                reason: "late".to_owned(),
            });
        }
    });
    let told = call(at, &["run", "short.toml", "--resume"]);
    assert!(told.code == 0 && told.err.contains("8 cases (7 reused, 0 failed)"), "{}", told.err);
}

/// The profile is the folder that cargo builds it in; `PROFILE` of a build script knows two only.
#[test]
fn a_program_names_its_own_profile() {
    let folder = Path::new(PROGRAM)
        .parent()
        .and_then(Path::file_name)
        .expect("a folder")
        .to_string_lossy()
        .into_owned();
    let place = folder_with(STUDY);
    assert_eq!(call(place.path(), &["run", "short.toml"]).code, 0);
    assert!(
        provenance_of(&place.path().join("out")).iter().all(|origin| origin.profile == folder),
        "{folder}"
    );
}

// ---- merge ----

/// Two disjoint shares of the study, in `one` and `two`.
fn shares(at: &Path) {
    for (shard, out) in [("1/2", "one"), ("2/2", "two")] {
        assert_eq!(call(at, &["run", "short.toml", "--shard", shard, "--out", out]).code, 0);
    }
}

#[test]
fn shards_of_other_sources_are_no_merge_though_they_are_disjoint() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    shares(at);
    let (ones, twos) = (provenance_of(&at.join("one")).len(), provenance_of(&at.join("two")).len());
    assert!(ones > 0 && twos > 0 && ones + twos == 8, "{ones} and {twos}");
    change_records(&at.join("two"), "short", |_, record| {
        record.provenance.sources = "0123456789abcdef".to_owned();
    });
    let told = call(at, &["merge", "short.toml", "one", "two", "--out", "merged"]);
    assert_eq!(told.code, 6, "{}", told.err);
    assert!(told.err.contains("the records come from several programs"), "{}", told.err);
    assert!(told.err.contains(&format!("{ones} of version")), "{}", told.err);
    assert!(
        told.err.contains(&format!("{twos} of version")) && told.err.contains("0123456789abcdef"),
        "{}",
        told.err
    );
    assert!(!at.join("merged").exists(), "nothing is written");
}

#[test]
fn shards_of_several_builds_are_one_merge_that_says_so() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    shares(at);
    let twos = provenance_of(&at.join("two")).len();
    let merge = |out: &str| call(at, &["merge", "short.toml", "one", "two", "--out", out]);
    let told = merge("same");
    assert!(told.code == 0 && !told.err.contains("builds"), "one build is nothing to tell: {}", told.err);
    change_records(&at.join("two"), "short", |_, record| record.provenance.target = "elsewhere".to_owned());
    let told = merge("merged");
    assert_eq!(told.code, 0, "{}", told.err);
    let lines: Vec<&str> = told.err.lines().filter(|line| line.contains("several builds")).collect();
    assert_eq!(lines.len(), 1, "{}", told.err);
    let named = lines[0].contains("target `elsewhere` in") || lines[0].contains("instead of `elsewhere`");
    assert!(named && (1..8).contains(&twos), "{}", lines[0]);
    let table = |out: &str| table_without_times(&at.join(out).join("short/short.csv"));
    assert_eq!(table("merged"), table("same"));
}

// ---- the table ----

#[test]
fn every_column_of_the_table_is_what_the_record_says() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    assert_eq!(call(at, &["run", "short.toml"]).code, 0);
    let table = table_without_times(&at.join("out/short/short.csv"));
    let mut rows = csv::Reader::from_reader(table.as_bytes()).into_records();
    let store = RecordStore::new(&at.join("out"), "short");
    for case in study().cases(Tier::Full) {
        let record = store.kept(case).expect("a record");
        for error in &record.errors {
            let row = rows.next().expect("a row").expect("a row");
            let number = |column: usize| row[column].parse::<f64>().expect("a number");
            let words = [&row[0], &row[1], &row[2], &row[3], &row[4], &row[6]];
            let (method, drag) = (case.method.to_string(), "explicit");
            assert_eq!(words, ["short", record.hash.as_str(), &method, "explicit", drag, "true"]);
            let cells = case.cells as f64;
            assert_eq!([number(5), number(7), number(8)], [case.settings.flip, cells, 2.0]);
            assert_eq!((&row[9], number(10)), ("stable=0.8", record.step_sizes.largest));
            assert_eq!(
                [number(11), number(12)],
                [record.counters.steps as f64, record.counters.point_updates as f64]
            );
            assert_eq!([&row[13], &row[14]], ["ok", record.provenance.sources.as_str()]);
            assert_eq!(number(15), error.time_factor);
            let words = [&row[16], &row[17], &row[18], &row[19]];
            let (quantity, sample) = (error.quantity.name(), error.sample.name());
            assert_eq!(words, [quantity, sample, error.norm.name(), &error.reference]);
            assert_eq!(number(20).to_bits(), error.value.to_bits());
        }
    }
    assert!(rows.next().is_none(), "no row more");
}

#[test]
fn tables_have_the_records_of_other_sources_too_and_say_how_many() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    let end = |cases: &str| format!("short: {cases} (0 reused, 0 failed), out/short/short.csv\n");
    assert_eq!(call(at, &["run", "short.toml"]).err, end("8 cases"));
    let mut files: Vec<String> = fs::read_dir(at.join("out/short"))
        .expect("a folder")
        .filter_map(|entry| entry.expect("an entry").file_name().into_string().ok())
        .collect();
    files.sort();
    assert_eq!(
        files,
        ["columns.csv", "history.csv", "named-cases.json", "profiles.csv", "records", "short.csv"]
    );
    let table = || fs::read_to_string(at.join("out/short/short.csv")).expect("a table");
    let rows = table().lines().count();
    change_records(&at.join("out"), "short", |number, record| {
        if number < 3 {
            record.provenance.sources = "0123456789abcdef".to_owned();
        }
    });
    let hash = study().cases(Tier::Full)[4].hash();
    let told = call(at, &["run", "short.toml", "--case", &hash]);
    let others = "short: 3 older records in the table come from other sources\n".to_owned();
    assert_eq!((told.code, told.err), (0, others + &end("1 case")));
    assert_eq!(table().lines().count(), rows);
    assert_eq!(table().matches(",0123456789abcdef,").count(), 3 * (rows - 1) / 8);
}

// ---- what cannot be kept ----

#[test]
fn the_first_result_that_cannot_be_kept_ends_the_run() {
    let folder = folder_with(STUDY);
    // A file where the folder of the records should be: nobody can write there, whoever asks.
    fs::create_dir_all(folder.path().join("out/short")).expect("a folder");
    fs::write(folder.path().join("out/short/records"), "in the way").expect("a file");
    let store = RecordStore::new(&folder.path().join("out"), "short");
    let report = run_study(&study(), &RunOptions::whole(Tier::Full, 1), Some(&store), &|_| {});
    assert_eq!((report.records.len(), report.errors.len()), (0, 1), "one case was computed, and not kept");
    let told = call(folder.path(), &["run", "short.toml"]);
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(
        told.err.starts_with("error: cannot create the folder") && told.err.contains("out/short/records"),
        "{}",
        told.err
    );
    assert_eq!(told.err.lines().count(), 1, "{}", told.err);
}

// ---- a reference that refuses ----

#[test]
fn a_reference_that_refuses_fails_its_case_and_no_other() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    fs::write(at.join("refusing.toml"), REFUSING).expect("a file");
    let told = call(at, &["check", "refusing.toml", "short.toml", "--format", "json"]);
    assert!([1, 3, 5].contains(&told.code), "exit code {}: {}", told.code, told.err);
    let checks: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    assert_eq!(checks.as_array().map(Vec::len), Some(2), "both studies are judged");
    assert_eq!((&checks[0]["study"], &checks[0]["end"]), (&"refusing".into(), &"case-failed".into()));
    let failed = checks[0]["failed_cases"].as_array().expect("cases");
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert!(failed[0]["case"].as_str().is_some_and(|case| case.contains("cells=2")), "{failed:?}");
    let sentence = failed[0]["sentence"].as_str().expect("words");
    assert!(sentence.contains("large-strain reference did not converge"), "{sentence}");
    assert_eq!(checks[1]["failed_cases"].as_array().map(Vec::len), Some(0));
    assert_eq!(told.code, 3, "a failed case: {}", told.err);

    let told = call(at, &["run", "refusing.toml", "short.toml"]);
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(told.err.contains("refusing: GC-SRI-patch implicit cells=2"), "{}", told.err);
    assert!(told.err.contains("refusing: 2 cases (0 reused, 1 failed)"), "{}", told.err);
    assert!(told.err.contains("short: 8 cases (0 reused, 0 failed)"), "{}", told.err);
    assert!(at.join("out/refusing/refusing.csv").is_file() && at.join("out/short/short.csv").is_file());
    // Wherever the study stands, and though nothing else is left to run.
    fs::write(at.join("other.toml"), STUDY).expect("a file");
    let (refusing, sound) = ("refusing.toml", ["short.toml", "other.toml"]);
    for studies in [[refusing, sound[0], sound[1]], [sound[0], sound[1], refusing]] {
        for (command, code) in
            [(&["run", "--resume"][..], 3), (&["report"], 3), (&["report", "--from-records"], 0)]
        {
            let told = call(at, &[command, &studies].concat());
            assert_eq!(told.code, code, "{command:?} {studies:?}: {}", told.err);
        }
    }
    assert_eq!(call(at, &["report", sound[0], sound[1]]).code, 0);
}

/// The same without the program, for a reference that refuses at once: Xie & Leo's for a load that grows.
#[test]
fn a_study_with_a_refused_case_fails_by_its_name_and_keeps_the_others() {
    let mut refusing = study();
    refusing.references = vec![ReferenceKind::XieLeo];
    refusing.planned[3].case.column.loading_time = 1.0;
    let (refusing, sound) = (refusing, study());
    let selected = [&refusing, &sound].map(|study| Selected { study, store: None, is_kept: false });
    let reports = run_studies(&selected, &RunOptions::whole(Tier::Full, 2), &|_| {});
    assert_eq!((reports[0].records.len(), reports[0].errors.len()), (7, 1));
    assert_eq!((reports[1].records.len(), reports[1].errors.len()), (8, 0));
    let golden = GoldenFile::of("short", &reports[0].records, "for a test");
    let check = StudyCheck::new(&refusing, &reports[0].records, Tier::Full, Ok(golden));
    assert!(check.failed_cases.is_empty(), "the other cases are sound: {:?}", check.failed_cases);
    let check = check.with_errors(&reports[0].errors);
    assert_ne!(check.end(), CheckEnd::Pass);
    assert_eq!(check.failed_cases.len(), 1);
    let note = &check.failed_cases[0];
    assert!(
        note.case.contains("cells=6") && note.sentence.contains("Xie & Leo's load is sudden"),
        "{note:?}"
    );
}

#[test]
fn origins_of_no_records_have_nothing_to_tell() {
    let none = Origins::default();
    assert_eq!((none.main(), none.several_programs()), (None, None));
}
