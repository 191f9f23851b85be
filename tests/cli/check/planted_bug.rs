//! A bug planted in what an attached program is made of, after `run`: `check` fails on it, wherever the file lies and whoever
//! ignores it. Only a study that declares by what its program is known takes results over, and then says so.
#![cfg(unix)]

use crate::all_commands::place::git;
use crate::program::{Told, call, call_with};
use oedometer::{GoldenFile, Record, RecordStore};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// An adapter that leaves the table which three files elsewhere agree upon.
const ADAPTER: &str = r#"
echo run >> "$2/../runs"
. "$2/../package/law.sh"
. "$LAW"
[ "$("$2/../build/solve")" = good ] && [ "$law" = good ] && [ "$variable" = good ] && name=good || name=bad
cp "$2/$name.csv" "$1/result.csv"
"#;

const STUDY: &str = r#"title = "t"
scene = "terzaghi"
output = { time_factors = [0.1], references = ["terzaghi"] }

[[solver]]
name = "mine"
command = ["sh", "adapter.sh", "{out}", "{study}"]
result = "{out}/result.csv"
#DECLARED

[[sweep]]
method = ["mine"]
cells = [10]

[[expect_case]]
method = "mine"
quantity = "pressure"
time_factor = 0.1
error = { below = 1e-3 }
"#;

/// Where the study lies in its repository, if it is in one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    Repository,
    Worktree,
    Subfolder,
    NoGit,
}

/// A file whose change is a bug: one that the adapter imports, one that git ignores, one that a variable names.
const FILES: [(&str, &str, &str); 3] = [
    ("package/law.sh", "law=good\n", "law=bad\n"),
    ("build/solve", "#!/bin/sh\necho good\n", "#!/bin/sh\necho bad\n"),
    ("elsewhere/law.inc", "variable=good\n", "variable=bad\n"),
];

fn write(root: &Path, name: &str, text: &str) {
    let path = root.join(name);
    fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    fs::write(&path, text).expect("a file");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("runs");
}

/// The exact pressures at eleven heights, and those of a soil that is three per cent more permeable.
fn tables(at: &Path) -> [String; 2] {
    [0.1, 0.103].map(|factor: f64| {
        let zeta: Vec<String> = (0..=10).map(|row| format!("{}", f64::from(row) / 10.0)).collect();
        let words = ["exact", "terzaghi", "--time-factor", &factor.to_string(), "--zeta", &zeta.join(",")];
        let told = call(at, &words);
        let row = |line: &str| {
            let numbers: Vec<f64> = line.split(',').map(|word| word.parse().expect("a number")).collect();
            format!("8.175,{},{},0\n", 1.0 - numbers[1], numbers[2])
        };
        "t,y,p,u_y\n".to_owned() + &told.out.lines().skip(1).map(row).collect::<String>()
    })
}

/// A sound study with its program: the root of both, and the folder in which commands are called.
struct Place {
    root: PathBuf,
    here: PathBuf,
    study: &'static str,
}

impl Place {
    fn new(top: &Path, layout: Layout, declared: &str) -> Self {
        let inner = if layout == Layout::Repository { "main" } else { "main/deep" };
        let root = top.join(inner);
        let [good, bad] = tables(top);
        for (name, text) in [("good.csv", &good), ("bad.csv", &bad)] {
            write(&root, &format!("study/{name}"), text);
        }
        write(&root, "study/adapter.sh", ADAPTER);
        write(&root, "study/s.toml", &STUDY.replace("#DECLARED", declared));
        write(&root, ".gitignore", "/build/\n/out/\n/runs\n");
        for (name, text, _) in FILES {
            write(&root, name, text);
        }
        if layout == Layout::NoGit {
            return Self { here: root.join("study"), root, study: "s.toml" };
        }
        let repository = top.join("main");
        git(&repository, &["init", "-q"]);
        git(&repository, &["add", "-A"]);
        git(&repository, &["commit", "-qm", "sound"]);
        if layout == Layout::Worktree {
            git(&repository, &["worktree", "add", "-q", "../tree"]);
            let tree = top.join("tree/deep");
            // Compiled there too: git has no copy of it.
            write(&tree, FILES[1].0, FILES[1].1);
            return Self { here: tree.clone(), root: tree, study: "study/s.toml" };
        }
        Self { here: root.clone(), root, study: "study/s.toml" }
    }

    fn call(&self, is_ci: bool, words: &[&str]) -> Told {
        let law = self.root.join(FILES[2].0).display().to_string();
        let ci = if is_ci { "true" } else { "" };
        call_with(&self.here, &[("LAW", &law), ("CI", ci)], words)
    }

    /// Runs the study and takes its values as golden ones, which `accept` does from committed sources alone.
    fn run_and_accept(&self) {
        let told = self.call(false, &["run", self.study]);
        assert_eq!(told.code, 0, "{}", told.err);
        let store = RecordStore::new(&self.here.join("out"), "s");
        let records: Vec<Record> = store.hashes().iter().filter_map(|hash| store.read(hash)).collect();
        GoldenFile::of("s", &records, "sound").write(&self.root.join("study/golden")).expect("written");
    }

    fn runs(&self) -> usize {
        fs::read_to_string(self.root.join("runs")).map_or(0, |text| text.lines().count())
    }
}

#[test]
fn a_bug_that_is_planted_after_a_run_fails_the_check() {
    for layout in [Layout::Repository, Layout::Worktree, Layout::Subfolder, Layout::NoGit] {
        let top = TempDir::new().expect("a folder");
        let place = Place::new(top.path(), layout, "");
        place.run_and_accept();
        let told = place.call(false, &["check", place.study]);
        assert_eq!(told.code, 0, "{layout:?}: {}{}", told.out, told.err);
        for (name, sound, bug) in FILES {
            write(&place.root, name, bug);
            for is_ci in [false, true] {
                let told = place.call(is_ci, &["check", place.study]);
                assert_eq!(told.code, 1, "{layout:?} {name} {is_ci}: {}{}", told.out, told.err);
                assert!(told.words().contains("0 of 1 expectations met"), "{layout:?} {name}: {}", told.out);
            }
            write(&place.root, name, sound);
        }
        assert_eq!(place.call(true, &["check", place.study]).code, 0, "{layout:?}: all is as it was");
    }
}

#[test]
fn a_resumed_run_keeps_what_nothing_proves_only_where_it_is_asked_to_and_says_so() {
    let top = TempDir::new().expect("a folder");
    let place = Place::new(top.path(), Layout::Repository, "version = [\"echo\", \"mine 1.2\"]");
    assert_eq!(place.call(false, &["run", place.study]).code, 0);
    let resumed = |more: &[&str]| {
        let before = place.runs();
        let told = place.call(false, &[&["run", place.study, "--resume"], more].concat());
        assert_eq!(told.code, 0, "{}", told.err);
        (place.runs() - before, told.err)
    };
    let (runs, told) = resumed(&["--keep-unproven"]);
    let words = "`mine` was not run: 1 result reused (mine cells=10), made by `mine 1.2`, `sh adapter.sh";
    assert!(runs == 0 && told.contains(words) && told.contains("nothing proves"), "{told}");
    let (runs, told) = resumed(&[]);
    assert!(runs == 1 && told.contains("not reused") && told.contains("--keep-unproven"), "{told}");
    // A page shows what there is, and says that, and what made it.
    git(&place.root, &["commit", "-qm", "another", "--allow-empty"]);
    write(&place.root, FILES[0].0, FILES[0].2);
    let told = place.call(false, &["report", place.study, "--out", "pages"]);
    let page = fs::read_to_string(place.root.join("pages/README.md")).expect("a page");
    let commit =
        Command::new("git").arg("-C").arg(&place.root).args(["rev-parse", "--short=8", "HEAD~1"]).output();
    let commit = String::from_utf8(commit.expect("git").stdout).expect("letters");
    let made = format!("at commit {}", commit.trim());
    assert!(told.err.contains("nothing proves") && page.contains("nothing proves"), "{}\n{page}", told.err);
    assert!(page.contains(&made) && told.err.contains(&made), "{}\n{page}", told.err);
    let told = place.call(false, &["compare", "out", "out"]);
    assert!(told.out.contains(&made) && told.out.contains("mine 1.2"), "{}", told.out);
}

#[test]
fn what_is_declared_is_taken_over_by_name_until_a_part_of_it_changes() {
    let declared = "reuse = \"version\"\nversion = [\"cat\", \"version.txt\"]\nknown_by = [\"../package\", \"../build/solve\"]";
    for layout in [Layout::Worktree, Layout::NoGit] {
        let top = TempDir::new().expect("a folder");
        let place = Place::new(top.path(), layout, declared);
        write(&place.root, "study/version.txt", "1.2\n");
        place.run_and_accept();
        let check = |is_ci: bool| {
            let before = place.runs();
            let told = place.call(is_ci, &["check", place.study, "--junit", "j.xml"]);
            let is_named = told.words().contains("mine was not run: 1 result reused (mine cells=10)");
            let junit = fs::read_to_string(place.here.join("j.xml")).expect("JUnit");
            assert_eq!(is_named, junit.contains("1 result reused (mine cells=10)"), "{junit}");
            assert_eq!(is_named, place.runs() == before, "{}", told.out);
            (told.code, is_named)
        };
        for is_ci in [false, true] {
            assert_eq!(check(is_ci), (0, true), "{layout:?}");
            for (name, sound, bug) in [FILES[0], FILES[1]] {
                write(&place.root, name, bug);
                assert_eq!(check(is_ci), (1, false), "{layout:?} {name}");
                write(&place.root, name, sound);
            }
            write(&place.root, "study/version.txt", "1.2\ncommit 2\n");
            assert_eq!(check(is_ci), (0, false), "{layout:?}: another version, the same result");
            write(&place.root, "study/version.txt", "1.2\n");
        }
        for format in ["csv", "json", "markdown"] {
            let told = place.call(false, &["check", place.study, "--format", format]);
            assert!(told.out.contains("mine cells=10"), "{format}: {}", told.out);
        }
        let fresh = place.call(false, &["check", place.study, "--fresh"]);
        assert!(fresh.code == 0 && !fresh.out.contains(" reused ("), "{}", fresh.out);
        // A page names it too, and a run that goes on takes it over without a flag.
        let before = place.runs();
        let told = place.call(false, &["run", place.study, "--resume"]);
        assert!(told.err.contains("whose version and named files are unchanged"), "{}", told.err);
        place.call(false, &["report", place.study, "--out", "pages"]);
        let page = fs::read_to_string(place.here.join("pages/README.md")).expect("a page");
        assert!(page.contains("1 result reused (mine cells=10)") && place.runs() == before, "{page}");
    }
}

#[test]
fn a_declaration_that_says_nothing_is_refused_at_its_place() {
    for (declared, code, words) in [
        ("reuse = \"version\"", 2, "`reuse` needs something that identifies the program"),
        ("reuse = \"always\"", 2, "version"),
        ("known_by = [\"../package\"]", 2, "`known_by` has no effect without `reuse`"),
        ("reuse = \"version\"\nknown_by = [\"../packages\"]", 2, "there is no file or folder"),
        ("reuse = \"version\"\nknown_by = [\"{study}/../package\"]", 0, ""),
        ("reuse = \"version\"\nversion = [\"echo\", \"1\"]", 0, ""),
    ] {
        let top = TempDir::new().expect("a folder");
        let place = Place::new(top.path(), Layout::NoGit, declared);
        let told = place.call(false, &["plan", place.study]);
        assert!(told.code == code && told.err.contains(words), "{declared}: {} {}", told.code, told.err);
    }
}
