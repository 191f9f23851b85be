//! What the borders of the crates and `source_order` cannot say: where files are opened, and which types errors have.

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
    let mut readers =
        vec![root.join("../crates/foreign/src/reading.rs"), root.join("study/check/solvers.rs")];
    for folder in [
        "../crates/formats/src",
        "../crates/foreign/src/import",
        "study/check/solvers",
        "score",
        "cli/commands/score",
        "cli/slurm",
    ] {
        readers.extend(sources_below(&root.join(folder)));
    }
    let opener = root.join("../crates/formats/src/input_file.rs");
    assert!(readers.contains(&opener), "the one that opens files has moved");
    for path in readers.iter().filter(|path| **path != opener && !is_test_module(path)) {
        let text = fs::read_to_string(path).expect("a file");
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for opening in ["File::open", "fs::read(", "read_to_string("] {
            assert!(!code.contains(opening), "{} has `{opening}`", path.display());
        }
    }
}

/// Predicates of `impl Scene`, by the code of its file.
fn predicates(code: &str) -> Vec<String> {
    let inside =
        code.split("impl Scene {").nth(1).and_then(|rest| rest.split("\n}\n").next()).expect("an impl");
    let answers = |line: &&str| {
        line.ends_with("-> bool {")
            || line.contains("-> Option<&'static str>")
            || line.contains("-> Option<String>")
    };
    let signatures =
        inside.lines().map(str::trim_start).filter(|line| line.starts_with("pub fn ")).filter(answers);
    signatures.filter_map(|line| Some(line["pub fn ".len()..].split_once('(')?.0.to_owned())).collect()
}

/// Scenes that code names, as `&TERZAGHI` or by a comparison with the name.
fn named_scenes(code: &str) -> Vec<String> {
    let statics: Vec<String> =
        oedometer_scenes::NAMES.iter().map(|name| name.to_uppercase().replace('-', "_")).collect();
    let words = code.split(|letter: char| !letter.is_alphanumeric() && !"_&".contains(letter));
    let by_static = words
        .filter(|word| word.strip_prefix('&').is_some_and(|name| statics.iter().any(|known| known == name)));
    let by_name = ["scene.name ==", "scene.name !=", "match scene.name", "scene.name {"]
        .into_iter()
        .filter(|words| code.contains(words));
    by_static.map(str::to_owned).chain(by_name.map(str::to_owned)).collect()
}

/// What the other crates ask of a scene: ten predicates at most, and never which one it is but for the paper's figures, which are
/// of two scenes.
#[test]
fn a_scene_is_asked_few_predicates_and_not_which_one_it_is() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = fs::read_to_string(root.join("crates/scenes/src/scene.rs")).expect("the scene");
    let known = predicates(&scene);
    assert!(known.iter().any(|name| name == "is_loaded"), "{known:?}");
    let mut sources = sources_below(&root.join("src"));
    for folder in ["case", "foreign", "mpm", "problem"] {
        sources.extend(sources_below(&root.join("crates").join(folder).join("src")));
    }
    let (mut asked, mut named) = (BTreeSet::new(), Vec::new());
    for path in sources.iter().filter(|path| !is_test_module(path)) {
        let text = fs::read_to_string(path).expect("a source");
        let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        asked.extend(known.iter().filter(|name| code.contains(&format!(".{name}("))));
        let inside = path.strip_prefix(root).expect("below the root").display();
        named.extend(named_scenes(code).iter().map(|scene| format!("{inside}: {scene}")));
    }
    assert!(asked.len() <= 10, "{asked:?}");
    assert_eq!(named, ["src/questions/paper.rs: &XIE_LEO", "src/questions/paper.rs: &TERZAGHI"]);
    for planted in ["if scene == &AT_REST {", "if scene.name == \"footing\" {", "match scene.name {"] {
        assert!(!named_scenes(planted).is_empty(), "{planted}");
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

    let case = Case::seed(Task::Solve, &oedometer_scenes::TERZAGHI);
    let refused = crate::campaign::runner::RunError::refused(&case, crate::exact::ExactError::Depth(2.0));
    let source = refused.source().and_then(|source| source.downcast_ref());
    assert_eq!(source, Some(&crate::exact::ExactError::Depth(2.0)));

    let folder = tempfile::TempDir::new().expect("a folder");
    let text = GoldenFile::of("s", &[], "r").to_text().expect("a text") + "a,,,b\n";
    let text = text.replace("case,hash,T_v", "case,hash,T_v,steps");
    fs::write(folder.path().join("s.csv"), &text).expect("written");
    let unread = GoldenFile::read(folder.path(), "s").expect_err("no number");
    let row = unread.source().and_then(|source| source.downcast_ref::<GoldenTextError>()).expect("its text");
    let cell = row.source().and_then(|source| source.downcast_ref::<CellError>()).expect("its cell");
    let wanted = CellError::NoNumber { cell: "b".to_owned(), title: "steps".to_owned() };
    assert_eq!(*cell, wanted, "{unread}");
}
