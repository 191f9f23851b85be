//! Checks of attached solvers: names, commands, placeholders, files; and the digest that identifies them.

use crate::case::{Case, Task};
use crate::study::check::checker::Checker;
use crate::study::choice_tables::{Placed, TypedList};
use crate::study::diagnostic::one_of;
use crate::study::file::StudyFile;
use crate::study::solver::{PLACEHOLDERS, PRESETS, Solver, file_beside, placeholders_of};
use crate::study::solver_table::SolverTable;
use oedometer_formats::input_file;
use oedometer_mpm::attached_method::{Attached, DIGEST_DIGITS};
use oedometer_mpm::method::Method;
use std::path::{Path, PathBuf};

/// Most timed runs of a case.
const MOST_REPEATS: i64 = 100;
/// Most runs of a solver at the same time.
const MOST_AT_ONCE: i64 = 1024;
/// Longest pattern of a time, letters.
const LONGEST_PATTERN: usize = 500;

impl Checker<'_> {
    /// The solvers that a study attaches.
    pub(crate) fn solvers(&mut self, file: &StudyFile, case_seconds: f64) -> Vec<Solver> {
        let mut solvers: Vec<Solver> = Vec::new();
        for entry in &file.solver {
            let table = entry.get_ref();
            let (name, span) = (table.name.get_ref(), table.name.span());
            if Method::named(name).is_some() {
                let message = format!("`{name}` is a method of this program");
                self.complain(span, message, "give the solver another name");
                continue;
            }
            if solvers.iter().any(|solver| solver.name() == name) {
                let message = format!("two solvers are called `{name}`");
                self.complain(span, message, "give each a name of its own");
                continue;
            }
            solvers.extend(self.solver(table, case_seconds));
        }
        solvers
    }

    /// Complains where the critical step of an attached solver is asked for.
    pub(crate) fn attached_are_solved(&mut self, start: usize, mut cases: impl Iterator<Item = Case>) {
        if cases.any(|case| case.is_attached() && case.task == Task::Stability) {
            self.complain(
                start..start + 1,
                "an attached solver has no critical step that could be searched",
                "name methods of this program alone, or leave `task` out",
            );
        }
    }

    fn solver(&mut self, table: &SolverTable, case_seconds: f64) -> Option<Solver> {
        let before = self.diagnostics.len();
        let command = words_of(&table.command);
        if command.is_empty() {
            let help = "write the program and its arguments, like [\"python3\", \"adapter.py\", \"{case}\", \"{out}\"]";
            self.complain(table.command.span(), "the command is empty", help);
        }
        let texts = table.command.get_ref().iter().chain([&table.result]).chain(table.env.values());
        for text in texts {
            self.placeholders_are_known(text);
        }
        self.words_can_be_passed_on(table);
        self.result_is_fresh(&table.result);
        for word in table.version.iter().flat_map(|list| list.get_ref()) {
            if let Some(name) = placeholders_of(word.get_ref()).next() {
                let message = format!("the version's command has a placeholder, `{{{name}}}`");
                self.complain(word.span(), message, "it is asked without a case: write it as it stands");
            }
        }
        let folder = folder_of(&self.source.name);
        let mapping = self.file_of_study(table.mapping.as_ref(), &folder);
        for file in table.files.iter().flat_map(|list| list.get_ref()) {
            self.file_of_study(Some(file), &folder);
        }
        let preset = self.preset_of(table.preset.as_ref());
        self.pattern_has_a_group(table);
        let repeats = self.count(table.repeats.as_deref(), "repeats", 1..=MOST_REPEATS).unwrap_or(1);
        let at_once = self.count(table.at_once.as_deref(), "at_once", 1..=MOST_AT_ONCE).unwrap_or(1);
        let timeout = self.positive(table.timeout.as_deref(), "timeout", "s", case_seconds);
        let digest = digest_of(table, &folder);
        let attached = match Attached::new(table.name.get_ref(), &digest) {
            Ok(attached) => attached,
            Err(why) => {
                let message = format!("a solver cannot be called `{}`", table.name.get_ref());
                self.complain(table.name.span(), message, why.to_string());
                return None;
            }
        };
        (self.diagnostics.len() == before).then(|| Solver {
            attached,
            folder,
            command,
            result: table.result.get_ref().clone(),
            files: Vec::new(),
            time_step: None,
            mapping,
            preset,
            version: table.version.as_ref().map_or(Vec::new(), words_of),
            timeout,
            repeats,
            warm_up: table.warm_up.as_ref().map_or(repeats > 1, |typed| *typed.get_ref()),
            at_once,
            environment: pairs_of(table),
            solve_seconds: table.solve_seconds.as_ref().map(|typed| typed.get_ref().clone()),
        })
    }

    fn placeholders_are_known(&mut self, text: &Placed<String>) {
        let known = PLACEHOLDERS.map(|(name, _)| name);
        for name in placeholders_of(text.get_ref()) {
            if !known.contains(&name) {
                let message = format!("no placeholder is called `{{{name}}}`");
                self.complain(text.span(), message, one_of(name, &known));
            }
        }
    }

    /// No system passes on a zero letter, nor a variable's name with `=` in it: it would set another variable.
    fn words_can_be_passed_on(&mut self, table: &SolverTable) {
        let version = table.version.iter().flat_map(|list| list.get_ref());
        for word in table.command.get_ref().iter().chain(version).chain(table.env.values()) {
            if word.get_ref().contains('\0') {
                self.complain(
                    word.span(),
                    "the letter NUL is in it, which no program can be told",
                    "leave it out",
                );
            }
        }
        for (name, value) in &table.env {
            if name.is_empty() || name.contains(['=', '\0']) {
                let message = format!("`{}` is no name of a variable", name.escape_debug());
                let help = "write the name and the value apart, like env = { OMP_NUM_THREADS = \"1\" }";
                self.complain(value.span(), message, help);
            }
        }
    }

    /// A result elsewhere than in the fresh folder could be that of an earlier run.
    fn result_is_fresh(&mut self, result: &Placed<String>) {
        let below = result.get_ref().strip_prefix("{out}/");
        let is_below = below.is_some_and(|rest| !rest.is_empty() && rest.split('/').all(|part| part != ".."));
        if !is_below {
            self.complain(
                result.span(),
                "the result does not lie below `{out}`, where it is fresh",
                "write it like \"{out}/result.csv\", and have the adapter write it there",
            );
        }
    }

    /// A program whose files are known.
    pub(crate) fn preset_of(&mut self, typed: Option<&Placed<String>>) -> Option<String> {
        let typed = typed?;
        self.word(typed, "preset", &PRESETS);
        Some(typed.get_ref().clone())
    }

    /// The name of a file of the adapter, which must be there.
    pub(crate) fn file_of_study(&mut self, typed: Option<&Placed<String>>, folder: &Path) -> Option<String> {
        let typed = typed?;
        let path = folder.join(typed.get_ref());
        if !path.is_file() {
            self.complain(
                typed.span(),
                format!("there is no file {}", path.display()),
                "name a file by its path from the folder of the study",
            );
        }
        Some(typed.get_ref().clone())
    }

    fn pattern_has_a_group(&mut self, table: &SolverTable) {
        let Some(typed) = &table.solve_seconds else { return };
        let pattern = typed.get_ref();
        let example = "like \"It took ([0-9.e+-]+) s\"";
        match regex_lite::Regex::new(pattern) {
            _ if pattern.len() > LONGEST_PATTERN => {
                let message = format!("the pattern has more than {LONGEST_PATTERN} letters");
                self.complain(typed.span(), message, format!("write a short one, {example}"));
            }
            Err(error) => self.complain(typed.span(), format!("no regular expression: {error}"), example),
            Ok(regex) if regex.captures_len() < 2 => self.complain(
                typed.span(),
                "the pattern has no group for the seconds",
                format!("put the number into parentheses, {example}"),
            ),
            Ok(_) => {}
        }
    }
}

fn words_of(list: &Placed<Vec<Placed<String>>>) -> Vec<String> {
    list.get_ref().iter().map(|word| word.get_ref().clone()).collect()
}

fn pairs_of(table: &SolverTable) -> Vec<(String, String)> {
    table.env.iter().map(|(name, value)| (name.clone(), value.get_ref().clone())).collect()
}

/// Folder of a study file; of a text that is no file the present one.
pub(crate) fn folder_of(study: &str) -> PathBuf {
    let folder = Path::new(study).parent().unwrap_or(Path::new(""));
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned())
}

/// Digest of what decides the result of a solver beside the case: its command and environment as typed, how the
/// result is read, and the contents of the adapter's files. Neither where it stands nor how long it may take.
fn digest_of(table: &SolverTable, folder: &Path) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut take = |kind: &str, text: &str| {
        hasher.update(format!("{kind} {}\n{text}\n", text.len()).as_bytes());
    };
    let words = |list: &TypedList<String>| list.as_ref().map_or(Vec::new(), words_of);
    let command = words_of(&table.command);
    for word in &command {
        take("word", word);
    }
    for (name, value) in pairs_of(table) {
        take("variable", &name);
        take("value", &value);
    }
    take("result", table.result.get_ref());
    if let Some(preset) = &table.preset {
        take("preset", preset.get_ref());
    }
    let mapping = table.mapping.iter().map(|typed| typed.get_ref().clone());
    for word in command.iter().cloned().chain(words(&table.files)).chain(mapping) {
        if let Some(path) = file_beside(folder, &word) {
            take("file", &digest_of_file(&path));
        }
    }
    hasher.finalize().to_hex()[..DIGEST_DIGITS].to_owned()
}

/// Digest of the content of a file; of one that cannot be read, a word.
pub(crate) fn digest_of_file(path: &Path) -> String {
    let mut hasher = blake3::Hasher::new();
    let read = input_file::open(path).and_then(|file| hasher.update_reader(file).map(|_| ()));
    read.map_or_else(|_| "unreadable".to_owned(), |()| hasher.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests;
