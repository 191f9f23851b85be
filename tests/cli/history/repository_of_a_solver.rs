//! `bisect`, `compare` and `history` of a solver in Python: ten commits, of which one makes its results worse, one does not
//! build, one crashes and one only renames.

use crate::all_commands::place::git;
use crate::program::{Told, call};
use oedometer::{GoldenFile, RunOptions, Study, StudySource, Tier, run_study};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const WORSE: &str = "Take a larger permeability";

/// Writes what the study gives now as its golden values.
fn accept(at: &Path, reason: &str) {
    let path = at.join("mine/mine.toml");
    let text = fs::read_to_string(&path).expect("a study");
    let mut study = Study::check(&StudySource { name: path.display().to_string(), text }).expect("sound");
    study.may_start_solvers = true;
    let report = run_study(&study, &RunOptions::whole(Tier::Ci, 2), None, &|_| {});
    GoldenFile::of("mine", &report.records, reason).write(&at.join("golden")).expect("written");
}

/// The repository, from what `new-solver` writes.
fn repository() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let at = folder.path();
    let told = call(at, &["new-solver", "mine", "--language", "python"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let change = |file: &str, old: &str, new: &str| {
        let path = at.join("mine").join(file);
        let text = fs::read_to_string(&path).expect("a file");
        assert!(text.contains(old), "{file} has no {old}");
        fs::write(path, text.replacen(old, new, 1)).expect("written");
    };
    let commit = |subject: &str| {
        git(at, &["add", "-A"]);
        git(at, &["commit", "-q", "--allow-empty", "-m", subject]);
    };
    // Packages of its site, which take most of a start, are none of its business.
    change("mine.toml", "\"python3\", ", "\"python3\", \"-I\", \"-S\", ");
    git(at, &["init", "-q"]);
    fs::write(at.join(".gitignore"), "out\n__pycache__\n").expect("written");
    accept(at, "first values");
    commit("Add a solver");
    git(at, &["tag", "good"]);
    fs::write(at.join("README"), "a solver\n").expect("written");
    commit("Describe it");
    git(at, &["mv", "mine/adapter.py", "mine/column.py"]);
    change("mine.toml", "\"adapter.py\"", "\"column.py\"");
    commit("Rename the adapter");
    change("column.py", "def solve(case):", "def solve(case:");
    commit("Do not build");
    change("column.py", "def solve(case:", "def solve(case):");
    change("column.py", "    cells, height", "    import os; os.abort()\n    cells, height");
    commit("Crash");
    change("column.py", "    import os; os.abort()\n", "");
    commit("Mend the crash");
    commit("Change nothing");
    change("column.py", "mobility = soil", "mobility = 1.05 * soil");
    accept(at, "a larger permeability");
    commit(WORSE);
    commit("Describe more");
    commit("Describe all");
    folder
}

#[test]
fn the_commit_that_moved_a_python_solver_is_found_marked_and_told() {
    let folder = repository();
    let at = folder.path();
    let bisect =
        |words: &[&str]| call(at, &[&["bisect", "mine/mine.toml", "--good", "good"], words].concat());
    let told: Told = bisect(&["--bad", "HEAD"]);
    assert_eq!(told.code, 0, "{}{}", told.out, told.err);
    let first = told.out.lines().next().unwrap_or_default();
    assert!(first.starts_with("first bad commit: ") && first.ends_with(WORSE), "{}", told.out);
    assert!(told.out.contains("diagnosis: mine cells="), "what it looks like: {}", told.out);
    assert!(told.out.contains("mine cells="), "what moved: {}", told.out);
    assert!(told.err.contains(" skip: Crash"), "{}", told.err);
    assert_eq!(git(at, &["status", "--porcelain"]), "", "the user's tree is as it was");
    // What neither builds nor runs is never blamed, though it is all that is left.
    let told = bisect(&["--bad", "HEAD~3"]);
    assert!(told.code == 4 && told.err.contains("no value differs between"), "{}{}", told.out, told.err);

    let told = call(at, &["history", "mine", "--format", "csv"]);
    let rows: Vec<&str> = told.out.lines().collect();
    assert!(told.code == 0 && rows.len() == 3, "{}{}", told.out, told.err);
    assert!(rows[2].contains("regressed") && rows[2].contains(WORSE), "{}", rows[2]);

    // Records of both ends, each with its own adapter: the study did not change, so only results did.
    assert_eq!(call(at, &["run", "mine/mine.toml", "--out", "out/after"]).code, 0);
    git(at, &["checkout", "-q", "HEAD~3"]);
    assert_eq!(call(at, &["run", "mine/mine.toml", "--out", "out/before"]).code, 0);
    let told = call(at, &["compare", "out/before", "out/after"]);
    let words = told.words();
    assert!(told.code == 1 && words.contains("regressed"), "{}{}", told.out, told.err);
    assert!(words.contains("mine cells=") && !words.contains("GC-SRI-patch implicit cells"), "{}", told.out);
    let told = call(at, &["compare", "good", "HEAD~1"]);
    assert_eq!(told.code, 0, "a rename is no change: {}{}", told.out, told.err);
}
