//! The arrows of the house: which folder of `src/` may import which.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Folders from the ground up; a folder may import what its row names, and nothing else.
const MAY_IMPORT: [(&str, &str); 19] = [
    ("soil", "elementary wording"),
    ("exact", "elementary soil wording"),
    ("convergence", "elementary sorting wording"),
    ("mpm", "elementary soil wording"),
    ("scene", "elementary exact mpm soil wording"),
    ("case", "convergence elementary exact mpm scene soil wording"),
    ("record", "case mpm wording"),
    ("measure", "case elementary exact mpm record scene soil wording"),
    ("formats", ""),
    ("study", "case convergence elementary exact formats mpm record scene soil wording"),
    ("import", "case formats sorting study wording"),
    ("foreign", "case elementary exact formats import measure mpm record scene soil study wording"),
    ("campaign", "case elementary exact foreign measure mpm record scene sorting study wording"),
    ("golden", "convergence elementary exact record sorting study"),
    (
        "judge",
        "campaign case convergence elementary exact golden import measure mpm record scene soil sorting study wording",
    ),
    ("render", "case convergence elementary exact golden judge measure record sorting study wording"),
    ("schema", "foreign import record study"),
    (
        "cli",
        "campaign case exact foreign formats golden import judge measure mpm record render scene schema soil sorting study wording",
    ),
    ("api", "case cli convergence exact formats import judge scene sorting study"),
];

/// Every arrow of a source that its folder's row does not name; tests inside it may look anywhere.
fn forbidden(folder: &str, allowed: &str, source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or(source);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
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
    assert_eq!(forbidden("mpm", "elementary soil wording", planted), ["mpm → exact", "mpm → judge"]);
    let in_a_test = "fn f() {}\n\n#[cfg(test)]\nmod tests {\n    use crate::scene::SceneKind;\n}\n";
    assert!(forbidden("mpm", "elementary soil wording", in_a_test).is_empty());
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

/// The module of a source below `src/`, as a path: `exact/reference`.
fn module_of(file: &Path, root: &Path) -> String {
    let path = file.strip_prefix(root).expect("below src").with_extension("");
    let name = path.to_str().expect("UTF-8").replace('\\', "/");
    name.strip_suffix("/mod").unwrap_or(&name).to_owned()
}

/// Every path of a `use` tree, written out: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn written_out(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap_or(tree).trim().to_owned()];
    };
    let inner = rest.trim_end().strip_suffix('}').expect("a closed tree");
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for letter in inner.chars() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        if letter == ',' && depth == 0 {
            parts.push(String::new());
        } else {
            parts.last_mut().expect("one at least").push(letter);
        }
    }
    let parts = parts.iter().map(|part| part.trim()).filter(|part| !part.is_empty());
    parts.flat_map(written_out).map(|path| format!("{}{path}", head.trim())).collect()
}

/// What each module imports: the file that defines an item. A folder that only hands an item on by `pub use`
/// does not import it.
fn imports(sources: &BTreeMap<String, String>) -> BTreeMap<String, BTreeSet<String>> {
    let mut handed_on = BTreeMap::new();
    let mut named = BTreeMap::new();
    for (module, source) in sources {
        let code = source.split("#[cfg(test)]\nmod tests").next().unwrap_or(source);
        let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let parts: Vec<&str> = code.split("crate::").collect();
        let mut paths = Vec::new();
        for pair in parts.windows(2) {
            let end_of_path = |letter: char| !letter.is_alphanumeric() && letter != '_' && letter != ':';
            let end = if pair[0].ends_with("use ") { pair[1].find(';') } else { pair[1].find(end_of_path) };
            for path in written_out(&pair[1][..end.unwrap_or(pair[1].len())]) {
                let path = path.replace("::", "/");
                if pair[0].ends_with("pub use ") || pair[0].ends_with(") use ") {
                    let item = path.rsplit('/').next().unwrap_or(&path);
                    handed_on.insert(format!("{module}/{item}"), path);
                } else {
                    paths.push(path);
                }
            }
        }
        // A folder names its own files without `crate::`.
        let children = sources.keys().filter_map(|other| other.strip_prefix(&format!("{module}/")));
        for child in children.filter(|child| !child.contains('/')) {
            let prefix = format!("{child}::");
            let stands_alone =
                |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
            if code.match_indices(&prefix).any(|(at, _)| stands_alone(at)) {
                paths.push(format!("{module}/{child}"));
            }
        }
        named.insert(module.clone(), paths);
    }
    let defined_in = |path: &str| {
        let path = handed_on.get(path).map_or(path, String::as_str);
        path.match_indices('/')
            .map(|(end, _)| &path[..end])
            .chain([path])
            .rfind(|&module| sources.contains_key(module))
            .map(str::to_owned)
    };
    named
        .into_iter()
        .map(|(module, paths)| {
            let others =
                paths.iter().filter_map(|path| defined_in(path)).filter(|other| *other != module).collect();
            (module, others)
        })
        .collect()
}

/// Modules that import each other, also around corners; every circle once, as the modules on it.
fn circles(imports: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let reaches = |from: &str| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(module) = open.pop() {
            for next in imports.get(module).into_iter().flatten() {
                if seen.insert(next.as_str()) {
                    open.push(next);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        imports.keys().map(|module| (module.as_str(), reaches(module))).collect();
    let on_a_circle = reached.iter().filter(|(module, others)| others.contains(*module));
    let circles: BTreeSet<String> = on_a_circle
        .map(|(module, others)| {
            let members: Vec<&str> =
                others.iter().copied().filter(|other| reached[other].contains(module)).collect();
            members.join(", ")
        })
        .collect();
    circles.into_iter().collect()
}

#[test]
fn no_files_import_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files = sources_below(&root).into_iter().filter(|path| path.extension().is_some_and(|x| x == "rs"));
    let sources: BTreeMap<String, String> = files
        .map(|file| (module_of(&file, &root), fs::read_to_string(&file).expect("a source")))
        .filter(|(module, _)| module != "lib" && module != "main")
        .collect();
    let imports = imports(&sources);
    assert!(imports["mpm/explicit"].contains("mpm/body"), "the paths are not read");
    assert_eq!(circles(&imports), Vec::<String>::new());
}

#[test]
fn a_planted_circle_is_named() {
    let source = |text: &str| text.to_owned();
    let mut sources = BTreeMap::from([
        (source("a"), source("mod b;\npub use crate::a::b::B;\n")),
        (source("a/b"), source("use crate::c::{C, d::D};\n")),
        (source("c"), source("fn f() { crate::e::g() }\n")),
        (source("c/d"), source("")),
        (source("e"), source("")),
    ]);
    assert!(circles(&imports(&sources)).is_empty());
    sources.insert(source("e"), source("use crate::a::B;\n"));
    assert_eq!(circles(&imports(&sources)), ["a/b, c, e"]);
    sources.insert(source("e"), source("use crate::a::A;\n"));
    assert!(circles(&imports(&sources)).is_empty());
    sources.insert(source("a"), source("mod b;\npub struct A;\nfn f() { b::g() }\n"));
    assert_eq!(circles(&imports(&sources)), ["a, a/b, c, e"]);
}
