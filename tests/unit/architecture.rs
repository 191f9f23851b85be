//! The arrows of the house: which folder of `src/` may import which.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders from the ground up; a folder may import what its row names, and nothing else.
const MAY_IMPORT: [(&str, &str); 16] = [
    ("soil", "elementary"),
    ("exact", "elementary soil"),
    ("convergence", "elementary wording"),
    ("mpm", "elementary soil"),
    ("scene", "elementary exact mpm soil"),
    ("case", "elementary exact mpm scene soil"),
    ("record", "case mpm"),
    ("measure", "case elementary exact mpm record scene soil wording"),
    ("study", "case convergence elementary exact mpm record scene soil wording"),
    ("campaign", "case elementary exact measure mpm record scene study"),
    ("golden", "convergence elementary exact record study"),
    ("import", "case study"),
    (
        "judge",
        "campaign case convergence elementary exact golden import measure mpm record scene soil study wording",
    ),
    ("render", "case convergence elementary exact golden judge measure record study wording"),
    ("schema", "import record study"),
    (
        "cli",
        "campaign case exact golden import judge measure mpm record render scene schema soil study wording",
    ),
];

/// Every arrow of a source that its folder's row does not name; tests inside it may look anywhere.
fn forbidden(folder: &str, allowed: &str, source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or(source);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        // A macro stands at the root of the crate, and so does what it expands to.
        .filter(|path| {
            let is_macro = ["with_basis", "words!"].iter().any(|name| path.starts_with(name));
            !is_macro && !path.starts_with(char::is_uppercase) && !path.starts_with('$')
        })
        .map(|path| path.split(|end: char| !end.is_alphanumeric() && end != '_').next().unwrap_or(path))
        .filter(|to| *to != folder && !allowed.split(' ').any(|name| name == *to))
        .map(|to| format!("{folder} → {to}"))
        .collect()
}

fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources_below(&path) } else { vec![path] }).collect()
}

#[test]
fn no_folder_imports_one_above_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for (folder, allowed) in MAY_IMPORT {
        for path in sources_below(&root.join(folder))
            .iter()
            .filter(|path| path.extension().is_some_and(|x| x == "rs"))
        {
            let source = fs::read_to_string(path).expect("a source");
            wrong.extend(
                forbidden(folder, allowed, &source)
                    .iter()
                    .map(|arrow| format!("{}: {arrow}", path.display())),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_folder_has_a_row_and_no_two_import_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in fs::read_dir(root)
        .expect("src")
        .map(|entry| entry.expect("an entry"))
        .filter(|entry| entry.path().is_dir())
    {
        let name = entry.file_name().into_string().expect("a name");
        assert!(MAY_IMPORT.iter().any(|(folder, _)| *folder == name), "src/{name}/ has no row");
    }
    for (at, (folder, _)) in MAY_IMPORT.iter().enumerate() {
        for (above, row) in &MAY_IMPORT[..at] {
            assert!(!row.split(' ').any(|name| name == *folder), "{above} → {folder} goes up");
        }
    }
}

#[test]
fn a_planted_arrow_is_named() {
    let planted = "use crate::exact::Reference;\nfn f() { crate::judge::explanation::explain() }\n";
    assert_eq!(forbidden("mpm", "elementary soil", planted), ["mpm → exact", "mpm → judge"]);
    let in_a_test = "fn f() {}\n\n#[cfg(test)]\nmod tests {\n    use crate::scene::SceneKind;\n}\n";
    assert!(forbidden("mpm", "elementary soil", in_a_test).is_empty());
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
