//! Faults around a run: killed, out of space, two at once, damaged records, a clock that jumps.
//! Nothing finished is lost, and nothing wrong is taken for a result.

use crate::packs::{only_pack, records, tampered};
use crate::program::{PROGRAM, table_without_times};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Cases of some milliseconds each: a kill falls before, into, between and behind them.
const STUDY: &str = r#"title = "Short cases"
scene = "terzaghi"

[output]
time_factors = [0.005]

[[sweep]]
method = ["MPM", "GIMP-SRI-patch", "GC-SRI-patch"]
cells = [3, 4, 5]
time_step = [{ stable = 0.4 }]
"#;

/// Moments of the kills, spread over a run.
const KILLS: u32 = 30;

fn program() -> Command {
    Command::new(PROGRAM)
}

fn folder_with_study() -> TempDir {
    crate::program::folder_with(STUDY)
}

fn run_in(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let told = crate::program::call(folder, arguments);
    (told.code, told.err)
}

/// The tables of the results and every record as text, without wall times, which differ from day to day.
fn results(folder: &Path) -> BTreeMap<String, String> {
    let out = folder.join("out");
    let mut results = records(&out, "short");
    for table in fs::read_dir(out.join("short")).expect("a folder").flatten() {
        let name = table.file_name().to_string_lossy().into_owned();
        if name == "short.csv" {
            results.insert(name, table_without_times(&table.path()));
        } else if table.path().is_file() && table.path().extension().is_none_or(|end| end != "part") {
            // What a kill left half written has a name of its own, and is nobody's result.
            results.insert(name, fs::read_to_string(table.path()).expect("a table"));
        }
    }
    results
}

fn whole_run() -> (BTreeMap<String, String>, Duration) {
    let folder = folder_with_study();
    let start = Instant::now();
    assert_eq!(run_in(folder.path(), &["run", "short.toml", "--out", "out"]).0, 0);
    (results(folder.path()), start.elapsed())
}

#[test]
fn a_run_killed_at_any_moment_resumes_to_the_same_records_and_tables() {
    let (expected, duration) = whole_run();
    let mut interrupted = 0;
    for kill in 0..KILLS {
        let folder = folder_with_study();
        let mut child = program()
            .current_dir(folder.path())
            .args(["run", "short.toml", "--out", "out", "--jobs", "2"])
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        // Golden-ratio moments: spread evenly, and never in step with the cases.
        std::thread::sleep(duration.mul_f64((f64::from(kill) * 0.618_033_988_75).fract()));
        child.kill().expect("SIGKILL");
        let ended = child.wait().expect("it is over");
        interrupted += u32::from(!ended.success());
        assert_eq!(run_in(folder.path(), &["run", "short.toml", "--out", "out", "--resume"]).0, 0);
        let found = results(folder.path());
        assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "kill {kill}");
        assert!(found == expected, "other results after kill {kill}");
    }
    // On a busy machine the first run took longer than these.
    assert!(interrupted >= KILLS / 10, "only {interrupted} of {KILLS} runs were interrupted");
}

#[test]
fn two_runs_in_one_folder_leave_the_same_records_and_tables_as_one() {
    let (expected, _) = whole_run();
    let folder = folder_with_study();
    let start = || {
        program()
            .current_dir(folder.path())
            .args(["run", "short.toml", "--out", "out"])
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts")
    };
    let both = [start(), start()];
    for mut one in both {
        assert!(one.wait().expect("it is over").success());
    }
    assert!(results(folder.path()) == expected);
}

/// Runs under a limit on the size of any file, which is what a full disk looks like to a writer.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_leaves_no_half_record() {
    let (expected, _) = whole_run();
    let folder = folder_with_study();
    // Blocks of 1024 bytes; a record has more.
    let script = format!("trap '' XFSZ; ulimit -f 2; exec {PROGRAM} run short.toml --out out");
    let output =
        Command::new("bash").current_dir(folder.path()).args(["-c", &script]).output().expect("bash");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.starts_with("error: cannot write ") && told.lines().count() == 1, "{told}");
    assert_eq!(only_pack(&folder.path().join("out"), "short").1, b"", "nothing half written stays");
    // There is room again.
    assert_eq!(run_in(folder.path(), &["run", "short.toml", "--out", "out", "--resume"]).0, 0);
    assert!(results(folder.path()) == expected);
}

#[test]
fn an_unwritable_folder_is_told_in_a_sentence() {
    let folder = folder_with_study();
    fs::write(folder.path().join("out"), "a file where the folder should be").expect("a file");
    let (code, told) = run_in(folder.path(), &["run", "short.toml", "--out", "out"]);
    assert_eq!(code, 3, "{told}");
    assert!(told.contains("cannot create the folder"), "{told}");
}

#[test]
fn a_clock_that_jumps_changes_no_result() {
    let (expected, _) = whole_run();
    let folder = folder_with_study();
    assert_eq!(run_in(folder.path(), &["run", "short.toml", "--out", "out"]).0, 0);
    // Records from the future and from long ago are taken up alike: nothing looks at dates.
    let (path, _) = only_pack(&folder.path().join("out"), "short");
    let long_ago = std::time::UNIX_EPOCH + Duration::from_secs(1);
    for time in [std::time::SystemTime::now() + Duration::from_secs(3_000_000_000), long_ago] {
        let pack = fs::File::options().write(true).open(&path).expect("a pack");
        pack.set_modified(time).expect("a date");
        let (code, told) = run_in(folder.path(), &["run", "short.toml", "--out", "out", "--resume"]);
        assert!(code == 0 && told.contains("9 reused"), "{told}");
    }
    assert!(results(folder.path()) == expected);
}

/// A folder with the record of one case: its pack, and the bytes of that.
fn one_record() -> (TempDir, PathBuf, Vec<u8>) {
    let folder = TempDir::new().expect("a folder");
    let study = STUDY
        .replace("[3, 4, 5]", "[3]")
        .replace("[\"MPM\", \"GIMP-SRI-patch\", \"GC-SRI-patch\"]", "[\"MPM\"]");
    fs::write(folder.path().join("short.toml"), study).expect("a file");
    assert_eq!(run_in(folder.path(), &["run", "short.toml", "--out", "out"]).0, 0);
    let (pack, bytes) = only_pack(&folder.path().join("out"), "short");
    (folder, pack, bytes)
}

#[test]
fn a_record_that_is_damaged_or_was_tampered_with_is_run_again_to_the_same_values() {
    let (folder, pack, sound) = one_record();
    let expected = results(folder.path());
    let middle = sound.len() / 2;
    let cut = sound[..middle].to_vec();
    let mut zeroed = sound.clone();
    zeroed[middle..middle + 512].fill(0);
    // Sound JSON in a sound member, of the right case: one digit of one result, another input, no number.
    let changed = |what: &str, by: &str| tampered(&sound, |text| text.replacen(what, by, 1), None);
    let digit = tampered(
        &sound,
        |text| {
            let place = text.find("\"pressure\":[").expect("a field") + 20;
            let digit = text[place..].find(|letter: char| letter.is_ascii_digit()).expect("a digit") + place;
            let other = if text.as_bytes()[digit] == b'7' { "3" } else { "7" };
            text[..digit].to_owned() + other + &text[digit + 1..]
        },
        None,
    );
    let no_number = changed("\"value\":", "\"value\":NaN,\"v\":");
    for damaged in [cut, zeroed, digit, changed("\"cells\":3", "\"cells\":4"), no_number, Vec::new()] {
        fs::write(&pack, &damaged).expect("a file");
        let (code, told) = run_in(folder.path(), &["run", "short.toml", "--out", "out", "--resume"]);
        assert!(code == 0 && told.contains("0 reused"), "{told}");
        assert!(results(folder.path()) == expected);
    }
}

#[test]
fn a_case_that_takes_too_long_ends_with_a_name_and_is_tried_again() {
    let folder = TempDir::new().expect("a folder");
    let study = format!("case_seconds = 1e-3\n{}", STUDY.replace("[0.005]", "[5.0]"));
    fs::write(folder.path().join("short.toml"), study).expect("a file");
    let (code, told) = run_in(folder.path(), &["run", "short.toml", "--out", "out"]);
    assert_eq!(code, 3, "{told}");
    assert!(told.contains("timed-out") && told.contains("0.001 s that its study allows"), "{told}");
    let (_, told) = run_in(folder.path(), &["run", "short.toml", "--out", "out", "--resume"]);
    assert!(told.contains("0 reused"), "{told}");
}

/// A study with a piece cut out, doubled or overwritten.
fn mangled() -> impl Strategy<Value = String> {
    let whole = include_str!("../../../studies/hard-strain.toml");
    (
        0..whole.len(),
        0..60_usize,
        prop::sample::select(vec!["", "[", "]", "\"", "=", "-1", "1e999", "nan", "\n[[sweep]]\n", "é", "{}"]),
    )
        .prop_map(move |(start, length, put)| {
            let edge =
                |at: usize| (at..=whole.len()).find(|at| whole.is_char_boundary(*at)).unwrap_or(whole.len());
            let (from, to) = (edge(start), edge((start + length).min(whole.len())));
            format!("{}{put}{}", &whole[..from], &whole[to..])
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn a_mangled_study_is_taken_or_refused_with_a_place_and_never_panics(text in mangled()) {
        let source = oedometer::StudySource { name: "mangled.toml".to_owned(), text };
        if let Err(error) = oedometer::Study::check(&source) {
            let told = error.to_string();
            prop_assert!(told.contains("mangled.toml") || told.contains("error"), "{told}");
            prop_assert!(told.len() > 20, "a sentence: {told}");
        }
    }

    #[test]
    fn any_text_is_refused_with_words(text in "\\PC{0,200}") {
        let source = oedometer::StudySource { name: "any.toml".to_owned(), text };
        let refused = oedometer::Study::check(&source);
        prop_assert!(refused.is_err_and(|error| error.to_string().len() > 20));
    }
}

#[test]
fn any_damage_to_a_record_leaves_it_whole_or_unread() {
    let (folder, pack, sound) = one_record();
    let out = folder.path().join("out");
    let expected = records(&out, "short");
    let mut seed = 7_u64;
    for _ in 0..400 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut damaged = sound.clone();
        let at = usize::try_from(seed >> 33).expect("small") % damaged.len();
        damaged[at] ^= 1 << (seed >> 29 & 7);
        fs::write(&pack, &damaged).expect("a file");
        let read = records(&out, "short");
        assert!(read.is_empty() || read == expected, "a flipped bit at byte {at} was taken for a result");
    }
}
