//! Folders of the crate use only those below them.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders and files of `src/` from the ground up; each uses only those before it, and itself.
const FLOORS: [&str; 13] = [
    "wide",
    "time_limit",
    "method",
    "formulation",
    "direct_solver",
    "state",
    "operators",
    "drag",
    "actions",
    "kernel",
    "integrate",
    "run",
    "scene",
];

/// What a source of a floor uses that stands above it; tests inside a source may look anywhere.
fn upward(floor: &str, source: &str) -> Vec<String> {
    let height = |name: &str| FLOORS.iter().position(|floor| *floor == name);
    let code = source.split("mod tests {").next().unwrap_or(source);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|path| path.split(|end: char| !end.is_alphanumeric() && end != '_').next().unwrap_or(path))
        .filter(|to| height(to).is_none_or(|to| Some(to) > height(floor)))
        .map(|to| format!("{floor} → {to}"))
        .collect()
}

fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources_below(&path) } else { vec![path] }).collect()
}

#[test]
fn no_floor_uses_one_above_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for path in sources_below(&root) {
        let inside = path.strip_prefix(&root).expect("below src");
        let is_test = inside.iter().any(|part| part == "tests" || part == "tests.rs");
        let floor = inside.iter().next().and_then(std::ffi::OsStr::to_str).expect("UTF-8");
        let floor = floor.trim_end_matches(".rs");
        if is_test || floor == "lib" {
            continue;
        }
        assert!(FLOORS.contains(&floor), "src/{floor} is no floor");
        let source = fs::read_to_string(&path).expect("a source");
        wrong.extend(upward(floor, &source).iter().map(|arrow| format!("{}: {arrow}", inside.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_arrow_is_named() {
    let planted = "use crate::state::grid::Grid;\nfn f() { crate::kernel::body::take() }\n";
    assert_eq!(upward("operators", planted), ["operators → kernel"]);
    assert_eq!(upward("run", "use crate::assembled::step;"), ["run → assembled"], "a folder that is gone");
    assert!(upward("state", "#[cfg(test)]\nmod tests {\n    use crate::scene::SceneKind;\n}\n").is_empty());
}
