//! What README, the manual and CONTRIBUTING show is what the program does: every command of a text block is run and
//! its printed output compared, words as words and numbers to the digits shown; study files are run under
//! the names given; figures in the text that a command prints are held against it; what is named exists.
//!
//! In a printed output a line `…` stands for any lines, and `…` at the end of a line for the rest of it.
//! A wall time at the end of a line is the machine's own.
#![cfg(unix)]

use crate::program::{Told, call};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Cells over the height from which on a run of the table takes too long for a test.
const COARSE: usize = 20;
/// Where the project is.
const ADDRESS: &str = env!("CARGO_PKG_REPOSITORY");
/// Units of a wall time.
const UNITS: [&str; 6] = ["ns", "µs", "ms", "s", "min", "h"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn readme() -> String {
    text_of("README.md")
}

fn text_of(document: &str) -> String {
    fs::read_to_string(root().join(document)).expect(document)
}

/// README and the pages of the manual.
fn documents() -> Vec<String> {
    let pages =
        fs::read_dir(root().join("docs")).expect("docs/").map(|entry| entry.expect("a page").file_name());
    let is_page = |name: &std::ffi::OsString| Path::new(name).extension().is_some_and(|end| end == "md");
    let pages = pages.filter(is_page).map(|name| format!("docs/{}", name.to_string_lossy()));
    let mut names: Vec<String> = pages.collect();
    names.sort();
    names.insert(0, "README.md".to_owned());
    names
}

/// A scratch folder that looks like the repository.
fn place() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    for name in ["studies", "golden", "examples"] {
        std::os::unix::fs::symlink(root().join(name), folder.path().join(name)).expect("a link");
    }
    folder
}

/// Fenced blocks of a language, each with the number of its first line.
fn blocks(text: &str, language: &str) -> Vec<(usize, Vec<String>)> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(of) = line.trim_start().strip_prefix("```") else { continue };
        let inside = lines.by_ref().map(|(_, line)| line).take_while(|line| line.trim_start() != "```");
        let inside = inside.map(str::to_owned).collect();
        if of == language {
            found.push((number + 2, inside));
        }
    }
    found
}

/// A command as it is typed, and what README prints below it.
struct Shown {
    line: usize,
    words: Vec<String>,
    output: Vec<String>,
}

/// The commands of a text block, lines that end in `\` put together.
fn commands(first: usize, lines: &[String]) -> Vec<Shown> {
    let mut all: Vec<Shown> = Vec::new();
    let mut is_open = false;
    for (place, line) in lines.iter().enumerate() {
        let typed = line.strip_prefix("$ ");
        if typed.is_none() && !is_open {
            if let Some(shown) = all.last_mut() {
                shown.output.push(line.clone());
            }
            continue;
        }
        let part = typed.unwrap_or(line).trim_end();
        let (part, goes_on) = part.strip_suffix('\\').map_or((part, false), |part| (part, true));
        if !is_open {
            all.push(Shown { line: first + place, words: Vec::new(), output: Vec::new() });
        }
        if let Some(shown) = all.last_mut() {
            shown.words.extend(part.split_whitespace().map(str::to_owned));
        }
        is_open = goes_on;
    }
    all
}

/// Lines that a program printed, without what it says of a slow machine.
fn printed(told: &Told) -> Vec<String> {
    let lines = told.out.lines().chain(told.err.lines());
    lines.filter(|line| !line.contains("of wall time in all")).map(str::to_owned).collect()
}

/// Where a line differs from what is shown; `None` where it does not.
fn difference(shown: &str, found: &str) -> Option<String> {
    let (shown, is_open) = shown.trim_end().strip_suffix('…').map_or((shown, false), |shown| (shown, true));
    let (shown, found) = (tokens(shown), tokens(found));
    if found.len() < shown.len() || found.len() > shown.len() && !is_open {
        return Some("another number of words".to_owned());
    }
    let is_wall_time = |place: usize| {
        place + 2 == shown.len() && shown[place].parse::<f64>().is_ok() && UNITS.contains(&shown[place + 1])
    };
    let differs = |place: &usize| !is_wall_time(*place) && !is_equal(shown[*place], found[*place]);
    let place = (0..shown.len())
        .filter(|place| place + 1 != shown.len() || !is_wall_time_unit(&shown))
        .find(differs)?;
    Some(format!("`{}` instead of `{}`", found[place], shown[place]))
}

/// Whether a line ends in a number and a unit of time.
fn is_wall_time_unit(shown: &[&str]) -> bool {
    matches!(shown, [.., number, unit] if number.parse::<f64>().is_ok() && UNITS.contains(unit))
}

/// Words and numbers; a rule under a table's head is as wide as its numbers, and is left out.
fn tokens(line: &str) -> Vec<&str> {
    let all = line.split(|c: char| c.is_whitespace() || c == ',').filter(|token| !token.is_empty());
    all.filter(|token| !token.chars().all(|c| matches!(c, '-' | '|' | ':'))).collect()
}

/// Words are equal, numbers to the digits shown.
fn is_equal(shown: &str, found: &str) -> bool {
    if shown == found {
        return true;
    }
    let plain = |text: &str| text.replace('−', "-").parse::<f64>().ok();
    let (Some(value), Some(other)) = (plain(shown), plain(found)) else { return false };
    (value - other).abs() <= 0.500_000_1 * last_digit(shown)
}

/// Size of one unit of the last digit of a number as it is written.
fn last_digit(number: &str) -> f64 {
    let (mantissa, exponent) = number.split_once('e').unwrap_or((number, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, digits)| digits.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10_f64.powi(exponent - i32::try_from(decimals).unwrap_or(0))
}

/// Why printed lines are not those shown; `None` where they are.
fn mismatch(shown: &[String], found: &[String]) -> Option<String> {
    let mut found = found.iter();
    let mut skips = false;
    for line in shown {
        if line.trim() == "…" {
            skips = true;
            continue;
        }
        if skips {
            if !found.any(|one| difference(line, one).is_none()) {
                return Some(format!("no line is `{line}`"));
            }
        } else {
            let Some(one) = found.next() else { return Some(format!("nothing is left for `{line}`")) };
            if let Some(what) = difference(line, one) {
                return Some(format!("{what} in `{one}`"));
            }
        }
        skips = false;
    }
    match found.next() {
        Some(rest) if !skips => Some(format!("`{rest}` is printed and not shown")),
        _ => None,
    }
}

#[test]
fn lines_are_compared_by_words_and_by_the_digits_shown() {
    let is_same = |shown: &str, found: &str| difference(shown, found).is_none();
    assert!(is_same("| p | 3.98e-2 |", "| p   |  3.98e-2 |"));
    assert!(is_same("error 3.98e-2", "error 3.984e-2") && !is_same("error 3.98e-2", "error 3.986e-2"));
    assert!(is_same("settlement −0.63 %", "settlement -0.63 %"));
    assert!(!is_same("unstable at step 64", "unstable at step 8") && !is_same("a b", "a c"));
    assert!(
        is_same("10 steps, 0.677 s", "10 steps, 12.1 s")
            && !is_same("10 steps, 0.677 s", "11 steps, 0.677 s")
    );
    assert!(is_same("a b …", "a b c d") && !is_same("a b …", "a c") && !is_same("a b", "a b c"));
    let lines = |text: &str| text.split('/').map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(mismatch(&lines("a/…/d"), &lines("a/b/c/d")), None);
    assert_eq!(mismatch(&lines("a/…"), &lines("a/b")), None);
    assert!(mismatch(&lines("a"), &lines("a/b")).is_some() && mismatch(&lines("a/b"), &lines("a")).is_some());
    assert!(mismatch(&lines("…/x"), &lines("a/b")).is_some());
}

#[test]
fn every_command_shown_prints_what_is_shown() {
    let mut run = 0;
    let mut wrong = Vec::new();
    for document in documents() {
        // The commands of a document see what those before them left.
        let folder = place();
        for (first, lines) in blocks(&text_of(&document), "text") {
            let mut at = folder.path().to_owned();
            for shown in commands(first, &lines) {
                let words: Vec<&str> = shown.words.iter().map(String::as_str).collect();
                match words.as_slice() {
                    ["cd", to] => at = at.join(to),
                    ["oedometer", arguments @ ..] => {
                        run += 1;
                        let found = printed(&call(&at, arguments));
                        if let Some(what) = mismatch(&shown.output, &found) {
                            wrong.push(format!(
                                "{document}:{}: {}: {what}\n--- shown\n{}\n--- printed\n{}\n",
                                shown.line,
                                words.join(" "),
                                shown.output.join("\n"),
                                found.join("\n")
                            ));
                        }
                    }
                    other => panic!("{document}:{}: no command of a test: {other:?}", shown.line),
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(run >= 8, "{run} commands");
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let mut led = 0;
    for document in documents() {
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
fn readme_is_read_in_one_sitting_and_the_manual_knows_its_pages() {
    let length = readme().len();
    assert!(length < 12_000, "README has {length} bytes: the manual has room for more");
    let contents = text_of("docs/README.md");
    for page in documents()
        .iter()
        .filter_map(|name| name.strip_prefix("docs/"))
        .filter(|name| !["README.md", "SUMMARY.md"].contains(name))
    {
        assert!(contents.contains(&format!("]({page})")), "docs/README.md does not name {page}");
    }
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
    assert_eq!(rows.len(), 4, "{rows:?}");
    let folder = place();
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
            for (row, (quantity, sample)) in rows.iter().zip([
                ("pressure", "points"),
                ("pressure", "centres"),
                ("effective_stress", "points"),
                ("settlement", "surface"),
            ]) {
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
    assert!(held >= 16, "{held} figures");
}

/// What stands between two pieces of README's text, which may be broken into lines.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let rest = text.split_once(before).unwrap_or_else(|| panic!("README says no more `{before}`")).1;
    rest.split_once(after).unwrap_or_else(|| panic!("README says no more `{after}` after `{before}`")).0
}

#[test]
fn figures_in_the_text_are_what_their_commands_print() {
    let on_one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let text = on_one_line(readme());
    let folder = place();
    let told = call(folder.path(), &["solve", "terzaghi", "--time-step", "seconds=1e-4"]);
    assert_eq!(told.code, 3);
    let step = between(&text, "`unstable` at step ", " (`solve terzaghi --time-step seconds=1e-4`");
    assert!(told.err.contains(&format!("(unstable) at step {step}, ")), "step {step}: {}", told.err);
    let share = between(&text, "A step of 10⁻⁴ s is reported as ", " times the predicted critical one");
    let found = between(&told.err, "1.0000e-4 s is ", " of the predicted critical one");
    assert!(is_equal(share, found), "{share}: {}", told.err);
    let text = on_one_line(text_of("docs/methods.md"));
    let told = call(folder.path(), &["solve", "terzaghi", "--integrator", "implicit"]);
    assert!(!told.out.contains("critical"), "no critical step bounds it: {}", told.out);
    let steps = between(&text, "`solve terzaghi --integrator implicit` takes ", " steps");
    assert!(
        told.out.lines().any(|line| line.starts_with(&format!("{steps} steps of"))),
        "{steps}: {}",
        told.out
    );
    assert_eq!(
        call(folder.path(), &["solve", "cosine-layer", "--integrator", "implicit", "--cells", "4"]).code,
        0
    );
}

/// README's study file under its name.
fn with_my_study(change: impl Fn(&str) -> String) -> TempDir {
    let text = readme();
    let (_, lines) = blocks(&text, "toml")
        .into_iter()
        .find(|(_, lines)| lines.first().is_some_and(|line| line.starts_with("title = ")))
        .expect("a study file");
    let folder = place();
    let file = folder.path().join("my-study.toml");
    fs::write(file, change(&(lines.join("\n") + "\n"))).expect("a file");
    folder
}

#[test]
fn the_study_file_is_the_one_that_new_writes_and_runs_is_judged_and_is_reported() {
    let folder = with_my_study(str::to_owned);
    let shown = fs::read_to_string(folder.path().join("my-study.toml")).expect("a file");
    let other = place();
    assert_eq!(call(other.path(), &["new", "my-study"]).code, 0);
    let written = fs::read_to_string(other.path().join("my-study.toml")).expect("a file");
    assert_eq!(written.split_once("\n\n").map(|(_, body)| body), Some(shown.as_str()));
    let told = call(folder.path(), &["run", "my-study.toml"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let told = call(folder.path(), &["check", "my-study.toml"]);
    assert_eq!(told.code, 5, "{}{}", told.out, told.err);
    assert!(told.out.starts_with("my-study: 1 of 1 expectations met"), "{}", told.out);
    let told = call(folder.path(), &["report", "my-study.toml", "--out", "my-report"]);
    assert_eq!(told.code, 0, "{}", told.err);
    assert!(folder.path().join("my-report/index.html").is_file());
}

#[test]
fn a_mistake_in_the_study_file_is_told_as_shown() {
    let (key, typed) = ("hydraulic_conductivity = 1.0e-4", "hydraulic_conductivty = 1.0e-4");
    let folder = with_my_study(|text| text.replace(key, typed));
    let told = call(folder.path(), &["check", "my-study.toml"]);
    assert_eq!(told.code, 2);
    let text = readme();
    let (line, shown) = blocks(&text, "text")
        .into_iter()
        .find(|(_, lines)| lines.first().is_some_and(|line| line.starts_with("error: ")))
        .expect("an error");
    let found: Vec<String> = told.err.lines().map(str::to_owned).collect();
    assert_eq!(mismatch(&shown, &found), None, "README.md:{line}: {}", told.err);
}

#[test]
fn the_mapping_and_the_other_files_shown_are_read() {
    let mut read = 0;
    for document in documents() {
        let folder = place();
        for (line, lines) in blocks(&text_of(&document), "toml") {
            let text = lines.join("\n") + "\n";
            if text.starts_with("sample = ") || text.starts_with("[[solver]]") {
                // Mappings of pages of their own name arrays of many programs at once; a solver needs its files.
                continue;
            }
            let title = if text.starts_with("title = ") { "" } else { "title = \"shown\"\n" };
            fs::write(folder.path().join("shown.toml"), format!("{title}{text}")).expect("a file");
            let told = call(folder.path(), &["plan", "shown.toml"]);
            assert_eq!(told.code, 0, "{document}:{line}: {}", told.err);
            read += 1;
        }
    }
    assert!(read >= 5, "{read} files");
}

/// The `oedometer` commands of shell and YAML blocks: their words behind the program's name.
fn commands_of_scripts(text: &str) -> Vec<Vec<String>> {
    let scripts = ["sh", "yaml"].into_iter().flat_map(|language| blocks(text, language));
    let lines = scripts.flat_map(|(_, lines)| lines);
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
    let folder = place();
    let mut seen = 0;
    for document in documents().into_iter().chain(["CONTRIBUTING.md".to_owned()]) {
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
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).expect("CONTRIBUTING.md");
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
    let (_, study) = blocks(&readme(), "toml").remove(0);
    let page = text_of("src/lib.rs");
    let shown = page.lines().skip_while(|line| !line.ends_with("r#\"")).skip(1);
    let shown = shown
        .take_while(|line| !line.starts_with("//! \"#"))
        .map(|line| line.trim_start_matches("//!").trim_start());
    assert_eq!(plain(&mut { shown }), plain(&mut study.iter().map(String::as_str)));
}
