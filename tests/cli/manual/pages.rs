//! README and the manual are run as they are printed, page by page, each in an empty folder beside `examples/`:
//!
//! - A block of a file (TOML, CSV) is written under the name that stands in backticks above it. A study must plan, a mapping and
//!   a `[[solver]]` must be understood.
//! - In a `text` block each line behind `$ ` is a command, and what is below it is what the command prints: words as words, numbers
//!   to the digits shown. A line `…` stands for any lines, `…` at the end of a line for the rest of it. Wall times at the end of
//!   a line and hashes are not compared.
//! - Each line of an `sh` block is a command that must succeed, or end with the code of its comment `# exit code N`.
//!
//! `MANUAL_UPDATE=always cargo test --test cli manual` writes what is printed into the pages.
#![cfg(unix)]

use crate::program::{ALLOWED, OF_A_CI, PROGRAM};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Units of a wall time.
const UNITS: [&str; 6] = ["ns", "µs", "ms", "s", "min", "h"];
/// Programs that install something, or measure for hours: their lines are not run.
const NOT_RUN: [&str; 7] = ["cargo", "pip", "rustup", "apt-get", "tar", "valgrind", "python3"];
/// Variable with which the pages are written instead of compared.
const UPDATE: &str = "MANUAL_UPDATE";

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn text_of(document: &str) -> String {
    fs::read_to_string(root().join(document)).expect(document)
}

/// README and the pages of the manual, without those for developers.
pub fn documents() -> Vec<String> {
    let pages =
        fs::read_dir(root().join("docs")).expect("docs/").map(|entry| entry.expect("a page").file_name());
    let is_page = |name: &std::ffi::OsString| Path::new(name).extension().is_some_and(|end| end == "md");
    let pages = pages.filter(is_page).map(|name| format!("docs/{}", name.to_string_lossy()));
    let mut names: Vec<String> = pages.collect();
    names.sort();
    names.insert(0, "README.md".to_owned());
    names
}

/// A fenced block: its language, the place of its first line from 0, and the file that the text above it names.
pub struct Block {
    pub language: String,
    pub first: usize,
    pub lines: Vec<String>,
    pub file: Option<String>,
}

/// The fenced blocks of a page.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut all = Vec::new();
    let mut lines = text.lines().enumerate();
    let mut above = String::new();
    while let Some((place, line)) = lines.next() {
        let Some(language) = line.trim_start().strip_prefix("```") else {
            if !line.trim().is_empty() {
                line.clone_into(&mut above);
            }
            continue;
        };
        let inside = lines.by_ref().map(|(_, line)| line).take_while(|line| line.trim_start() != "```");
        let inside: Vec<String> = inside.map(str::to_owned).collect();
        let named =
            above.split('`').skip(1).step_by(2).filter(|code| code.ends_with(&format!(".{language}")));
        let file = named.last().map(str::to_owned);
        all.push(Block { language: language.to_owned(), first: place + 1, lines: inside, file });
    }
    all
}

/// A command, and what the page prints below it.
struct Shown {
    /// Place of the command and of the first line of its output in the page.
    place: usize,
    below: usize,
    command: String,
    output: Vec<String>,
    /// Code of the comment `# exit code N`; of a block of outputs none.
    code: Option<i32>,
}

/// The commands of a block, lines that end in `\` put together.
fn commands(block: &Block) -> Vec<Shown> {
    let is_script = block.language == "sh";
    let mut all: Vec<Shown> = Vec::new();
    let mut is_open = false;
    for (at, line) in block.lines.iter().enumerate() {
        let place = block.first + at;
        let typed = if is_script { Some(line.as_str()) } else { line.strip_prefix("$ ") };
        if typed.is_none() && !is_open {
            if let Some(shown) = all.last_mut() {
                shown.output.push(line.clone());
            }
            continue;
        }
        let typed = typed.unwrap_or(line);
        let (typed, comment) = typed.split_once(" #").unwrap_or((typed, ""));
        let (part, goes_on) = typed.trim_end().strip_suffix('\\').map_or((typed, false), |part| (part, true));
        if !is_open {
            let asked = comment
                .trim()
                .strip_prefix("exit code ")
                .and_then(|code| code.split([',', ':']).next()?.parse().ok());
            let code = asked.or(is_script.then_some(0));
            all.push(Shown { place, below: place + 1, command: String::new(), output: Vec::new(), code });
        }
        if let Some(shown) = all.last_mut() {
            let joined = format!("{} {}", shown.command, part.trim());
            joined.trim().clone_into(&mut shown.command);
            shown.below = place + 1;
        }
        is_open = goes_on;
    }
    all.retain(|shown| !shown.command.is_empty());
    all
}

/// What a line of the shell came to.
struct Ended {
    code: i32,
    lines: Vec<String>,
}

/// Runs a line in a shell that finds this program.
fn shell(folder: &Path, home: &Path, line: &str) -> Ended {
    let program = Path::new(PROGRAM).parent().expect("a folder").display().to_string();
    let mut command = Command::new("sh");
    for name in OF_A_CI {
        command.env_remove(name);
    }
    let path = std::env::var("PATH").unwrap_or_default();
    command.env("PATH", format!("{program}:{path}")).env("HOME", home).env_remove(ALLOWED.0);
    for name in ["AUTHOR", "COMMITTER"] {
        command
            .env(format!("GIT_{name}_NAME"), "A reader")
            .env(format!("GIT_{name}_EMAIL"), "reader@example.org");
    }
    command.args(["-c", line]).current_dir(folder).stdin(Stdio::null());
    let output = command.output().expect("a shell");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("words");
    let (out, err) = (text(output.stdout), text(output.stderr));
    assert!(!err.contains("panicked"), "{line}: {err}");
    // A slow machine says that its cases took long.
    let lines = out.lines().chain(err.lines()).filter(|line| !line.contains("of wall time in all"));
    Ended { code: output.status.code().expect("an exit code"), lines: lines.map(str::to_owned).collect() }
}

/// Where a line differs from what is shown; `None` where it does not.
fn difference(shown: &str, found: &str) -> Option<String> {
    let (shown, is_open) = shown.trim_end().strip_suffix('…').map_or((shown, false), |shown| (shown, true));
    let (shown, found) = (tokens(shown), tokens(found));
    if found.len() < shown.len() || found.len() > shown.len() && !is_open {
        return Some("another number of words".to_owned());
    }
    // A wall time at the end of the line.
    let ends_in_time =
        matches!(shown[..], [.., number, unit] if number.parse::<f64>().is_ok() && UNITS.contains(&unit));
    let compared = shown.len() - if ends_in_time { 2 } else { 0 };
    let place = (0..compared).find(|place| !is_equal(shown[*place], found[*place]))?;
    Some(format!("`{}` instead of `{}`", found[place], shown[place]))
}

/// Words and numbers; a rule under a table's head is as wide as its numbers, and is left out.
pub fn tokens(line: &str) -> Vec<&str> {
    let all = line.split(|c: char| c.is_whitespace() || c == ',').filter(|token| !token.is_empty());
    all.filter(|token| !token.chars().all(|c| matches!(c, '-' | '|' | ':'))).collect()
}

/// Words are equal, numbers to the digits shown, and hashes stand for each other.
pub fn is_equal(shown: &str, found: &str) -> bool {
    let is_hash = |word: &str| word.len() == 16 && word.chars().all(|c| c.is_ascii_hexdigit());
    if shown == found || is_hash(shown) && is_hash(found) {
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

/// Why printed lines are not those shown; `None` where they are. Lines between two `…` follow each other.
fn mismatch(shown: &[String], found: &[String]) -> Option<String> {
    let parts: Vec<&[String]> = shown.split(|line| line.trim() == "…").collect();
    let mut from = 0;
    for (number, part) in parts.iter().enumerate() {
        let is_last = number + 1 == parts.len() && (number == 0 || !part.is_empty());
        let Some(latest) = found.len().checked_sub(part.len()).filter(|latest| *latest >= from) else {
            return Some(format!(
                "{} lines are printed for `{}` and those below",
                found.len() - from,
                part[0]
            ));
        };
        let starts = match number {
            0 => 0..=0,
            _ if is_last => latest..=latest,
            _ => from..=latest,
        };
        let differs = |start: &usize| {
            let mut lines = part.iter().zip(&found[*start..]);
            lines.find_map(|(shown, found)| Some(format!("{} in `{found}`", difference(shown, found)?)))
        };
        let Some(start) = starts.clone().find(|start| differs(start).is_none()) else {
            let is_fixed = starts.start() == starts.end();
            return if is_fixed {
                differs(starts.start())
            } else {
                Some(format!("no lines are like `{}`", part[0]))
            };
        };
        from = start + part.len();
        if is_last && from < found.len() {
            return Some(format!("`{}` is printed and not shown", found[from]));
        }
    }
    None
}

/// The lines shown, brought up to those printed: as many lines between two `…` as before, those that are most alike.
fn rewritten(shown: &[String], found: &[String]) -> Vec<String> {
    let parts: Vec<&[String]> = shown.split(|line| line.trim() == "…").collect();
    if let [all] = parts[..] {
        let plain = |place: usize, line: &String| {
            all.get(place).map_or_else(|| line.clone(), |old| open_end(old, line))
        };
        return found.iter().enumerate().map(|(place, line)| plain(place, line)).collect();
    }
    let mut lines = Vec::new();
    let mut from = 0;
    for (number, part) in parts.iter().enumerate() {
        let last = found.len().saturating_sub(part.len());
        let start = if number == 0 {
            0
        } else {
            lines.push("…".to_owned());
            let is_end = number + 1 == parts.len() && !part.is_empty();
            let alike = |start: &usize| {
                part.iter().zip(&found[*start..]).map(|(old, new)| words_shared(old, new)).sum::<usize>()
            };
            if is_end {
                last.max(from)
            } else {
                (from..=last.max(from)).rev().max_by_key(alike).unwrap_or(from)
            }
        };
        let new = found.get(start..).unwrap_or_default();
        lines.extend(part.iter().zip(new).map(|(old, new)| open_end(old, new)));
        from = start + part.len();
    }
    lines
}

fn words_shared(old: &str, new: &str) -> usize {
    let new = tokens(new);
    tokens(old).iter().filter(|word| new.contains(word)).count()
}

/// A printed line, cut where the one shown is cut.
fn open_end(old: &str, new: &str) -> String {
    let Some(kept) = old.trim_end().strip_suffix('…') else { return new.trim_end().to_owned() };
    let words: Vec<&str> = new.split_inclusive(' ').collect();
    let mut cut = String::new();
    let mut left = kept.split_whitespace().count();
    for word in words {
        if left == 0 && !word.trim().is_empty() {
            break;
        }
        cut += word;
        left -= usize::from(!word.trim().is_empty()).min(left);
    }
    format!("{} …", cut.trim_end())
}

#[test]
fn lines_are_compared_by_words_and_by_the_digits_shown() {
    let is_same = |shown: &str, found: &str| difference(shown, found).is_none();
    for (shown, found, same) in [
        ("| p | 3.98e-2 |", "| p   |  3.98e-2 |", true),
        ("error 3.98e-2", "error 3.984e-2", true),
        ("error 3.98e-2", "error 3.986e-2", false),
        ("settlement −0.63 %", "settlement -0.63 %", true),
        ("unstable at step 64", "unstable at step 8", false),
        ("a b", "a c", false),
        ("10 steps, 0.677 s", "10 steps, 12.1 s", true),
        ("10 steps, 0.677 s", "11 steps, 0.677 s", false),
        ("case 29c5d0e76e1ae1a4", "case 00c5d0e76e1ae1a4", true),
        ("a b …", "a b c d", true),
        ("a b …", "a c", false),
        ("a b", "a b c", false),
    ] {
        assert_eq!(is_same(shown, found), same, "{shown} / {found}");
    }
    let lines = |text: &str| text.split('/').map(str::to_owned).collect::<Vec<_>>();
    for (shown, found, same) in [
        ("a/…/d", "a/b/c/d", true),
        ("a/…", "a/b", true),
        ("a", "a/b", false),
        ("a/b", "a", false),
        ("…/x", "a/b", false),
        ("…/b/c/…", "b/d/b/c/e", true),
        ("…/b/c/…", "b/d/c/e", false),
    ] {
        assert_eq!(mismatch(&lines(shown), &lines(found)).is_none(), same, "{shown} / {found}");
    }
    // What is rewritten is what is printed, as short as before.
    for (shown, found, new) in [
        ("a 1/…/d 1", "a 2/b/c/d 2", "a 2/…/d 2"),
        ("a 1/…/c 1/…", "a 2/b/c 2/d", "a 2/…/c 2/…"),
        ("a 1", "a 2/b", "a 2/b"),
        ("a b …/…", "a c d/e", "a c …/…"),
    ] {
        assert_eq!(rewritten(&lines(shown), &lines(found)), lines(new), "{shown} / {found}");
    }
}

/// A page on its way: where its commands are typed, and what was wrong.
struct Walk {
    document: String,
    home: TempDir,
    folder: PathBuf,
    wrong: Vec<String>,
    /// Lines of the page that are replaced: from, how many, by which.
    changes: Vec<(usize, usize, Vec<String>)>,
    run: usize,
    is_over: bool,
}

impl Walk {
    fn new(document: &str) -> Walk {
        let home = TempDir::new().expect("a folder");
        let folder = home.path().join("empty");
        fs::create_dir(&folder).expect("a folder");
        std::os::unix::fs::symlink(root().join("examples"), folder.join("examples")).expect("a link");
        Walk {
            document: document.to_owned(),
            home,
            folder,
            wrong: Vec::new(),
            changes: Vec::new(),
            run: 0,
            is_over: false,
        }
    }

    fn note(&mut self, place: usize, what: &str) {
        self.wrong.push(format!("{}:{}: {what}", self.document, place + 1));
    }

    fn sh(&self, line: &str) -> Ended {
        shell(&self.folder, self.home.path(), line)
    }

    /// Runs the commands of a block, and compares.
    fn type_commands(&mut self, block: &Block) {
        for shown in commands(block) {
            let first = shown.command.split_whitespace().next().unwrap_or_default();
            if let Some(to) = shown.command.strip_prefix("cd ") {
                self.folder = self.folder.join(to);
                continue;
            }
            if NOT_RUN.contains(&first) {
                continue;
            }
            self.run += 1;
            let ended = self.sh(&shown.command);
            // Golden values need a program of committed sources: the rest of the page is for that one.
            self.is_over = ended.lines.iter().any(|line| line.contains("differ from their commit"));
            if self.is_over {
                return;
            }
            if shown.code.is_some_and(|code| code != ended.code) {
                self.note(
                    shown.place,
                    &format!("`{}` ends with {}\n{}", shown.command, ended.code, ended.lines.join("\n")),
                );
            }
            if block.language == "sh" {
                continue;
            }
            if let Some(what) = mismatch(&shown.output, &ended.lines) {
                let (old, new) = (shown.output.join("\n"), ended.lines.join("\n"));
                self.note(
                    shown.place,
                    &format!("{}: {what}\n--- shown\n{old}\n--- printed\n{new}\n", shown.command),
                );
                self.changes.push((shown.below, shown.output.len(), rewritten(&shown.output, &ended.lines)));
            }
        }
    }

    /// Writes a file that the page shows, and has it understood.
    fn write_file(&mut self, block: &Block) {
        let text = block.lines.join("\n") + "\n";
        let name = block.file.clone().unwrap_or_else(|| format!("shown.{}", block.language));
        let path = self.folder.join(&name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, &text).expect("a file");
        if block.language != "toml" {
            return;
        }
        let ended = if text.starts_with("[[solver]]") || text.starts_with("[[result]]") {
            // A part of a study: a program that stands among the methods of a sweep.
            let solver = text
                .lines()
                .find_map(|line| line.strip_prefix("name = \"")?.split('"').next())
                .expect("a name");
            let sweep = format!("[[sweep]]\nmethod = [\"{solver}\"]\ncells = [10]\n");
            let study = format!("title = \"shown\"\nscene = \"terzaghi\"\n{text}{sweep}");
            fs::write(&path, study).expect("a file");
            self.sh(&format!("oedometer plan {name}"))
        } else if text.contains("scene = ") {
            self.sh(&format!("oedometer plan {name}"))
        } else {
            // A mapping: whatever it lacks of this file, its own words are understood.
            let file = root().join("examples/other-solver/column-10.csv");
            let mut ended =
                self.sh(&format!("oedometer score {} --scene terzaghi --mapping {name}", file.display()));
            ended.code = i32::from(ended.lines.iter().any(|line| line.contains(&format!("--> {name}"))));
            ended
        };
        self.run += 1;
        if ended.code != 0 {
            self.note(block.first, &format!("{name} is not understood\n{}", ended.lines.join("\n")));
        }
    }

    /// Brings the page up to date.
    fn update(&mut self) {
        let text = text_of(&self.document);
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for (from, count, new) in self.changes.drain(..).rev() {
            lines.splice(from..from + count, new);
        }
        fs::write(root().join(&self.document), lines.join("\n") + "\n").expect("a page");
    }
}

#[test]
fn every_command_and_file_of_the_manual_does_what_the_page_shows() {
    let is_update = std::env::var(UPDATE).is_ok_and(|value| value == "always");
    let pages = documents();
    let walks: Vec<Walk> = std::thread::scope(|scope| {
        let started: Vec<_> = pages
            .chunks(pages.len().div_ceil(2))
            .map(|pages| scope.spawn(|| pages.iter().map(|page| walked(page)).collect::<Vec<_>>()))
            .collect();
        started.into_iter().flat_map(|pages| pages.join().expect("pages")).collect()
    });
    let run: usize = walks.iter().map(|walk| walk.run).sum();
    let mut wrong = Vec::new();
    for mut walk in walks {
        if is_update {
            walk.update();
        }
        wrong.append(&mut walk.wrong);
    }
    assert!(wrong.is_empty(), "{}\n{UPDATE}=always writes what is printed into the pages", wrong.join("\n"));
    assert!(run >= 40, "{run} commands and files");
}

/// A page whose commands and files were tried in order.
fn walked(document: &str) -> Walk {
    let mut walk = Walk::new(document);
    for block in blocks(&text_of(document)) {
        match block.language.as_str() {
            _ if walk.is_over => break,
            "text" | "sh" => walk.type_commands(&block),
            "toml" | "csv" => walk.write_file(&block),
            _ => {}
        }
    }
    walk
}
