//! Many cases: packed records, shares, tables that are made without reading everything again.

use crate::packs::{lines, members, only_pack, packs};
use crate::program::{PROGRAM, Told, call, call_with, folder_with, table_without_times};
use oedometer::{Case, Failure, FailureKind, Record, RecordStore, Status, Study, StudySource, Tier};
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// More cases than a small study has.
const STUDY: &str = r#"title = "Seventy-two short cases"
scene = "terzaghi"

[output]
time_factors = [0.02]

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [2, 3, 4]
time_step = [{ growth = 0.3 }, { growth = 0.4 }]
porosity = [0.25, 0.3, 0.35, 0.4, 0.45, 0.5]
"#;
const CASES: usize = 72;

fn study() -> Study {
    Study::check(&StudySource { name: "short.toml".to_owned(), text: STUDY.to_owned() }).expect("sound")
}

fn table(folder: &Path, out: &str) -> String {
    table_without_times(&folder.join(out).join("short/short.csv"))
}

fn run(folder: &Path, more: &[&str]) -> Told {
    call(folder, &[&["run", "short.toml"], more].concat())
}

/// A folder with a whole run in `out`, whose table is that of small studies too.
fn whole() -> (TempDir, String) {
    let folder = folder_with(STUDY);
    let told = run(folder.path(), &[]);
    assert_eq!(told.code, 0, "{}", told.err);
    let table = table(folder.path(), "out");
    (folder, table)
}

#[test]
fn many_cases_are_few_files_and_every_record_is_a_line_that_anyone_can_read() {
    let (folder, table) = whole();
    let at = folder.path();
    assert_eq!(packs(&at.join("out"), "short").len(), 1);
    assert!(!at.join("out/short/cases").exists());
    let lines = lines(&at.join("out"), "short");
    let records: Vec<serde_json::Value> = lines
        .iter()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .filter(|line: &serde_json::Value| !line["schema"].is_null())
        .collect();
    assert_eq!((lines.len(), records.len()), (2 * CASES, CASES));
    let size = fs::metadata(&packs(&at.join("out"), "short")[0]).expect("a pack").len();
    assert!(size < 15_000 * CASES as u64, "{size} bytes of {CASES} records");
    // In the order of the study, every case once.
    let rows: Vec<&str> = table.lines().skip(1).map(|row| row.split(',').nth(1).expect("a hash")).collect();
    let firsts: Vec<String> = rows.chunk_by(|a, b| a == b).map(|chunk| chunk[0].to_owned()).collect();
    let planned: Vec<String> = study().planned.iter().map(|planned| planned.case.hash()).collect();
    assert_eq!(firsts, planned);
    // A single record on request.
    let told = call(at, &["records", "out/short", &planned[7]]);
    let record = Record::from_json(&told.out).expect("one record");
    // What a study sweeps is its own business, and no part of a record.
    let case = Case { swept: std::sync::Arc::default(), ..study().planned[7].case.clone() };
    assert_eq!((told.code, &record.hash, &record.case), (0, &planned[7], &case));
    let whole = |words: &[&str]| -> serde_json::Value {
        let told = call(at, &[&["records", "out/short", "--format", "json"], words].concat());
        serde_json::from_str(&told.out).expect("JSON")
    };
    let (all, single) = (whole(&[]), whole(&[&planned[7]]));
    assert_eq!(all.as_array().map(Vec::len), Some(CASES));
    assert!(single["wall"][0]["seconds"].is_f64() && all.as_array().is_some_and(|all| all.contains(&single)));
    let told = call(at, &["records", "out/short", &planned[7], "--format", "table"]);
    assert!(told.out.lines().count() == 2 && told.out.contains(&planned[7]), "{}", told.out);
    let told = call(at, &["records", "out/short"]);
    assert_eq!((told.code, told.out.lines().count()), (0, CASES + 1));
    assert_eq!(call(at, &["records", "out/short", "zzzz"]).code, 4);
    let told = call(at, &["records", "out/short", "--history"]);
    assert!(told.out.starts_with("case,time_factor,degree_of_consolidation,kinetic_energy,strain_energy\n"));
    assert_eq!(call(at, &["records", "nowhere"]).code, 2);
}

#[test]
fn packed_records_are_taken_up_and_what_is_missing_runs() {
    let (folder, table_of_whole) = whole();
    let at = folder.path();
    let told = run(at, &["--resume"]);
    assert!(told.err.contains("72 cases (72 reused, 0 failed)"), "{}", told.err);
    // Cut in its last third, as a kill would leave it, and once more in the middle of a record.
    let (pack, bytes) = only_pack(&at.join("out"), "short");
    fs::write(&pack, &bytes[..bytes.len() * 2 / 3]).expect("written");
    let told = call(at, &["plan", "short.toml", "--missing", "out"]);
    let missing = told.out.lines().count() - 1;
    assert!((20..28).contains(&missing), "{missing} of {CASES}");
    assert!(told.err.starts_with(&format!("{missing} cases: about ")), "of these alone: {}", told.err);
    let told = call(at, &["plan", "short.toml"]);
    assert!(told.err.starts_with(&format!("{CASES} cases: about ")), "{}", told.err);
    let told = call(at, &["records", "out/short"]);
    assert!(told.err.contains("is cut at byte"), "{}", told.err);
    let told = run(at, &["--resume"]);
    let from_disk = CASES - missing;
    assert!(told.err.contains(&format!("72 cases ({from_disk} reused, 0 failed)")), "{}", told.err);
    assert_eq!(table(at, "out"), table_of_whole);
    assert_eq!(packs(&at.join("out"), "short").len(), 1, "the pack was taken up");
    let told = call(at, &["records", "out/short"]);
    assert!(!told.err.contains("cut") && !told.err.contains("damaged"), "and its end mended: {}", told.err);
}

#[test]
fn a_packed_record_with_any_damaged_part_is_run_again_and_no_other_is() {
    let (folder, table_of_whole) = whole();
    let at = folder.path();
    let (pack, bytes) = only_pack(&at.join("out"), "short");
    let members = members(&bytes);
    assert_eq!(members.len(), CASES);
    let Range { start, end } = members[CASES / 2];
    // Its length by any bit: too short, past the next record and past many.
    let lengths = (0..16).step_by(3).map(|bit| ("its length", start + 45 + bit / 8, 1 << (bit % 8), 71));
    let parts = [
        ("its magic", start, 71),
        ("its kind", start + 16, 71),
        ("the hash of its case", start + 21, 71),
        ("its packed text", usize::midpoint(start, end), 71),
        ("its checksum", end - 8, 71),
        ("the length of its text", end - 1, 71),
        // They say when and by what it was made, as the record itself does: it is the same record.
        ("the tag of its program", start + 29, 72),
        ("the count of its run", start + 17, 72),
        ("the tag of its build", start + 37, 72),
    ];
    let parts = parts.map(|(part, place, from_disk)| (part, place, 0xff, from_disk));
    for (part, place, flipped, from_disk) in parts.into_iter().chain(lengths) {
        let mut damaged = bytes.clone();
        damaged[place] ^= flipped;
        fs::write(&pack, &damaged).expect("written");
        let told = run(at, &["--resume"]);
        let expected = format!("72 cases ({from_disk} reused, 0 failed)");
        assert!(
            told.code == 0 && told.err.contains(&expected),
            "{part}, byte {place}, bits {flipped}: {}",
            told.err
        );
        assert_eq!(table(at, "out"), table_of_whole, "{part}");
    }
}

#[test]
fn a_store_of_the_older_layout_is_named_and_not_read() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    let case = at.join("out/short/cases").join(study().planned[0].case.hash());
    fs::create_dir_all(&case).expect("a folder");
    fs::write(case.join("record.json"), "{}").expect("a file");
    let sentence = "out/short/cases has records in the layout of version 0.2: they are not read, and the folder can be deleted";
    for (words, code) in [
        (&["report", "short.toml", "--from-records"][..], 4),
        (&["records", "out/short"], 4),
        (&["merge", "short.toml", "out", "--out", "merged"], 6),
        (&["run", "short.toml", "--resume"], 0),
        (&["report", "short.toml"], 0),
        (&["compare", "out", "out"], 0),
    ] {
        let told = call(at, words);
        assert!(told.code == code && told.err.contains(sentence), "{words:?} {}: {}", told.code, told.err);
    }
    assert!(!call(at, &["run", "short.toml", "--resume", "--out", "new"]).err.contains("layout"));
}

#[test]
fn a_late_case_of_many_is_run_again_and_a_failed_one_is_not_hidden() {
    let (folder, _) = whole();
    let at = folder.path();
    let store = RecordStore::new(&at.join("out"), "short");
    let failed = |number: usize, kind| {
        let mut record = store.kept(&study().planned[number].case).expect("a record");
        let reason = "a test".to_owned();
        record.status = Status::Failed(Failure { kind, step: 1, time: 1.0, growth: None, reason });
        store.write(&record).expect("written");
    };
    failed(3, FailureKind::TimedOut);
    failed(4, FailureKind::Unstable);
    failed(5, FailureKind::Unstable);
    drop(store);
    let told = call(at, &["plan", "short.toml", "--missing", "out"]);
    assert_eq!(told.out.lines().count(), 2);
    assert!(told.err.starts_with("1 case: about "), "{}", told.err);
    let told = run(at, &["--resume"]);
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(told.err.contains("72 cases (71 reused, 2 failed)"), "{}", told.err);
}

#[test]
fn shares_by_cost_part_the_cases_exactly_and_merge_to_the_table_of_one_machine() {
    let (folder, expected) = whole();
    let at = folder.path();
    let list = call(at, &["plan", "short.toml", "--tasks", "3", "--balance", "--out", "parts"]);
    assert_eq!((list.code, list.out.lines().count()), (0, 3), "{}", list.err);
    assert!(list.err.contains("3 shards: the largest takes"), "{}", list.err);
    for line in list.out.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        assert_eq!(&words[..3], &["oedometer", "run", "short.toml"]);
        let told = call(at, &words[1..]);
        assert!(told.code == 0 && told.err.contains("short: 24 cases (0 reused"), "{}", told.err);
    }
    assert!(!at.join("parts/short/short.csv").exists(), "shares leave the table to the merge");
    let told = call(at, &["merge", "short.toml", "parts", "--out", "parts"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert_eq!(table(at, "parts"), expected);
    // Folders of their own come to the same.
    for share in 1..=3 {
        let (share, out) = (format!("{share}/3"), format!("p{share}"));
        assert_eq!(run(at, &["--shard", &share, "--balance", "--out", &out]).code, 0);
    }
    let told = call(at, &["merge", "short.toml", "p1", "p3", "--out", "merged"]);
    assert!(told.code == 6 && told.err.contains("48 of 72 cases"), "{}", told.err);
    let told = call(at, &["plan", "short.toml", "--missing", "merged", "--tasks", "3", "--balance"]);
    let command = "oedometer run short.toml --out merged --shard 2/3 --balance --resume\n";
    assert_eq!((told.code, told.out.as_str()), (0, command), "the share that is missing, as it was");
    assert!(told.err.contains("24 cases: about "), "{}", told.err);
    assert_eq!(call(at, &["merge", "short.toml", "p1", "p2", "p3", "--out", "merged"]).code, 0);
    assert_eq!(table(at, "merged"), expected);
    let told = call(at, &["plan", "short.toml", "--missing", "merged"]);
    assert!(told.code == 0 && told.err.contains("no case is missing"), "{}", told.err);
}

#[test]
fn an_empty_share_is_no_failure_and_a_case_larger_than_a_share_is_said() {
    let folder = folder_with(&STUDY.replace("[2, 3, 4]", "[2, 2000]").replace("[0.02]", "[1.0]"));
    let at = folder.path();
    let told = run(at, &["--shard", "999999/1000000", "--tier", "smoke"]);
    assert_eq!(told.code, 4, "no case of the tier at all: {}", told.err);
    let told = run(at, &["--shard", "999999/1000000"]);
    assert!(told.code == 0 && told.err.contains("shard 999999 of 1000000 has no case"), "{}", told.err);
    assert!(!at.join("out").exists(), "nothing selected, nothing written");
    let told = call(at, &["plan", "short.toml", "--tasks", "1000", "--balance"]);
    assert!(told.err.contains("one case alone takes") && told.err.contains("bring no gain"), "{}", told.err);
}

#[cfg(unix)]
#[test]
fn a_run_that_is_told_to_end_keeps_what_is_done_and_says_what_is_left() {
    let folder = folder_with(&STUDY.replace("[2, 3, 4]", "[400, 500, 600]").replace("[0.02]", "[1.0]"));
    let at = folder.path();
    let child = Command::new(PROGRAM)
        .current_dir(at)
        .args(["run", "short.toml", "--jobs", "1"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    // As soon as it has kept something.
    for _ in 0..2000 {
        if packs(&at.join("out"), "short")
            .first()
            .is_some_and(|pack| fs::metadata(pack).is_ok_and(|about| about.len() > 0))
        {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let signal = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill");
    assert!(signal.success());
    let output = child.wait_with_output().expect("it is over");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(6), "{told}");
    assert!(
        told.contains("not run, because the run was interrupted: `--resume` continues with them"),
        "{told}"
    );
    let done = lines(&at.join("out"), "short").len() / 2;
    assert!((1..CASES).contains(&done), "{done} of {CASES}");
    let told = call(at, &["plan", "short.toml", "--missing", "out"]);
    assert_eq!(told.out.lines().count() - 1, CASES - done);
}

#[test]
fn the_scripts_of_a_cluster_are_shown_without_a_cluster() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    let options = ["--engine", "slurm", "--tasks", "6", "--time", "10", "--partition", "short", "--dry-run"];
    let told = run(at, &options);
    assert_eq!(told.code, 0, "{}", told.err);
    for part in [
        "#SBATCH --partition=short",
        "#SBATCH --time=10",
        "#SBATCH --requeue",
        "#SBATCH --signal=B:TERM@60",
        "--shard $SLURM_ARRAY_TASK_ID/6 --balance",
        "sbatch --parsable --array=1-6 out/slurm/array.sh",
        "--dependency=afterany:$array",
    ] {
        assert!(told.out.contains(part), "no {part} in {}", told.out);
    }
    assert!(!at.join("out").exists(), "nothing is written");
    assert_eq!(run(at, &["--tasks", "6"]).code, 2, "shares of an engine that is not named");
}

/// Programs of a scheduler that takes three tasks an array, note what they are asked, and refuse the n-th submission.
#[cfg(unix)]
fn fake_slurm(at: &Path, refused: usize) -> String {
    use std::os::unix::fs::PermissionsExt;
    let bin = at.join("bin");
    fs::create_dir_all(&bin).expect("a folder");
    let asked = at.join("asked");
    let sbatch = format!(
        "n=$(grep -c sbatch {0} 2>/dev/null); echo sbatch \"$@\" >> {0}\n[ \"$n\" = {refused} ] && {{ echo no room >&2; exit \
         1; }}\necho $((101 + n))",
        asked.display()
    );
    for (name, script) in [
        ("scontrol", "echo 'Configuration data'; echo 'MaxArraySize            = 4'".to_owned()),
        ("sbatch", sbatch),
        ("scancel", format!("echo scancel \"$@\" >> {}", asked.display())),
        ("squeue", "true".to_owned()),
    ] {
        fs::write(bin.join(name), format!("#!/bin/sh\n{script}\n")).expect("a file");
        fs::set_permissions(bin.join(name), fs::Permissions::from_mode(0o755)).expect("rights");
    }
    format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default())
}

#[test]
#[cfg(unix)]
fn more_tasks_than_an_array_takes_are_as_many_shares_as_it_takes() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    let path = fake_slurm(at, 9);
    let with = |tasks: &str, option: &str| {
        let words = ["run", "short.toml", "--engine", "slurm", "--tasks", tasks, option];
        call_with(at, &[("PATH", path.as_str())], &words)
    };
    let told = with("8", "--dry-run");
    assert!(
        told.code == 0 && told.err.contains("this Slurm accepts at most 3 tasks per array"),
        "{}",
        told.err
    );
    for part in ["--shard $SLURM_ARRAY_TASK_ID/3 --balance", "# array=$(sbatch --parsable --array=1-3 out/"] {
        assert!(told.out.contains(part), "no {part} in {}", told.out);
    }
    assert!(!with("3", "--dry-run").err.contains("takes at most"));
    let told = with("8", "--detach");
    assert_eq!(told.code, 0, "{}", told.err);
    let asked = fs::read_to_string(at.join("asked")).expect("what was asked");
    let asked: Vec<&str> = asked.lines().collect();
    assert!(asked.len() == 2 && asked[1].contains("--dependency=afterany:101 "), "{asked:?}");
    // The scheduler gives each task its number: together they are all of the shares.
    for task in 1..=3 {
        let mut task_of = Command::new("bash");
        task_of.current_dir(at).arg("out/slurm/array.sh").env("SLURM_ARRAY_TASK_ID", task.to_string());
        let output = task_of.output().expect("bash");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let told = call(at, &["plan", "short.toml", "--missing", "out"]);
    assert!(told.err.contains("no case is missing"), "{}", told.err);
}

#[test]
#[cfg(unix)]
fn an_array_whose_merge_is_refused_is_taken_back() {
    let folder = folder_with(STUDY);
    let at = folder.path();
    let path = fake_slurm(at, 1);
    let told = call_with(
        at,
        &[("PATH", path.as_str())],
        &["run", "short.toml", "--engine", "slurm", "--tasks", "8", "--detach"],
    );
    assert!(told.code == 3 && told.err.contains("no room"), "{}", told.err);
    let asked = fs::read_to_string(at.join("asked")).expect("what was asked");
    let back: Vec<&str> = asked.lines().filter(|line| line.starts_with("scancel")).collect();
    assert_eq!(back, ["scancel 101"], "{asked}");
    assert!(!at.join("out/slurm/job").exists(), "nothing is under way");
}

/// The share 2/2 of a whole run in packs of its own, each record changed on its way.
fn changed_share(folder: &Path, out: &str, change: &dyn Fn(&mut Record)) {
    let whole = RecordStore::new(&folder.join("out"), "short");
    let share = RecordStore::new(&folder.join(out), "short");
    for case in study().cases(Tier::Full).into_iter().skip(CASES / 2) {
        let mut record = whole.kept(case).expect("a record");
        change(&mut record);
        share.write(&record).expect("written");
    }
}

#[test]
fn records_of_another_machine_are_merged_and_counted_and_those_of_other_sources_are_not() {
    let (folder, expected) = whole();
    let at = folder.path();
    let first: RecordStore = RecordStore::new(&at.join("first"), "short");
    let all = RecordStore::new(&at.join("out"), "short");
    for case in study().cases(Tier::Full).into_iter().take(CASES / 2) {
        first.write(&all.kept(case).expect("a record")).expect("written");
    }
    let elsewhere = serde_json::json!({
        "seconds": 1.0, "alone": true, "machine": { "node": "another", "processor": "Another CPU" }
    });
    changed_share(at, "machine", &|record| {
        record.wall = vec![serde_json::from_value(elsewhere.clone()).expect("a time")];
        record.provenance.compiler = "rustc 0.0.0".to_owned();
    });
    let told = call(at, &["merge", "short.toml", "first", "machine", "--out", "both"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(told.err.contains("the records come from several builds of one program"), "{}", told.err);
    assert_eq!(table(at, "both"), expected, "values do not depend on the machine");
    let list = call(at, &["records", "both/short"]).out;
    let elsewhere = list.lines().filter(|row| row.contains(",another,Another CPU,"));
    assert_eq!((list.lines().count() - 1, elsewhere.count()), (CASES, CASES / 2), "{list}");
    // Other sources may give other values.
    changed_share(at, "sources", &|record| record.provenance.sources = "0123456789abcdef".to_owned());
    let told = call(at, &["merge", "short.toml", "first", "sources", "--out", "none"]);
    assert_eq!(told.code, 6, "{}", told.err);
    assert!(told.err.contains("come from several programs: 36 of version"), "{}", told.err);
    assert!(!at.join("none").exists(), "nothing is written");
    let told = call(at, &["plan", "short.toml", "--missing", "sources"]);
    assert_eq!(told.out.lines().count() - 1, CASES, "none of them counts as done");
    // Of one build, and in one store, every third of them: no record stands for those beside it.
    let number = std::cell::Cell::new(0);
    changed_share(at, "mixed", &|record| {
        number.set(number.get() + 1);
        if number.get() % 3 == 0 {
            record.provenance.sources = "0123456789abcdef".to_owned();
        }
    });
    let told = call(at, &["merge", "short.toml", "mixed", "--out", "none"]);
    assert_eq!(told.code, 6, "{}", told.err);
    let (own, other) = ("24 of version", "12 of version");
    assert!(told.err.contains("come from several programs"), "{}", told.err);
    assert!(told.err.contains(own) && told.err.contains(other), "{}", told.err);
    assert!(!at.join("none").exists(), "nothing is written");
    let told = call(at, &["plan", "short.toml", "--missing", "mixed"]);
    assert_eq!(told.out.lines().count() - 1, CASES - 24, "the others count as done");
}
