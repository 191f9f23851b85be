//! Checks attached solvers and existing results: names, commands, placeholders, files; and makes their digest.

use crate::case::keys::MOST_CELLS;
use crate::case::solver::DIGEST_DIGITS;
use crate::case::{Attached, Case, SolverName, Tier};
use crate::import::mapping::Mapping;
use crate::study::check::Checker;
use crate::study::diagnostic::one_of;
use crate::study::file::{ResultTable, SolverTable, StudyFile, StudySource};
use crate::study::reading::Placed;
use crate::study::solver::{
    ExternalSolver, PLACEHOLDERS, PRESETS, Preset, SOLVE_UNITS, file_beside, placeholders_of,
};
use oedometer_formats::{input_file, with_named};
use oedometer_problem::method::Method;
use std::path::{Path, PathBuf};

/// Most timed runs of a case.
const MOST_REPEATS: i64 = 100;
/// Most runs of a solver at the same time.
const MOST_AT_ONCE: i64 = 1024;
/// Longest pattern of a time, letters.
const LONGEST_PATTERN: usize = 500;
/// By what a program may be known, so that its results are reused.
const REUSES: [&str; 1] = ["version"];
/// What stands for the mesh in the names of files.
const MESH: &str = "cells";

/// The meshes of a result that is there.
pub(super) struct GivenMeshes {
    method: SolverName,
    cells: Vec<usize>,
    /// Smallest tier that includes it.
    pub(super) tier: Tier,
}

impl GivenMeshes {
    /// A case a mesh.
    pub(super) fn cases(&self, base: &Case) -> Vec<Case> {
        let of_mesh =
            |cells: &usize| Case { method: self.method, cells: *cells, ..base.clone() }.as_its_solver_knows();
        self.cells.iter().map(of_mesh).collect()
    }
}

impl Checker<'_> {
    /// The solvers that a study attaches.
    pub(super) fn attach_solvers(&mut self, file: &StudyFile, case_seconds: f64) {
        for table in &file.solver {
            if self.name_is_free(&table.name, "solver") {
                match self.solver(table, case_seconds) {
                    Some(solver) => self.solvers.push(solver),
                    None => self.refused_solvers.push(table.name.to_string()),
                }
            }
        }
    }

    /// The results of a study, whose names join those of its solvers.
    pub(super) fn attach_results(&mut self, file: &StudyFile) -> Vec<GivenMeshes> {
        let mut all = Vec::new();
        for table in &file.result {
            if self.name_is_free(&table.name, "result") {
                match self.given_result(table) {
                    Some(meshes) => all.push(meshes),
                    None => self.refused_solvers.push(table.name.to_string()),
                }
            }
        }
        all
    }

    fn name_is_free(&mut self, name: &Placed<String>, what: &str) -> bool {
        let taken = if Method::named(name).is_some() {
            "a method of this program"
        } else if self.solvers.iter().any(|solver| solver.name() == name.as_str()) {
            "the name of another solver or result"
        } else {
            return true;
        };
        let message = format!("`{}` is {taken}", **name);
        self.complain(name.span(), message, format!("give the {what} another name"));
        false
    }

    /// The identity of a solver or result by its name and digest.
    fn identity(&mut self, name: &Placed<String>, what: &str, digest: &str) -> Option<Attached> {
        Attached::new(name, digest)
            .map_err(|why| {
                let message = format!("a {what} cannot be called `{}`", **name);
                self.complain(name.span(), message, why.to_string());
            })
            .ok()
    }

    fn solver(&mut self, table: &SolverTable, case_seconds: f64) -> Option<ExternalSolver> {
        let before = self.complaints.len();
        let command = words_of(&table.command);
        if command.is_empty() {
            let help = "write the program and its arguments, like [\"python3\", \"adapter.py\", \"{case}\", \"{out}\"]";
            self.complain(table.command.span(), "the command is empty", help);
        }
        self.words_can_be_passed_on(table);
        self.result_is_fresh(&table.result);
        for word in table.version.iter().flat_map(|list| &***list) {
            if let Some(name) = placeholders_of(word).next() {
                let message = format!("the command for the version has a placeholder, `{{{name}}}`");
                self.complain(word.span(), message, "it runs without a case: write it without placeholders");
            }
        }
        let preset = self.preset_of(table.preset.as_ref());
        let folder = folder_of(&self.source.name);
        let mapping = self.file_of_study(table.mapping.as_ref(), &folder);
        for file in table.files.iter().flat_map(|list| &***list) {
            self.file_of_study(Some(file), &folder);
        }
        self.pattern_has_a_group(table);
        let repeats = self.count(table.repeats.as_ref(), "repeats", 1..=MOST_REPEATS).unwrap_or(1);
        let at_once = self.count(table.at_once.as_ref(), "at_once", 1..=MOST_AT_ONCE).unwrap_or(1);
        let timeout = self.positive(table.timeout.as_ref(), "timeout", "s", case_seconds);
        let solve_unit = self.solve_unit(table);
        let time_step =
            table.time_step.as_ref().map(|typed| self.positive(Some(typed), "time_step", "s", 1.0));
        let known_by = self.known_by(table, &folder);
        let identity = self.identity(&table.name, "solver", &digest_of_solver(table, &folder))?;
        (self.complaints.len() == before).then(|| ExternalSolver {
            identity,
            folder,
            command,
            result: table.result.to_string(),
            files: Vec::new(),
            time_step,
            mapping,
            preset,
            version: table.version.as_ref().map_or(Vec::new(), |list| words_of(list)),
            known_by,
            timeout,
            repeats,
            warm_up: table.warm_up.unwrap_or(repeats > 1),
            at_once,
            environment: pairs_of(table),
            solve_seconds: table.solve_seconds.as_deref().cloned(),
            solve_unit,
        })
    }

    fn given_result(&mut self, table: &ResultTable) -> Option<GivenMeshes> {
        let before = self.complaints.len();
        let cells: Vec<usize> =
            table.cells.iter().filter_map(|typed| self.count(Some(typed), "cells", 1..=MOST_CELLS)).collect();
        let files = words_of(&table.files);
        for typed in table.files.iter() {
            if let Some(other) = placeholders_of(typed).find(|name| *name != MESH) {
                let message = format!("`{{{other}}}` has no meaning in the files of a result");
                self.complain(typed.span(), message, "`{cells}` stands for the cells over the height");
            }
        }
        let names_mesh = files.iter().any(|file| placeholders_of(file).any(|name| name == MESH));
        for (place, is_wrong, message, help) in [
            (
                table.cells.span(),
                table.cells.is_empty(),
                "no mesh".to_owned(),
                "name the cells over the height of each, like [10, 20]",
            ),
            (
                table.files.span(),
                files.is_empty(),
                "no file".to_owned(),
                "name the files of one mesh, like [\"ogs-{cells}/col.pvd\"]",
            ),
            (
                table.files.span(),
                cells.len() > 1 && !names_mesh,
                format!("{} meshes have the same files", cells.len()),
                "write `{cells}` where their names differ, or one [[result]] per mesh",
            ),
        ] {
            if is_wrong {
                self.complain(place, message, help);
            }
        }
        let time_step =
            table.time_step.as_ref().map(|typed| self.positive(Some(typed), "time_step", "s", 1.0));
        let preset = self.preset_of(table.preset.as_ref());
        let folder = folder_of(&self.source.name);
        let mapping = self.file_of_study(table.mapping.as_ref(), &folder);
        let digest = digest_of_result(table, &files, &cells, &folder);
        let identity = self.identity(&table.name, "result", &digest)?;
        if self.complaints.len() > before {
            return None;
        }
        self.solvers.push(ExternalSolver {
            identity,
            folder,
            command: Vec::new(),
            result: String::new(),
            files,
            time_step,
            mapping,
            preset,
            version: Vec::new(),
            known_by: None,
            timeout: 0.0,
            repeats: 1,
            warm_up: false,
            at_once: 1,
            environment: Vec::new(),
            solve_seconds: None,
            solve_unit: 1.0,
        });
        Some(GivenMeshes { method: SolverName::Attached(identity), cells, tier: table.tier })
    }

    /// No system passes on a zero letter, nor a variable's name with `=` in it: it would set another variable.
    fn words_can_be_passed_on(&mut self, table: &SolverTable) {
        let known = PLACEHOLDERS.map(|(name, _)| name);
        for text in table.command.iter().chain([&table.result]).chain(table.env.values()) {
            for name in placeholders_of(text).filter(|name| !known.contains(name)) {
                let message = format!("no placeholder is called `{{{name}}}`");
                self.complain(text.span(), message, one_of(name, &known));
            }
        }
        let version = table.version.iter().flat_map(|list| &***list);
        for word in table.command.iter().chain(version).chain(table.env.values()) {
            if word.contains('\0') {
                let message = "it contains the letter NUL, which cannot be passed to a program";
                self.complain(word.span(), message, "leave it out");
            }
        }
        for (name, value) in &table.env {
            if name.is_empty() || name.contains(['=', '\0']) {
                let message = format!("`{}` cannot be the name of a variable", name.escape_debug());
                let help = "write name and value separately, like env = { OMP_NUM_THREADS = \"1\" }";
                self.complain(value.span(), message, help);
            }
        }
    }

    /// A result elsewhere than in the fresh folder could be that of an earlier run.
    fn result_is_fresh(&mut self, result: &Placed<String>) {
        let below = result.strip_prefix("{out}/");
        let is_below = below.is_some_and(|rest| !rest.is_empty() && rest.split('/').all(|part| part != ".."));
        if !is_below {
            self.complain(
                result.span(),
                "the result must lie below `{out}`, which is empty at the start",
                "write it like \"{out}/result.csv\", and let the adapter write it there",
            );
        }
    }

    /// A program whose files are known.
    fn preset_of(&mut self, typed: Option<&Placed<String>>) -> Option<Preset> {
        let index = self.word(typed?, "preset", &PRESETS.map(|preset| preset.name))?;
        Some(PRESETS[index])
    }

    /// The name of a file of the adapter, which must be there.
    fn file_of_study(&mut self, typed: Option<&Placed<String>>, folder: &Path) -> Option<String> {
        let typed = typed?;
        let path = folder.join(typed.as_str());
        if !path.is_file() {
            let help = "give the path of a file relative to the folder of the study";
            self.complain(typed.span(), format!("there is no file {}", path.display()), help);
        }
        Some(typed.to_string())
    }

    /// By what the program is known beside its command's files, where the study declares that its results may be reused.
    fn known_by(&mut self, table: &SolverTable, folder: &Path) -> Option<Vec<String>> {
        let named = table.known_by.as_ref().map_or(Vec::new(), |list| words_of(list));
        for typed in table.known_by.iter().flat_map(|list| &***list) {
            let path = folder.join(typed.strip_prefix("{study}/").unwrap_or(typed));
            if !path.exists() {
                let help = "give paths relative to the folder of the study";
                self.complain(typed.span(), format!("there is no file or folder {}", path.display()), help);
            }
        }
        let Some(reuse) = &table.reuse else {
            if let Some(typed) = &table.known_by {
                let help = "add reuse = \"version\" to reuse results while these files are unchanged";
                self.complain(typed.span(), "`known_by` has no effect without `reuse`", help);
            }
            return None;
        };
        self.word(reuse, "reuse", &REUSES)?;
        if table.version.is_none() && named.is_empty() {
            let help = "add the command that prints its version, like version = [\"ogs\", \"--version\"], or the files that \
                        it is made of, like known_by = [\"src/\"]";
            self.complain(reuse.span(), "`reuse` needs something that identifies the program", help);
        }
        Some(named)
    }

    /// The unit of the time that it says it took, s.
    fn solve_unit(&mut self, table: &SolverTable) -> f64 {
        let Some(typed) = &table.solve_unit else { return 1.0 };
        let known = SOLVE_UNITS.iter().find(|(name, _)| *name == typed.as_str());
        if known.is_none() || table.solve_seconds.is_none() {
            let names = SOLVE_UNITS.map(|(name, _)| name).join(", ");
            let message = format!("`solve_unit` is the unit of `solve_seconds`: {names}");
            self.complain(typed.span(), message, "write both, like solve_unit = \"ms\"");
        }
        known.map_or(1.0, |(_, seconds)| *seconds)
    }

    fn pattern_has_a_group(&mut self, table: &SolverTable) {
        let Some(typed) = &table.solve_seconds else { return };
        let example = "like \"It took ([0-9.e+-]+) s\"";
        let (message, help) = match regex_lite::Regex::new(typed) {
            _ if typed.len() > LONGEST_PATTERN => (
                format!("the pattern has more than {LONGEST_PATTERN} letters"),
                format!("write a short one, {example}"),
            ),
            Err(error) => (format!("this is not a regular expression: {error}"), example.to_owned()),
            Ok(regex) if regex.captures_len() < 2 => (
                "the pattern has no group for the seconds".to_owned(),
                format!("put the number into parentheses, {example}"),
            ),
            Ok(_) => return,
        };
        self.complain(typed.span(), message, help);
    }
}

fn words_of(list: &[Placed<String>]) -> Vec<String> {
    list.iter().map(|word| word.to_string()).collect()
}

fn pairs_of(table: &SolverTable) -> Vec<(String, String)> {
    table.env.iter().map(|(name, value)| (name.clone(), value.to_string())).collect()
}

/// Folder of a study file; of a text without a file, the present one.
fn folder_of(study: &str) -> PathBuf {
    let folder = Path::new(study).parent().unwrap_or(Path::new(""));
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned())
}

/// Gathers what decides a result beside the case.
#[derive(Default)]
struct Digest(blake3::Hasher);

impl Digest {
    fn take(&mut self, kind: &str, text: &str) {
        self.0.update(format!("{kind} {}\n{text}\n", text.len()).as_bytes());
    }

    fn finish(&self) -> String {
        self.0.finalize().to_hex()[..DIGEST_DIGITS].to_owned()
    }
}

/// Digest of what decides the result of a solver beside the case: its command and environment as typed, how the
/// result is read, and the contents of the adapter's files. Neither where it stands nor how long it may take.
fn digest_of_solver(table: &SolverTable, folder: &Path) -> String {
    let mut digest = Digest::default();
    for word in table.command.iter() {
        digest.take("word", word);
    }
    for (name, value) in pairs_of(table) {
        digest.take("variable", &name);
        digest.take("value", &value);
    }
    digest.take("result", &table.result);
    if let Some(typed) = &table.time_step {
        digest.take("time step", &format!("{:e}", **typed));
    }
    if let Some(preset) = &table.preset {
        digest.take("preset", preset);
    }
    let files = table.files.iter().flat_map(|list| &***list);
    for word in table.command.iter().chain(files).chain(&table.mapping).chain(table.env.values()) {
        if let Some(path) = file_beside(folder, word) {
            digest.take("file", &digest_of_file(&path));
        }
    }
    digest.finish()
}

/// Digest of what the result of a mesh is made of: how it is read, and what its files hold now, with those that they or the
/// mapping name. A file that changes makes other cases, so that no record of it is taken as theirs.
fn digest_of_result(table: &ResultTable, files: &[String], cells: &[usize], folder: &Path) -> String {
    let mut digest = Digest::default();
    let mapping = table.mapping.as_ref().map(|typed| folder.join(typed.as_str()));
    let source = mapping.and_then(|path| {
        Some(StudySource { text: input_file::read_text(&path).ok()?, name: path.display().to_string() })
    });
    let mapping = source.and_then(|source| Mapping::read(&source).ok());
    let curve = mapping.and_then(|mapping| mapping.settlement).map(|series| series.file);
    for file in files {
        digest.take("name", file);
        for cells in cells {
            // What a pattern matches is in the digest of the record.
            let given = folder.join(file.replace("{cells}", &cells.to_string()));
            let curve = curve.iter().filter_map(|curve| Some(given.parent()?.join(curve)));
            for path in with_named(&given).into_iter().chain(curve).filter(|path| path.is_file()) {
                digest.take("file", &digest_of_file(&path));
            }
        }
    }
    if let Some(typed) = &table.mapping {
        digest.take("mapping", &digest_of_file(&folder.join(typed.as_str())));
    }
    if let Some(typed) = &table.preset {
        digest.take("preset", typed);
    }
    if let Some(typed) = &table.time_step {
        digest.take("time step", &format!("{:e}", **typed));
    }
    digest.finish()
}

/// Digest of the content of a file; of one that cannot be read, a word.
fn digest_of_file(path: &Path) -> String {
    let mut hasher = blake3::Hasher::new();
    let read = input_file::open(path).and_then(|file| hasher.update_reader(file).map(|_| ()));
    read.map_or_else(|_| "unreadable".to_owned(), |()| hasher.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests;
