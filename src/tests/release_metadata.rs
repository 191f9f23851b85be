//! What the release says of itself stands once, in Cargo.toml, and every other file agrees: version, address, scope, licence.
//! So does the list of sources, which names whatever the manual and the methods cite.
//!
//! `MANUAL_UPDATE=always cargo test release_metadata` writes version, address and scope into the other files.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const UPDATE: &str = "MANUAL_UPDATE";
const SOURCES: &str = "docs/literature.bib";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text_of(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// What Cargo.toml says, and the date of the newest version in CHANGELOG.md.
struct Release {
    version: String,
    address: String,
    /// One sentence without its full stop.
    scope: String,
    date: String,
}

impl Release {
    fn read() -> Release {
        let manifest: toml::Table = text_of("Cargo.toml").parse().expect("TOML");
        let word = |value: &toml::Value| value.as_str().expect("a word").to_owned();
        let workspace = &manifest["workspace"]["package"];
        let version = word(&workspace["version"]);
        let heading = format!("## [{version}] - ");
        let changes = text_of("CHANGELOG.md");
        let date = changes.lines().find_map(|line| line.strip_prefix(&heading));
        Release {
            date: date.unwrap_or_else(|| panic!("CHANGELOG.md has no heading `{heading}DATE`")).to_owned(),
            address: word(&workspace["repository"]),
            scope: word(&manifest["package"]["description"]),
            version,
        }
    }

    /// Where each value stands: file, text before it, text behind it, value.
    fn places(&self) -> Vec<(&'static str, &'static str, &'static str, String)> {
        let Release { version, address, scope, date } = self;
        let inside = scope[..1].to_lowercase() + &scope[1..];
        let copy = |text: &String| text.clone();
        vec![
            ("Cargo.toml", "\", version = \"", "\" }", copy(version)),
            ("python/Cargo.toml", "path = \"..\", version = \"", "\"", copy(version)),
            ("python/pyproject.toml", "\ndescription = \"", "\"", copy(scope)),
            ("python/pyproject.toml", "\nRepository = \"", "\"", copy(address)),
            ("CITATION.cff", "\ntitle: \"oedometer: ", "\"", copy(&inside)),
            ("CITATION.cff", "\nversion: ", "\n", copy(version)),
            ("CITATION.cff", "\ndate-released: ", "\n", copy(date)),
            ("CITATION.cff", "\nrepository-code: \"", "\"", copy(address)),
            ("codemeta.json", "\"description\": \"", "\"", copy(scope)),
            ("codemeta.json", "\"version\": \"", "\"", copy(version)),
            ("codemeta.json", "\"codeRepository\": \"", "\"", copy(address)),
            ("codemeta.json", "\"issueTracker\": \"", "\"", format!("{address}/issues")),
            ("paper/paper.md", "\ntitle: 'oedometer: ", "'", copy(&inside)),
            ("README.md", "\n`oedometer` is ", ".", copy(&inside)),
            ("README.md", "title   = {oedometer: ", "}", copy(&inside)),
            ("README.md", "version = {", "}", copy(version)),
            ("README.md", "year    = {", "}", date[..4].to_owned()),
            ("README.md", "url     = {", "}", copy(address)),
            ("README.md", "cargo install --locked --git ", " ", copy(address)),
            ("SECURITY.md", "<", "/security>", copy(address)),
        ]
    }
}

#[test]
fn every_file_has_the_version_the_address_and_the_scope_of_cargo_toml() {
    let is_update = std::env::var(UPDATE).is_ok_and(|value| value == "always");
    let mut wrong = Vec::new();
    for (file, before, behind, value) in Release::read().places() {
        let text = text_of(file);
        let mut parts = text.split(before);
        let mut written = parts.next().unwrap_or_default().to_owned();
        let mut count = 0;
        for part in parts {
            let (there, rest) =
                part.split_once(behind).unwrap_or_else(|| panic!("{file}: `{before}` ends nowhere"));
            // A line of README may be broken.
            if there.split_whitespace().ne(value.split_whitespace()) {
                wrong.push(format!("{file}: {}{there}, not {value}", before.trim_start()));
                written.extend([before, &value, behind, rest]);
            } else {
                written.extend([before, there, behind, rest]);
            }
            count += 1;
        }
        assert!(count > 0, "{file} does not say `{}…`", before.trim_start());
        if is_update && written != text {
            fs::write(root().join(file), written).expect(file);
        }
    }
    assert!(
        is_update || wrong.is_empty(),
        "{}\n{UPDATE}=always cargo test release_metadata",
        wrong.join("\n")
    );
}

/// The folders that are published on their own: the crates, and the package for Python.
fn packages() -> Vec<String> {
    let crates = fs::read_dir(root().join("crates"))
        .expect("crates/")
        .map(|entry| entry.expect("a crate").file_name());
    crates.map(|name| format!("crates/{}", name.to_string_lossy())).chain(["python".to_owned()]).collect()
}

#[test]
fn every_package_has_the_licence_and_the_address() {
    let licence = text_of("LICENSE");
    for package in packages() {
        // At the root of Python's source distribution stands that of the program.
        let path =
            if package == "python" { "python/oedometer/LICENSE" } else { &format!("{package}/LICENSE") };
        assert!(text_of(path) == licence, "{path} is not LICENSE");
        let manifest = text_of(&format!("{package}/Cargo.toml"));
        for key in ["version", "license", "repository"] {
            assert!(manifest.contains(&format!("{key}.workspace = true")), "{package}/Cargo.toml: {key}");
        }
    }
}

/// Sources as a text names them, `Name 1943`, `Name (1943)` or `Name & Other 1943`: the last name before the year.
fn cited(text: &str) -> BTreeSet<(String, u32)> {
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || "*[]/".contains(c))
        .filter(|word| !word.is_empty())
        .collect();
    let mut cited = BTreeSet::new();
    for place in 1..words.len() {
        let year = words[place].trim_matches(|c: char| !c.is_ascii_digit());
        let Ok(year @ 1850..=2025) = year.parse::<u32>() else { continue };
        // `Name et al. 2021`
        let back = if words[place - 1] == "al." && place >= 3 { 3 } else { 1 };
        let name = words[place - back].trim_matches(|c: char| !c.is_alphabetic());
        let is_name = name.starts_with(char::is_uppercase) && !words[place - back].ends_with(['.', ':', ';']);
        if is_name && year_stands_alone(words[place]) {
            cited.insert((name.trim_end_matches("'s").to_owned(), year));
        }
    }
    cited
}

/// Whether a word is a year and marks around it, and no date, no file and no number with a unit.
fn year_stands_alone(word: &str) -> bool {
    word.chars().filter(|c| c.is_alphanumeric() || "-.=".contains(*c)).count() <= 5
        && !word.starts_with(['=', '-'])
}

/// A name as BibTeX writes it.
fn without_accents(name: &str) -> String {
    let plain = |c: char| match c {
        'é' | 'è' | 'ê' => 'e',
        'á' | 'à' => 'a',
        'ó' | 'ò' | 'ö' => 'o',
        'ü' => 'u',
        'ł' => 'l',
        'ç' => 'c',
        other => other,
    };
    name.chars().map(plain).collect()
}

#[test]
fn every_source_that_is_cited_has_an_entry() {
    let sources = text_of(SOURCES);
    let entries: Vec<(String, &str)> = sources
        .lines()
        .filter(|line| line.starts_with('@'))
        .map(|line| {
            let authors =
                line.split_once("author = {").expect("authors").1.split_once("}, year").expect("a year").0;
            let plain = authors
                .replace("{\\l}", "l")
                .replace(['\\', '\'', '"', '`', '{', '}'], "")
                .replace("\\c", "");
            let year = line.split_once("year = ").expect("a year").1.split_once(',').expect("a year").0;
            (plain, year)
        })
        .collect();
    let mut missing = Vec::new();
    let mut count = 0;
    let pages = fs::read_dir(root().join("docs")).expect("docs/").map(|entry| entry.expect("a page").path());
    let pages = pages.filter(|page| page.extension().is_some_and(|end| end == "md"));
    let pages = pages.chain(["README.md", "crates/case/src/method_words.rs"].map(|file| root().join(file)));
    for page in pages {
        let text = fs::read_to_string(&page).expect("a text").replace(['"', ';'], " ");
        for (name, year) in cited(&text) {
            count += 1;
            let plain = without_accents(&name);
            let is_there =
                entries.iter().any(|(authors, of)| authors.contains(&plain) && *of == year.to_string());
            if !is_there {
                missing.push(format!("{}: {name} {year}", page.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{SOURCES} has no entry for\n{}", missing.join("\n"));
    assert!(count > 40, "{count} citations");
}

#[test]
fn entries_are_in_the_order_of_their_keys_and_their_dois_are_dois() {
    let sources = text_of(SOURCES);
    let keys: Vec<&str> = sources
        .lines()
        .filter_map(|line| Some(line.strip_prefix('@')?.split_once('{')?.1.split_once(',')?.0))
        .collect();
    assert!(keys.is_sorted() && keys.len() > 50, "{keys:?}");
    let papers = text_of("paper/paper.bib");
    for line in sources.lines().chain(papers.lines()) {
        let doi = line.split_once("doi = {").and_then(|(_, rest)| rest.split_once('}'));
        assert!(doi.is_none_or(|(doi, _)| doi.starts_with("10.") && doi.contains('/')), "{line}");
    }
}
