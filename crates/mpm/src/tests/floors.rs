//! Folders of the crate use only those below them, and no sources each other in a circle.

use std::collections::{BTreeMap, BTreeSet};
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

/// Every source but the root and tests, by its path without `.rs` and `/mod.rs`, with its code.
fn sources() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = BTreeMap::new();
    for path in sources_below(&root) {
        let inside = path.strip_prefix(&root).expect("below src").to_string_lossy().replace('\\', "/");
        let name = inside.trim_end_matches(".rs").trim_end_matches("/mod").to_owned();
        if name != "lib" && !name.split('/').any(|part| part == "tests") {
            let text = fs::read_to_string(&path).expect("a source");
            sources.insert(name, text.split("mod tests {").next().unwrap_or_default().to_owned());
        }
    }
    sources
}

/// The sources that a code uses, by the paths from the root of the crate in it.
fn used(name: &str, code: &str, known: &BTreeMap<String, String>) -> BTreeSet<String> {
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let mut used = BTreeSet::new();
    for path in code.split("crate::").skip(1) {
        let end = path.find(|letter: char| !letter.is_alphanumeric() && !"_:".contains(letter));
        let (stem, rest) = path.split_at(end.unwrap_or(path.len()));
        // Of `a::{b, c::d}` every branch.
        let inside = rest.strip_prefix('{').and_then(|rest| rest.split('}').next()).unwrap_or_default();
        for branch in inside.split(',') {
            let full = [stem, branch.trim()].join("::");
            let steps: Vec<&str> = full.split("::").filter(|step| !step.is_empty()).collect();
            let paths = (1..=steps.len()).rev().map(|count| steps[..count].join("/"));
            // The longest path that is a source.
            used.extend(paths.filter(|path| known.contains_key(path)).take(1));
        }
    }
    used.remove(name);
    used
}

/// Sources that reach themselves by what they use.
fn in_circles(sources: &BTreeMap<String, String>) -> Vec<String> {
    let arrows: BTreeMap<&String, BTreeSet<String>> =
        sources.iter().map(|(name, code)| (name, used(name, code, sources))).collect();
    let is_in_a_circle = |source: &&String| {
        let (mut reached, mut next) = (BTreeSet::new(), vec![(*source).clone()]);
        while let Some(from) = next.pop() {
            next.extend(arrows[&from].iter().filter(|to| reached.insert((*to).clone())).cloned());
        }
        reached.contains(*source)
    };
    sources.keys().filter(is_in_a_circle).cloned().collect()
}

#[test]
fn no_sources_use_each_other_in_a_circle() {
    let sources = sources();
    // What is known to be there is seen.
    for (from, to) in [
        ("kernel/step", "kernel/body"),
        ("operators/basis", "operators/row"),
        ("run", "integrate/schedule"),
        ("integrate/implicit/newton", "integrate/implicit"),
    ] {
        assert!(used(from, &sources[from], &sources).contains(to), "{from} → {to}");
    }
    assert_eq!(in_circles(&sources), [""; 0]);
}

#[test]
fn a_planted_circle_is_named() {
    for (planted, line, others) in [
        ("operators/row", "use crate::operators::basis::Hat;", &["operators/basis"][..]),
        (
            "integrate/step_rule",
            "use crate::integrate::{integrator::IntegratorKind};",
            &["integrate/integrator"],
        ),
        ("state/grid", "fn f() { crate::state::cells::take() }", &["state/cells"]),
    ] {
        let mut sources = sources();
        sources.get_mut(planted).expect("a source").push_str(line);
        let named = in_circles(&sources);
        for source in others.iter().chain([&planted]) {
            assert!(named.iter().any(|name| name == source), "{source}: {named:?}");
        }
    }
}
