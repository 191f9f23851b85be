//! Every command with a lost or a full output stream: a reader who leaves is no failure, a full device
//! under standard output is one with a sentence, and under standard error it stops nothing.
#![cfg(target_os = "linux")]

use crate::program::PROGRAM;
use std::fs::{self, File, OpenOptions};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// One case of a few milliseconds, with an expectation that fails.
const STUDY: &str = r#"title = "A short study"
scene = "terzaghi"

[output]
time_factors = [0.005]

[[sweep]]
method = ["MPM"]
integrator = ["implicit"]
cells = [3, 4]

[[expect]]
time_factor = 0.005
at = { cells = 4, below = 1e-9 }
"#;

/// Every command, and the ends that are no success.
const CALLS: &[&[&str]] = &[
    &["run", "short.toml"],
    &["run", "short.toml", "--case", "nothing"],
    &["report", "short.toml", "--out", "made"],
    &["check", "short.toml"],
    &["check", "short.toml", "--format", "json", "--annotate"],
    &["accept", "short.toml", "--reason", "a test"],
    &["exact", "terzaghi", "--time-factor", "0.1"],
    &["exact", "terzaghi", "--time-factor", "0.1", "--format", "json"],
    &["solve", "terzaghi", "--integrator", "implicit", "--cells", "4", "--time-factor", "0.1"],
    &[
        "solve",
        "terzaghi",
        "--integrator",
        "implicit",
        "--cells",
        "4",
        "--time-factor",
        "0.1",
        "--format",
        "csv",
    ],
    &["solve", "terzaghi", "--time-step", "seconds=1e-3", "--time-factor", "0.01"],
    &["score", "column-10.csv", "--scene", "terzaghi", "--mapping", "mapping.toml", "--below", "1e-9"],
    &["score", "column-10.csv", "--scene", "terzaghi", "--mapping", "mapping.toml", "--format", "csv"],
    &["score", "--show-mapping"],
    &["stability", "terzaghi", "--cells", "2", "--points-per-cell", "1", "--time-factor", "0.0001"],
    &["plan", "short.toml"],
    &["plan"],
    &["merge", "short.toml", "out", "--out", "merged"],
    &["list"],
    &["list", "--show", "terzaghi-mesh"],
    &["new", "profiles"],
    &["explain", "MPM cells=3", "short.toml"],
    &["schema", "study"],
    &["completions", "bash"],
    &["--help"],
    &["--version"],
    &["run", "--help"],
    &["run", "missing.toml"],
    &["nonsense"],
];

fn place() -> TempDir {
    let folder = crate::program::folder_with(STUDY);
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/other-solver");
    for name in ["column-10.csv", "mapping.toml"] {
        fs::copy(example.join(name), folder.path().join(name)).expect("a copy");
    }
    folder
}

/// A pipe whose reader has gone.
fn closed() -> Stdio {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    writer.into()
}

/// A device that is full from the start.
fn full() -> Stdio {
    OpenOptions::new().write(true).open("/dev/full").map(File::into).expect("the full device")
}

fn call(folder: &Path, arguments: &[&str], out: Stdio, err: Stdio) -> Output {
    let mut command = Command::new(PROGRAM);
    for name in crate::program::OF_A_CI {
        command.env_remove(name);
    }
    let child = command.current_dir(folder).args(arguments).stdin(Stdio::null()).stdout(out).stderr(err);
    child.spawn().expect("it starts").wait_with_output().expect("it is over")
}

#[test]
fn a_lost_or_full_stream_never_changes_an_exit_code_but_where_data_are_lost() {
    let folder = place();
    let at = folder.path();
    let code = |output: &Output, arguments: &[&str], how: &str| {
        output.status.code().unwrap_or_else(|| panic!("{arguments:?} with {how}: ended by a signal"))
    };
    let mut ends = Vec::new();
    for arguments in CALLS {
        let sound = call(at, arguments, Stdio::piped(), Stdio::piped());
        let expected = code(&sound, arguments, "sound streams");
        ends.push(expected);
        for (how, out, err) in [
            ("standard output closed", closed(), Stdio::piped()),
            ("standard error closed", Stdio::piped(), closed()),
            ("both closed", closed(), closed()),
            ("standard error full", Stdio::piped(), full()),
        ] {
            let output = call(at, arguments, out, err);
            assert_eq!(code(&output, arguments, how), expected, "{arguments:?} with {how}");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(!said.contains("ipe"), "{arguments:?} with {how}: {said}");
        }
        let output = call(at, arguments, full(), Stdio::piped());
        let said = String::from_utf8_lossy(&output.stderr);
        let found = code(&output, arguments, "standard output full");
        if sound.stdout.is_empty() {
            assert_eq!(found, expected, "{arguments:?} writes no data: {said}");
        } else {
            let worse = if arguments[0] == "check" { expected } else { 3 };
            assert_eq!(found, worse, "{arguments:?} with standard output full: {said}");
            let sentences = said.matches("error: cannot write to standard output: No space left").count();
            assert_eq!(sentences, 1, "{arguments:?} with standard output full: {said}");
        }
        assert_ne!(call(at, arguments, full(), full()).status.code(), Some(101), "{arguments:?}");
    }
    for seen in [0, 1, 2, 3, 4] {
        assert!(ends.contains(&seen), "no call of the list ends with {seen}: {ends:?}");
    }
}
