//! What the borders of the crates and `source_order` cannot say: what pages ask of the judge, where files are opened, and which
//! types errors have.

use regex_lite::Regex;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Whether a source is compiled for tests alone.
pub(super) fn is_test_module(path: &Path) -> bool {
    path.iter().any(|part| part == "tests" || part == "tests.rs")
}

/// Every source below a folder.
pub(super) fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let files = entries.flat_map(|path| if path.is_dir() { sources_below(&path) } else { vec![path] });
    files.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// What pages may ask of values of the judge: words of an enumeration, and look-ups that return what a finding holds.
const ACCESSORS: [&str; 12] = [
    // Words.
    "name",
    "words",
    "label",
    "sentence",
    // Look-ups in the findings of the race, and in a check of a study.
    "answer",
    "curves",
    "error_in",
    "families",
    "largest_error",
    "profiles",
    "differences",
    "end",
];

/// Mechanics, measures and statistics that `render` does not name either.
const COMPUTING: [&str; 8] = [
    "crate::measure",
    "crate::exact",
    "oedometer_exact",
    "column_parameters",
    "oedometer_soil::material",
    "ErrorSeries",
    ".sqrt()",
    ".median(",
];

/// A source without its comments and without the tests inside it.
fn code_of(source: &str) -> String {
    let code = source.split("#[cfg(test)]\nmod tests").next().unwrap_or(source);
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    code.lines().filter(is_code).collect::<Vec<_>>().join("\n")
}

/// Names of the functions that a source of the judge offers, methods among them.
fn functions_of(source: &str) -> BTreeSet<String> {
    let offered = Regex::new(r"pub(\([a-z]+\))? (const )?fn (\w+)").expect("a pattern");
    offered.captures_iter(&code_of(source)).map(|found| found[3].to_owned()).collect()
}

/// Every call of a function of the judge that a source of `render` makes, but for accessors: by an imported name, by the name
/// of an imported type or module, by its whole path, or as a method.
fn calls_of_the_judge(source: &str, functions: &BTreeSet<String>) -> Vec<String> {
    let code = code_of(source);
    let import = Regex::new(r"(?m)^(pub )?use (crate::judge[^;]*);").expect("a pattern");
    let leaf = Regex::new(r"(\w+)(\s+as\s+\w+)?\s*(,|\}|$)").expect("a pattern");
    let uses: Vec<String> = import.captures_iter(&code).map(|found| found[2].to_owned()).collect();
    let folder = Regex::new(r"(\w+)::\{\s*self\b").expect("a pattern");
    let body = import.replace_all(&code, "").into_owned();
    let ends = |line: &String| {
        let both = leaf.captures_iter(line).chain(folder.captures_iter(line));
        both.map(|found| found[1].to_owned()).collect::<Vec<_>>()
    };
    let leaves: BTreeSet<String> = uses.iter().flat_map(ends).collect();
    let is_call = |name: &str| functions.contains(name) && !ACCESSORS.contains(&name);
    let mut calls: Vec<String> =
        leaves.iter().filter(|leaf| is_call(leaf)).map(|leaf| format!("use {leaf}")).collect();
    let named = Regex::new(r"(\w+)::(\w+)").expect("a pattern");
    for found in named.captures_iter(&body) {
        if leaves.contains(&found[1]) && is_call(&found[2]) {
            calls.push(found[0].to_owned());
        }
    }
    let whole = Regex::new(r"crate::judge(::\w+)*::(\w+)").expect("a pattern");
    calls.extend(
        whole.captures_iter(&body).filter(|found| is_call(&found[2])).map(|found| found[0].to_owned()),
    );
    // Where no value of the judge is named there is no method of one.
    if code.contains("crate::judge") {
        let method = Regex::new(r"\.(\w+)\(").expect("a pattern");
        calls.extend(
            method.captures_iter(&body).filter(|found| is_call(&found[1])).map(|found| found[0].to_owned()),
        );
    }
    calls
}

/// Pages, tables and the terminal take values that the judge has made: `render` calls none of its functions, and neither
/// measures nor solves anything. Drawing has a geometry of its own.
#[test]
fn render_prints_what_the_judge_has_found_and_asks_it_nothing() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let read = |path: &PathBuf| fs::read_to_string(path).expect("a source");
    let judge = sources_below(&root.join("judge"));
    let judge = judge.iter().filter(|path| !is_test_module(path));
    let functions: BTreeSet<String> = judge.flat_map(|path| functions_of(&read(path))).collect();
    assert!(functions.len() > 100, "{}", functions.len());
    let mut wrong = Vec::new();
    for path in sources_below(&root.join("render")) {
        let inside = path.strip_prefix(&root).expect("below src");
        if is_test_module(inside) {
            continue;
        }
        let source = read(&path);
        let mut found = calls_of_the_judge(&source, &functions);
        if !inside.starts_with("render/chart") {
            let code = code_of(&source);
            let lines = code.lines().filter(|line| COMPUTING.iter().any(|word| line.contains(word)));
            found.extend(lines.map(str::to_owned));
        }
        wrong.extend(found.iter().map(|call| format!("{}: {call}", inside.display())));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_planted_call_of_the_judge_is_named_however_it_is_made() {
    let functions =
        functions_of("pub fn compare() {}\npub(crate) const fn of() {}\npub fn name(self) {}\nfn own() {}\n");
    let named = |functions: &BTreeSet<String>| functions.iter().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(named(&functions), "compare name of");
    for (planted, call) in [
        ("use crate::judge::peers::{self, Peer};\nfn f() { peers::compare() }\n", "peers::compare"),
        ("use crate::judge::{\n    a::Sweep,\n    b::X,\n};\nfn f() { x.map(Sweep::of) }\n", "Sweep::of"),
        ("use crate::judge::peers::compare;\n", "use compare"),
        ("use crate::judge::peers::compare as with;\n", "use compare"),
        ("fn f() { crate::judge::peers::compare() }\n", "crate::judge::peers::compare"),
        ("use crate::judge::Peer;\nfn f(peer: &Peer) { peer.compare() }\n", ".compare("),
    ] {
        assert_eq!(calls_of_the_judge(planted, &functions), [call], "{planted}");
    }
    for sound in [
        "use crate::judge::compare::Peer;\nfn f(peer: &Peer) { Chart::of(peer.name()) }\n",
        "fn f() { x.compare() }\n",
        "#[cfg(test)]\nmod tests {\n    use crate::judge::peers::compare;\n}\n",
    ] {
        assert!(calls_of_the_judge(sound, &functions).is_empty(), "{sound}");
    }
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
        root.join("../crates/foreign/src/reading.rs"),
        root.join("cli/cost_files.rs"),
        root.join("study/check/check_solver.rs"),
    ];
    for folder in [
        "../crates/formats/src",
        "../crates/foreign/src/import",
        "../crates/foreign/src/import/mapping",
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

/// Lines of a source that make an error an enum without saying that it may grow, or give a sentence in its place.
fn rigid_errors(source: &str, is_public: bool) -> Vec<String> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or(source);
    let lines: Vec<&str> = code.lines().map(str::trim_start).collect();
    let attributes = |place: usize| lines[..place].iter().rev().take_while(|line| line.starts_with("#["));
    let derives_error = |line: &&&str| line.starts_with("#[derive") && line.contains("Error)");
    let rigid = |place: &usize| {
        lines[*place].starts_with("pub enum ")
            && attributes(*place).any(|line| derives_error(&line))
            && !attributes(*place).any(|line| *line == "#[non_exhaustive]")
    };
    let is_sentence = |place: &usize| {
        is_public
            && lines[*place].starts_with("pub fn ")
            && lines[*place].contains(", String> {")
            && lines[*place].contains("Result<")
    };
    (0..lines.len())
        .filter(|place| rigid(place) || is_sentence(place))
        .map(|place| lines[place].to_owned())
        .collect()
}

/// Others match on our errors: a new kind breaks none of them, and no sentence has to be parsed.
#[test]
fn errors_have_types_that_may_grow() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = sources_below(&root.join("src"));
    for folder in ["case", "convergence", "exact", "foreign", "formats", "mpm", "soil"] {
        sources.extend(sources_below(&root.join("crates").join(folder).join("src")));
    }
    let mut wrong = Vec::new();
    for path in sources.iter().filter(|path| !is_test_module(path)) {
        let inside = path.strip_prefix(root).expect("below the root");
        // Folders of `src/` that other programs see, and the crates that are theirs to use.
        let is_public = ["crates", "src/api", "src/golden"].iter().any(|open| inside.starts_with(open));
        let source = fs::read_to_string(path).expect("a source");
        wrong.extend(
            rigid_errors(&source, is_public).iter().map(|line| format!("{}: {line}", inside.display())),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let planted = "#[derive(Debug, thiserror::Error)]\npub enum E {}\npub fn f() -> Result<u8, String> {\n";
    assert_eq!(rigid_errors(planted, true).len(), 2);
    assert_eq!(rigid_errors(planted, false).len(), 1);
    assert!(rigid_errors(&planted.replace("pub enum", "#[non_exhaustive]\npub enum"), false).is_empty());
}

#[test]
fn an_error_leads_to_what_caused_it() {
    use crate::case::{Case, Task};
    use crate::golden::GoldenFile;
    use crate::golden::text_error::{CellError, GoldenTextError};
    use std::error::Error;

    let case = Case::seed(Task::Solve, oedometer_mpm::scene::SceneKind::Terzaghi);
    let refused = crate::campaign::runner::RunError::refused(&case, crate::exact::ExactError::Depth(2.0));
    let source = refused.source().and_then(|source| source.downcast_ref());
    assert_eq!(source, Some(&crate::exact::ExactError::Depth(2.0)));

    let folder = tempfile::TempDir::new().expect("a folder");
    let text = GoldenFile::of("s", &[], "r").to_text().expect("a text") + "a,,b\n";
    let text = text.replace("case,T_v", "case,T_v,steps");
    fs::write(folder.path().join("s.csv"), &text).expect("written");
    let unread = GoldenFile::read(folder.path(), "s").expect_err("no number");
    let row = unread.source().and_then(|source| source.downcast_ref::<GoldenTextError>()).expect("its text");
    let cell = row.source().and_then(|source| source.downcast_ref::<CellError>()).expect("its cell");
    let wanted = CellError::NoNumber { cell: "b".to_owned(), title: "steps".to_owned() };
    assert_eq!(*cell, wanted, "{unread}");
}
