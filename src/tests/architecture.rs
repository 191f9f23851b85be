//! What the borders of the crates cannot say: which folder of `src/` uses which.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders of `src/` from the ground up; each uses only those before it.
const FOLDERS: [&str; 13] = [
    "case", "record", "measure", "study", "import", "foreign", "campaign", "golden", "history", "judge",
    "render", "api", "cli",
];

/// Whether a source is compiled for tests alone.
fn is_test_module(path: &Path) -> bool {
    path.iter().any(|part| part == "tests" || part == "tests.rs")
}

/// Every folder that a source uses and that stands above its own; tests inside a source may look anywhere.
fn upward(folder: &str, source: &str) -> Vec<String> {
    let own = FOLDERS.iter().position(|name| *name == folder);
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or(source);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|path| path.split(|end: char| !end.is_alphanumeric() && end != '_').next().unwrap_or(path))
        .filter(|to| FOLDERS.iter().position(|name| name == to) > own)
        .map(|to| format!("{folder} → {to}"))
        .collect()
}

fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let files = entries.flat_map(|path| if path.is_dir() { sources_below(&path) } else { vec![path] });
    files.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

#[test]
fn folders_use_only_those_below_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for path in sources_below(&root) {
        let inside = path.strip_prefix(&root).expect("below src");
        let folder = inside.iter().next().and_then(std::ffi::OsStr::to_str).expect("UTF-8");
        if inside.components().count() == 1 || is_test_module(inside) {
            continue;
        }
        assert!(FOLDERS.contains(&folder), "src/{folder}/ is not in the list");
        let source = fs::read_to_string(&path).expect("a source");
        wrong.extend(upward(folder, &source).iter().map(|arrow| format!("{}: {arrow}", path.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_arrow_is_named() {
    let planted = "use crate::case::Case;\nfn f() { crate::judge::explanation::explain() }\n";
    assert_eq!(upward("record", planted), ["record → judge"]);
    let in_a_test = "fn f() {}\n\n#[cfg(test)]\nmod tests {\n    use crate::judge::verdict;\n}\n";
    assert!(upward("record", in_a_test).is_empty());
}

/// The tables of equations and steps on the crate's front page name functions that are there.
#[test]
fn every_equation_and_step_has_its_function() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("src/lib.rs")).expect("lib.rs");
    let places: Vec<(&str, &str)> = page
        .lines()
        .filter(|line| line.starts_with("//! |"))
        .flat_map(|line| line.split('`').skip(1).step_by(2))
        .filter_map(|code| code.split_once(".rs:"))
        .collect();
    assert!(places.len() > 20, "{} places", places.len());
    for (file, function) in places {
        let source = fs::read_to_string(root.join(format!("{file}.rs"))).expect(file);
        assert!(source.contains(&format!("fn {function}")), "{file}.rs has no function {function}");
    }
}

/// Every reader of somebody else's files goes through this one.
#[test]
fn no_reader_opens_files_by_itself() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut readers = vec![
        root.join("foreign/reading.rs"),
        root.join("cli/cost_files.rs"),
        root.join("study/check/check_solver.rs"),
    ];
    for folder in [
        "../crates/formats/src",
        "import",
        "import/mapping",
        "judge/score",
        "cli/commands/score",
        "cli/slurm",
    ] {
        let entries = fs::read_dir(root.join(folder)).expect("a folder");
        readers.extend(entries.map(|entry| entry.expect("an entry").path()));
    }
    for path in readers
        .iter()
        .filter(|path| path.is_file() && !path.ends_with("input_file.rs") && !is_test_module(path))
    {
        let text = fs::read_to_string(path).expect("a file");
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for opening in ["File::open", "fs::read(", "read_to_string("] {
            assert!(!code.contains(opening), "{} has `{opening}`", path.display());
        }
    }
}
