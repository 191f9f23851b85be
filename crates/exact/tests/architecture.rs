//! No circle among the sources, and no arrow from the ground to a problem: what `use` lines say.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Sources that know no problem: each uses only those before it.
const GROUND: [&str; 9] = [
    "exact_error",
    "numerics",
    "soil_layers",
    "parameters",
    "inputs",
    "solution",
    "talbot",
    "porous_soil",
    "consolidation/series",
];
/// The door, which knows all problems, and which none of them knows.
const DOOR: [&str; 2] = ["reference", "lib"];

fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources_below(&path) } else { vec![path] }).collect()
}

/// Every source by its path without `.rs` and `/mod.rs`, with its text without tests.
fn sources() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = BTreeMap::new();
    for path in sources_below(&root) {
        let inside = path.strip_prefix(&root).expect("below src").to_string_lossy().replace('\\', "/");
        if inside.ends_with("tests.rs") {
            continue;
        }
        let name = inside.trim_end_matches(".rs").trim_end_matches("/mod").to_owned();
        let text = fs::read_to_string(&path).expect("a source");
        sources.insert(name, text.split("#[cfg(test)]").next().unwrap_or_default().to_owned());
    }
    sources
}

/// The steps of a path, up to what is no name.
fn steps(path: &str) -> Vec<String> {
    let name = |step: &str| {
        let end = step.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
        step[..end.unwrap_or(step.len())].to_owned()
    };
    path.trim().split("::").map(name).filter(|step| !step.is_empty()).collect()
}

/// The sources that a source uses: of `use` lines, and of paths in its code. `super` inside a module of the file is the file.
fn used(name: &str, text: &str, known: &BTreeSet<String>) -> BTreeSet<String> {
    let lines = || text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let code: String = lines().map(|line| line.replace("use super::", "use self_super::") + "\n").collect();
    let code = code.replace("\nuse self_super::", "\nuse super::");
    let above = steps(&name.replace('/', "::")).split_last().map_or(Vec::new(), |(_, above)| above.to_vec());
    let mut used = BTreeSet::new();
    for (marker, base) in [("crate::", Vec::new()), (" super::", above)] {
        for path in code.split(marker).skip(1) {
            let stem_end = path.find(|letter: char| !letter.is_alphanumeric() && !"_:".contains(letter));
            let (stem, rest) = path.split_at(stem_end.unwrap_or(path.len()));
            // Of `a::{b, c::d}` every branch.
            let inside = rest.strip_prefix('{').and_then(|rest| rest.split('}').next()).unwrap_or_default();
            for branch in inside.split(',') {
                let full = [base.clone(), steps(stem), steps(branch)].concat();
                // The longest path that is a source.
                let paths = (1..=full.len()).rev().map(|count| full[..count].join("/"));
                used.extend(paths.filter(|path| known.contains(path)).take(1));
            }
        }
    }
    used.remove(name);
    used
}

/// Which source uses which.
fn arrows(sources: &BTreeMap<String, String>) -> BTreeMap<String, BTreeSet<String>> {
    let known: BTreeSet<String> = sources.keys().cloned().collect();
    sources.iter().map(|(name, text)| (name.clone(), used(name, text, &known))).collect()
}

/// What a source reaches by the arrows.
fn reached(from: &str, arrows: &BTreeMap<String, BTreeSet<String>>) -> BTreeSet<String> {
    let (mut reached, mut next) = (BTreeSet::new(), vec![from.to_owned()]);
    while let Some(source) = next.pop() {
        next.extend(arrows[&source].iter().filter(|to| reached.insert((*to).clone())).cloned());
    }
    reached
}

/// Complaints: circles, arrows up from the ground, and arrows to the door.
fn wrong(sources: &BTreeMap<String, String>) -> Vec<String> {
    let arrows = arrows(sources);
    let mut wrong = Vec::new();
    for (from, to) in &arrows {
        if reached(from, &arrows).contains(from) {
            wrong.push(format!("{from} is in a circle"));
        }
        let floor = |name: &str| GROUND.iter().position(|ground| *ground == name);
        if let Some(level) = floor(from) {
            let up = to.iter().filter(|to| floor(to).is_none_or(|floor| floor >= level));
            wrong.extend(up.map(|to| format!("{from} → {to}")));
        }
        let is_door = DOOR.contains(&from.as_str());
        wrong.extend(
            to.iter().filter(|to| DOOR.contains(&to.as_str()) && !is_door).map(|to| format!("{from} → {to}")),
        );
    }
    wrong
}

#[test]
fn no_source_is_in_a_circle_and_the_ground_knows_no_problem() {
    let sources = sources();
    let missing: Vec<_> = GROUND.iter().chain(&DOOR).filter(|name| !sources.contains_key(**name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    let arrows = arrows(&sources);
    // What is known to be there is seen.
    for (from, to) in [
        ("layered", "talbot"),
        ("mandel/sums", "porous_soil"),
        ("shelf/cryer", "shelf/terms"),
        ("reference", "shelf"),
        ("dynamic_column", "dynamic_column/summation"),
        ("consolidation", "consolidation/series"),
    ] {
        assert!(arrows[from].contains(to), "{from} → {to}: {:?}", arrows[from]);
    }
    let wrong = wrong(&sources);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_circle_and_arrows_up_are_named() {
    for (name, line, complaint) in [
        ("parameters", "use crate::shelf::ShelfProblem;", "parameters → shelf"),
        (
            "solution",
            "use crate::{exact_error::ExactError, manufactured::Manufactured};",
            "solution → manufactured",
        ),
        ("layered", "fn f() { crate::reference::Reference::new(); }", "layered → reference"),
        ("dynamic_column/modes", "use super::summation::BLOCK;", "dynamic_column/modes is in a circle"),
        (
            "consolidation/series",
            "use crate::consolidation::isochrone;",
            "consolidation/series is in a circle",
        ),
    ] {
        let mut sources = sources();
        sources.get_mut(name).expect("a source").push_str(line);
        assert!(wrong(&sources).iter().any(|arrow| arrow == complaint), "{complaint}: {:?}", wrong(&sources));
    }
}
