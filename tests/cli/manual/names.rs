//! What README, the manual, CONTRIBUTING and the list of planted faults name exists: links, options, studies, places in the
//! code; README's first table and its study are what the program prints and writes. `manual.rs` runs what they show.
#![cfg(unix)]

use crate::manual::pages::{blocks, documents, is_equal, root, text_of, tokens};
use crate::program::call;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Cells over the height from which on a run of the table takes too long for a test.
const COARSE: usize = 20;
/// Where the project is.
const ADDRESS: &str = env!("CARGO_PKG_REPOSITORY");
/// Most words of README, and of the manual without theory and the pages for developers.
const MOST_WORDS: [usize; 2] = [1_000, 12_500];

fn readme() -> String {
    text_of("README.md")
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let mut led = 0;
    let developers =
        ["CONTRIBUTING.md", "docs/dev/extending.md", "docs/dev/verification.md", "docs/dev/laws.md"];
    for document in documents().into_iter().chain(developers.map(str::to_owned)) {
        let text = text_of(&document);
        let folder = root().join(&document).parent().expect("a folder").to_owned();
        for target in
            text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target)
        {
            // In the repository at its address, or elsewhere.
            if let Some(path) = target.strip_prefix(ADDRESS).and_then(|rest| rest.strip_prefix("/blob/main/"))
            {
                assert!(root().join(path).exists(), "{document} leads to {target}");
            }
            if target.contains("://") {
                continue;
            }
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() { root().join(&document) } else { folder.join(file) };
            assert!(path.exists(), "{document} leads to {target}");
            if !heading.is_empty() {
                let page = fs::read_to_string(&path).expect("a page");
                let anchors = page
                    .lines()
                    .filter_map(|line| line.strip_prefix("## ").or(line.strip_prefix("### ")))
                    .map(anchor);
                assert!(anchors.into_iter().any(|anchor| anchor == heading), "{document} leads to {target}");
            }
            led += 1;
        }
    }
    assert!(led > 30, "{led} links");
}

/// The anchor of a heading, as forges make it.
fn anchor(heading: &str) -> String {
    let kept = heading
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
        .collect::<String>();
    kept.replace(' ', "-")
}

#[test]
fn readme_and_manual_are_short() {
    let words = |document: &String| text_of(document).split_whitespace().count();
    let length = words(&"README.md".to_owned());
    assert!(length <= MOST_WORDS[0], "README has {length} words: the manual has room for more");
    let manual = documents().into_iter().filter(|name| name.starts_with("docs/") && name != "docs/theory.md");
    let length: usize = manual.map(|name| words(&name)).sum();
    assert!(length <= MOST_WORDS[1], "the manual has {length} words: what does a reader do with them?");
}

/// The numbers of a table's cell: `3.98e-2 → 1.98e-2 → 9.90e-3`.
fn numbers(cell: &str) -> Vec<&str> {
    cell.split('→').map(str::trim).collect()
}

#[test]
fn the_first_table_is_what_solve_prints() {
    let text = readme();
    let table: Vec<Vec<&str>> = text
        .lines()
        .skip_while(|line| !line.starts_with("| error, 10 → 20 → 40 cells"))
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let [head, _, rows @ ..] = table.as_slice() else { panic!("the table has gone") };
    assert_eq!(rows.len(), 2, "{rows:?}");
    let folder = TempDir::new().expect("a folder");
    let mut held = 0;
    for (column, name) in head.iter().enumerate().skip(1).step_by(2) {
        let method = name.trim_matches('`');
        for (level, cells) in [10, 20, 40].into_iter().enumerate().filter(|(_, cells)| *cells <= COARSE) {
            let cells = cells.to_string();
            let told = call(
                folder.path(),
                &[
                    "solve",
                    "terzaghi",
                    "--method",
                    method,
                    "--cells",
                    &cells,
                    "--time-factor",
                    "0.1",
                    "--reference",
                    "terzaghi",
                ],
            );
            for (row, (quantity, sample)) in
                rows.iter().zip([("pressure", "points"), ("pressure", "centres")])
            {
                let line = told.out.lines().find(|line| {
                    let words = tokens(line);
                    words.contains(&quantity) && words.contains(&sample)
                });
                let line = line.unwrap_or_else(|| panic!("no {quantity} of {sample}: {}", told.out));
                let printed = tokens(line)[3];
                let shown = numbers(row[column])[level];
                assert!(
                    is_equal(shown, printed),
                    "{method}, {cells} cells, {quantity} {sample}: {shown}, {printed}"
                );
                held += 1;
            }
        }
        for row in rows {
            let errors: Vec<f64> = numbers(row[column])
                .iter()
                .map(|one| one.replace('−', "-").parse().expect("a number"))
                .collect();
            let order: f64 = row[column + 1].parse().expect("an order");
            // Errors of two or three digits give an order to two decimals or one.
            assert!(((errors[1] / errors[2]).log2() - order).abs() < 0.1, "{row:?}");
        }
    }
    assert!(held == 8, "{held} figures");
}

/// What stands between two pieces of README's text, which may be broken into lines.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let rest = text.split_once(before).unwrap_or_else(|| panic!("README says no more `{before}`")).1;
    rest.split_once(after).unwrap_or_else(|| panic!("README says no more `{after}` after `{before}`")).0
}

#[test]
fn figures_in_the_text_are_what_their_commands_print() {
    let text = text_of("docs/methods.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let folder = TempDir::new().expect("a folder");
    let told = call(folder.path(), &["solve", "terzaghi", "--integrator", "implicit"]);
    assert!(!told.out.contains("critical"), "no critical step bounds it: {}", told.out);
    let steps = between(&text, "`solve terzaghi --integrator implicit` takes ", " steps");
    let line = format!("{steps} steps of");
    assert!(told.out.lines().any(|one| one.starts_with(&line)), "{steps}: {}", told.out);
}

/// README's study.
fn my_study() -> Vec<String> {
    let named = |name: &Option<String>| name.as_deref() == Some("my-study.toml");
    blocks(&readme()).into_iter().find(|block| named(&block.file)).expect("a study file").lines
}

#[test]
fn the_study_file_is_the_one_that_new_writes() {
    let folder = TempDir::new().expect("a folder");
    assert_eq!(call(folder.path(), &["new", "my-study"]).code, 0);
    let written = fs::read_to_string(folder.path().join("my-study.toml")).expect("a file");
    let shown = my_study().join("\n") + "\n";
    assert_eq!(written.split_once("\n\n").map(|(_, body)| body), Some(shown.as_str()));
}

/// The `oedometer` commands of shell and YAML blocks: their words behind the program's name.
fn commands_of_scripts(text: &str) -> Vec<Vec<String>> {
    let scripts = blocks(text).into_iter().filter(|block| ["sh", "yaml"].contains(&block.language.as_str()));
    let lines = scripts.flat_map(|block| block.lines);
    let command = |line: String| {
        let line = line.split(" #").next().unwrap_or_default().replace(" && ", "\n");
        let of =
            |one: &str| Some(one.split_once("oedometer ")?.1.split_whitespace().map(str::to_owned).collect());
        let is_cargos = |one: &str| one.contains("cargo install") || one.contains("cargo test");
        line.lines().filter(|one| !is_cargos(one)).filter_map(of).collect::<Vec<Vec<String>>>()
    };
    lines.flat_map(command).collect()
}

/// Commands in backticks, as `oedometer run STUDY.toml --case HASH` or `solve terzaghi`, in one line.
fn quoted_commands(text: &str) -> Vec<Vec<String>> {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let outside = text.split("```").step_by(2).collect::<Vec<_>>().join(" ");
    let names = [
        "run",
        "report",
        "check",
        "accept",
        "exact",
        "solve",
        "score",
        "stability",
        "plan",
        "merge",
        "explain",
        "new",
        "list",
        "schema",
        "completions",
    ];
    let quoted = outside.split('`').skip(1).step_by(2).map(|code| {
        let words = code.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let start =
            words.iter().position(|word| word == "oedometer" || word == "--").map_or(0, |place| place + 1);
        words[start..].to_vec()
    });
    quoted.filter(|words| words.len() > 1 && names.contains(&words[0].as_str())).collect()
}

#[test]
fn every_option_and_study_that_is_named_exists() {
    let folder = TempDir::new().expect("a folder");
    let mut seen = 0;
    for document in documents()
        .into_iter()
        .chain(["CONTRIBUTING.md", "docs/dev/extending.md", "docs/dev/verification.md"].map(str::to_owned))
    {
        let text = text_of(&document);
        for words in quoted_commands(&text).into_iter().chain(commands_of_scripts(&text)) {
            let help = call(folder.path(), &[&words[0], "--help"]);
            assert_eq!(help.code, 0, "{document}: {words:?}");
            for word in &words[1..] {
                seen += 1;
                if let Some(option) = word.strip_prefix("--").and_then(|word| word.split('=').next()) {
                    assert!(
                        help.out.contains(&format!("--{option}")),
                        "{document}: {words:?} has no --{option}"
                    );
                }
                // Studies of a reader's own repository.
                let is_ones_own = ["my-study", "gate", "STUDY"].iter().any(|own| word.contains(own));
                if word.starts_with("studies/") && !is_ones_own {
                    assert!(root().join(word).is_file(), "{document}: no {word}");
                }
            }
        }
    }
    assert!(seen > 20, "{seen} words");
}

/// All sources under a folder or in a file of the library.
fn sources(path: &Path) -> String {
    if path.is_file() {
        return fs::read_to_string(path).unwrap_or_default();
    }
    let mut entries: Vec<_> =
        fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    entries.sort();
    entries.iter().map(|entry| sources(entry)).collect()
}

/// Whether a source defines a name: an item, a variant or a field.
fn defines(source: &str, name: &str) -> bool {
    let items =
        ["fn", "struct", "enum", "trait", "mod", "const", "type"].map(|kind| format!("{kind} {name}"));
    let is_word = |text: &str, start: usize, length: usize| {
        let ends = text[start + length..].chars().next().is_none_or(|c| !c.is_alphanumeric() && c != '_');
        let begins = text[..start].chars().next_back().is_none_or(|c| !c.is_alphanumeric() && c != '_');
        begins && ends
    };
    let has =
        |what: &String| source.match_indices(what.as_str()).any(|(at, _)| is_word(source, at, what.len()));
    items.iter().any(has)
        || source.lines().any(|line| {
            let line = line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ");
            line.strip_prefix(name).is_some_and(|rest| rest.starts_with([':', ',', '(', ' ']))
        })
}

#[test]
fn every_place_in_the_code_that_contributing_names_exists() {
    let text = text_of("CONTRIBUTING.md") + &text_of("docs/dev/extending.md");
    let whole = sources(&root().join("src")) + &sources(&root().join("crates"));
    let prose = text.split("```").step_by(2).collect::<Vec<_>>().join(" ");
    let mut named = 0;
    for code in prose.split('`').skip(1).step_by(2) {
        let is_path = |c: char| c.is_alphanumeric() || "_-./".contains(c);
        if code.contains('/')
            && code.chars().all(is_path)
            && (Path::new(code).extension().is_some_and(|extension| extension == "rs")
                || ["src/", "crates/", "tests/", "studies/"].iter().any(|of| code.starts_with(of)))
        {
            assert!(root().join(code).exists(), "CONTRIBUTING.md names {code}");
            named += 1;
        }
        let parts: Vec<&str> = code.trim_end_matches("()").split("::").collect();
        let is_name = |part: &&str| !part.is_empty() && part.chars().all(|c| c.is_alphanumeric() || c == '_');
        if parts.len() < 2 || !parts.iter().all(is_name) {
            continue;
        }
        named += 1;
        let (name, container) = (parts[parts.len() - 1], parts[parts.len() - 2]);
        if container.starts_with(char::is_uppercase) {
            assert!(defines(&whole, container), "CONTRIBUTING.md names {code}: no {container}");
            assert!(defines(&whole, name), "CONTRIBUTING.md names {code}: no {name}");
            continue;
        }
        let modules = parts[..parts.len() - 1].join("/");
        let (first, rest) = modules.split_once('/').unwrap_or((&modules, ""));
        let folders = ["src".to_owned(), "crates/mpm/src".to_owned(), format!("crates/{first}/src")];
        let candidates = folders.iter().zip([&*modules, &*modules, rest]);
        let candidates =
            candidates.flat_map(|(folder, path)| [format!("{folder}/{path}"), format!("{folder}/{path}.rs")]);
        let anywhere = candidates.map(|path| sources(&root().join(path))).collect::<String>();
        let source = if anywhere.is_empty() { &whole } else { &anywhere };
        assert!(defines(source, name) || source.contains(name), "CONTRIBUTING.md names {code}: no {name}");
    }
    assert!(named > 20, "{named} places");
}

#[test]
fn every_page_of_the_manual_is_in_the_book_once() {
    let summary = text_of("docs/SUMMARY.md");
    for page in documents().iter().filter_map(|name| name.strip_prefix("docs/")) {
        let count = summary.matches(&format!("({page})")).count();
        assert_eq!(count, usize::from(page != "SUMMARY.md"), "{page}");
    }
}

/// The study from Rust on the front page of the library is README's, without its comments.
#[test]
fn the_study_from_rust_is_that_of_the_readme() {
    let plain = |lines: &mut dyn Iterator<Item = &str>| -> Vec<String> {
        let lines = lines.map(|line| line.split('#').next().unwrap_or_default().trim_end().to_owned());
        lines.filter(|line| !line.is_empty()).collect()
    };
    let study = my_study();
    let page = text_of("src/lib.rs");
    let shown = page.lines().skip_while(|line| !line.ends_with("r#\"")).skip(1);
    let shown = shown
        .take_while(|line| !line.starts_with("//! \"#"))
        .map(|line| line.trim_start_matches("//!").trim_start());
    assert_eq!(plain(&mut { shown }), plain(&mut study.iter().map(String::as_str)));
}

/// Every planted fault names a function that is there, and a study or a test that catches it.
#[test]
fn planted_faults_name_functions_and_tests_that_exist() {
    let text = fs::read_to_string(root().join("tests/faults/faults.toml")).expect("the list");
    let list: toml::Table = toml::from_str(&text).expect("TOML");
    let faults = list["fault"].as_array().expect("faults");
    let sources: String =
        ["src", "crates", "tests"].iter().map(|folder| sources(&root().join(folder))).collect();
    for fault in faults {
        let word = |key: &str| fault[key].as_str().expect(key);
        let (name, file) = (word("name"), word("file"));
        let function = word("function").rsplit(':').next().expect("a name");
        let source = fs::read_to_string(root().join(file)).expect(file);
        assert!(source.contains(&format!("fn {function}")), "{name}: {file} has no function {function}");
        let effects = ["result", "before", "instead"].into_iter().filter(|key| fault.get(*key).is_some());
        assert_eq!(effects.count(), 1, "{name}: one effect");
        if let Some(right) = fault.get("instead").and_then(|pair| pair[0].as_str()) {
            assert!(source.contains(right), "{name}: {file} has no `{right}`");
        }
        if let Some(study) = word("caught_by").strip_prefix("check ") {
            let is_there = root().join(format!("studies/{study}.toml")).is_file();
            assert!(is_there, "{name}: no study {study}");
        } else {
            let test = format!("fn {}(", word("caught_by"));
            assert!(sources.contains(&test), "{name}: no test is called {}", word("caught_by"));
        }
    }
    let names: BTreeSet<&str> = faults.iter().filter_map(|fault| fault["name"].as_str()).collect();
    assert_eq!(names.len(), faults.len(), "two faults have one name");
}
