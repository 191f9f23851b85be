//! Studies that name programs: nothing is started that nobody allowed.
#![cfg(unix)]

use crate::program::{Told, call_with};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// An adapter that leaves a mark of having been started, and a result.
const ADAPTER: &str = r#"
touch "$2/started"
echo t,y,p,u_y > "$1/result.csv"
for y in 0 0.25 0.5 0.75 1; do echo "8.175,$y,0.5,0" >> "$1/result.csv"; done
"#;

const STUDY: &str = r#"title = "A stranger's"
scene = "terzaghi"
output.time_factors = [0.1]

[[solver]]
name = "theirs"
command = ["sh", "adapter.sh", "{out}", "{study}"]
version = ["sh", "-c", "touch version-asked; echo 1"]
result = "{out}/result.csv"
mapping = "nodes.toml"

[[sweep]]
method = ["GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 8]

[[sweep]]
method = ["theirs"]
cells = [4]

[[expect]]
method = "GC-SRI-patch"
time_factor = 0.1
at = { cells = 4, below = 0.5 }
"#;

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    for (name, text) in [("adapter.sh", ADAPTER), ("s.toml", STUDY), ("nodes.toml", "sample = \"nodes\"\n")] {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

/// A call by somebody who has allowed nothing.
fn untrusting(at: &Path, arguments: &[&str]) -> Told {
    call_with(at, &[("OEDOMETER_ALLOW_SOLVERS", "")], arguments)
}

fn was_started(at: &Path) -> bool {
    at.join("started").exists() || at.join("version-asked").exists()
}

#[test]
fn no_command_starts_what_nobody_allowed_and_each_says_how_to() {
    let folder = folder();
    let at = folder.path();
    let reason = ["--reason", "a look"];
    let commands: [(&[&str], i32); 9] = [
        (&["plan", "s.toml"], 0),
        (&["plan", "s.toml", "--format", "json"], 0),
        (&["run", "s.toml"], 6),
        (&["run", "s.toml", "--resume"], 6),
        (&["check", "s.toml"], 6),
        (&["report", "s.toml"], 6),
        (&["report", "s.toml", "--from-records"], 0),
        (&["explain", "theirs cells=4", "s.toml"], 4),
        (&["merge", "s.toml", "out"], 6),
    ];
    for (words, code) in commands {
        let told = untrusting(at, words);
        assert!(!was_started(at), "{words:?} starts it");
        assert_eq!(told.code, code, "{words:?}: {}{}", told.out, told.err);
        let says_how = ["run", "check", "report"].contains(&words[0]) && !words.contains(&"--from-records");
        let how = "this study runs `sh adapter.sh {out} {study}` in";
        assert_eq!(
            says_how,
            told.err.contains(how) && told.err.contains("--allow-solvers"),
            "{words:?}: {}",
            told.err
        );
    }
    let told = untrusting(at, &[&["accept", "s.toml", "--golden", "none"][..], &reason].concat());
    assert!(told.code != 0 && !was_started(at) && !at.join("none").exists(), "{}", told.err);
    // What is this program's own was solved, and a record of an earlier run stays.
    assert_eq!(oedometer::RecordStore::new(&at.join("out"), "s").hashes().len(), 2);
    assert_eq!(untrusting(at, &["run", "s.toml", "--allow-solvers"]).code, 0);
    assert!(was_started(at));
    fs::remove_file(at.join("started")).expect("it was there");
    let told = untrusting(at, &["run", "s.toml"]);
    assert!(told.code == 6 && !at.join("started").exists(), "{}", told.err);
    let told = untrusting(at, &["run", "s.toml", "--resume"]);
    assert!(
        told.code == 6 && told.err.contains("1 finished result of attached solvers cannot be shown"),
        "{}",
        told.err
    );
    let told = untrusting(at, &["run", "s.toml", "--resume", "--keep-unproven"]);
    assert!(told.code == 0 && told.err.contains("3 cases (3 reused, 0 failed)"), "{}", told.err);
}

#[test]
fn a_verdict_that_passes_without_the_held_back_cases_is_no_pass() {
    let folder = folder();
    let at = folder.path();
    let golden = "# study s\n";
    fs::create_dir(at.join("golden")).expect("a folder");
    fs::write(at.join("golden/s.csv"), golden).expect("a file");
    let told = untrusting(at, &["check", "s.toml"]);
    assert!(told.code != 0 && !was_started(at), "{}{}", told.out, told.err);
    assert!(told.err.contains("1 case was not run: their programs"), "{}", told.err);
}

#[test]
fn a_variable_allows_them_and_what_is_given_starts_nothing() {
    let folder = folder();
    let at = folder.path();
    for (value, code) in [("0", 6), ("false", 6), ("1", 0), ("true", 0)] {
        let told = call_with(at, &[("OEDOMETER_ALLOW_SOLVERS", value)], &["run", "s.toml", "--out", value]);
        assert_eq!(told.code, code, "{value}: {}", told.err);
        assert_eq!(was_started(at), code == 0, "{value}");
    }
}
