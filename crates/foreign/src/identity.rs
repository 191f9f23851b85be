//! By what an attached program is known: the program that its command starts, the files that command and environment name,
//! what the study names in `known_by`, and what its version command prints.
//!
//! What a program reads beside these cannot be known: an adapter imports packages from anywhere, and compiled programs
//! stand in no commit. So this identity decides about a result only where the study declares that it does.

use crate::git;
use crate::process::{self, Ending, Order};
use crate::solver::{ExternalSolver, placeholders_of};
use crate::staging::words_of;
use oedometer_formats::input_file;
use oedometer_wording::typed;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Longest time that a command may take to tell its version, s.
const VERSION_SECONDS: f64 = 60.0;
/// Longest version that is kept, letters.
pub(super) const LONGEST_VERSION: usize = 200;
/// Digits of a digest.
const DIGITS: usize = 16;
/// Folders that hold nothing a result depends on but copies of what stands beside them.
const COPIES: [&str; 2] = [".git", "__pycache__"];
/// Files in `known_by` from which on they are not read.
const MOST_FILES: usize = 50_000;

/// What a solver says of its version.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Version {
    /// The first line that it printed.
    pub line: Option<String>,
    /// All that it printed, where it ended well.
    printed: Option<String>,
}

impl Version {
    /// Asks a solver for its version, within the time of a run and with its environment.
    ///
    /// # Errors
    /// A sentence, where it does not answer in time.
    pub(crate) fn asked(solver: &ExternalSolver, is_wanted: &dyn Fn() -> bool) -> Result<Self, String> {
        if solver.version.is_empty() {
            return Ok(Self::default());
        }
        let folder = solver.folder.display().to_string();
        let fill = |text: &str| text.replace("{study}", &folder);
        let words = words_of(solver, &solver.version, fill);
        // Variables that tell a case have no value here.
        let is_of_study = |value: &str| placeholders_of(value).all(|name| name == "study");
        let environment: Vec<(String, String)> = (solver.environment.iter())
            .filter(|(_, value)| is_of_study(value))
            .map(|(name, value)| (name.clone(), fill(value)))
            .collect();
        let seconds = solver.timeout.min(VERSION_SECONDS);
        let timeout = Duration::from_secs_f64(seconds);
        let order = Order { words: &words, environment: &environment, folder: &solver.folder, timeout };
        let answer = process::run(&order, is_wanted);
        if matches!(answer.ending, Ending::TimedOut) {
            let limit = typed(seconds);
            return Err(format!("its version is not known: that command did not end within {limit} s"));
        }
        let line = answer.output.lines().chain(answer.errors.lines()).find(|line| !line.trim().is_empty());
        let is_well = matches!(&answer.ending, Ending::Ended(status) if status.success());
        Ok(Self {
            line: line.map(|line| line.trim().chars().take(LONGEST_VERSION).collect()),
            printed: (is_well && line.is_some()).then(|| format!("{}\0{}", answer.output, answer.errors)),
        })
    }
}

/// Digest of all by which a program is known.
///
/// # Errors
/// A sentence, where a part of it is not known.
pub(crate) fn digest_of_program(solver: &ExternalSolver, version: &Version) -> Result<String, String> {
    let mut hasher = blake3::Hasher::new();
    let mut files: BTreeSet<PathBuf> = solver.words().filter_map(|word| solver.file(word)).collect();
    files.extend(solver.command.first().and_then(|word| found_by_system(word)));
    for typed in solver.known_by.iter().flatten() {
        hasher.update(format!("known by {typed}\n").as_bytes());
        let mut above = BTreeSet::new();
        add_files(&solver.place(typed), &mut files, &mut above)?;
    }
    for file in &files {
        let name = file.strip_prefix(&solver.folder).unwrap_or(file);
        hasher.update(format!("{} ", name.display()).as_bytes());
        let read = input_file::open(file).and_then(|open| hasher.update_reader(open).map(|_| ()));
        read.map_err(|error| format!("{} cannot be read: {error}", file.display()))?;
    }
    if !solver.version.is_empty() {
        let printed = version.printed.as_ref().ok_or("its version command failed or printed nothing")?;
        hasher.update(b"version ").update(printed.as_bytes());
    }
    Ok(hasher.finalize().to_hex()[..DIGITS].to_owned())
}

/// Adds a file, or all files below a folder; `above` are the folders that lead there, for a link may lead back.
fn add_files(
    path: &Path,
    files: &mut BTreeSet<PathBuf>,
    above: &mut BTreeSet<PathBuf>,
) -> Result<(), String> {
    let refused = |error: std::io::Error| format!("{} cannot be read: {error}", path.display());
    let about = fs::metadata(path).map_err(refused)?;
    if about.is_file() {
        files.insert(path.to_owned());
        let is_too_much = files.len() > MOST_FILES;
        return if is_too_much { Err(format!("more than {MOST_FILES} files are named")) } else { Ok(()) };
    }
    let whole = path.canonicalize().map_err(refused)?;
    if !about.is_dir() || !above.insert(whole.clone()) {
        return Ok(());
    }
    for entry in fs::read_dir(path).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        let is_copy = COPIES.iter().any(|name| entry.file_name() == *name);
        // A link to nothing is not read by a program either.
        if !is_copy && entry.path().exists() {
            add_files(&entry.path(), files, above)?;
        }
    }
    above.remove(&whole);
    Ok(())
}

/// The program that the system finds by a name without a folder.
fn found_by_system(word: &str) -> Option<PathBuf> {
    let is_name = !word.contains(std::path::is_separator);
    let folders = std::env::var_os("PATH").filter(|_| is_name)?;
    std::env::split_paths(&folders).map(|folder| folder.join(word)).find(|path| path.is_file())
}

/// Commit of the repository that holds a folder, and whether tracked files have changed since; `None` outside of one.
pub fn commit_of(folder: &Path) -> Option<String> {
    let commit = git::answer(folder, &["rev-parse", "--short=8", "HEAD"])?;
    let changes = git::answer(folder, &["status", "--porcelain", "--untracked-files=no"])?;
    let changed = if changes.trim().is_empty() { "" } else { " with changes" };
    Some(format!("{}{changed}", commit.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::tests::solver;

    #[test]
    fn whatever_a_study_names_changes_the_identity_of_a_program_and_nothing_else_does() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for name in ["src/deep", "src/__pycache__", "lib", "elsewhere"] {
            fs::create_dir_all(at(name)).expect("a folder");
        }
        let write = |name: &str, text: &str| fs::write(at(name), text).expect("a file");
        let all =
            ["a.sh", "input.txt", "src/deep/k.py", "lib/x.py", "lib/y.py", "src/__pycache__/k.pyc", "b.py"];
        for name in all {
            write(name, "1");
        }
        let mut adapter = solver(folder.path(), &["sh", "a.sh", "{case}"]);
        adapter.environment = vec![("INPUT".to_owned(), "{study}/input.txt".to_owned())];
        adapter.known_by = Some(["src/", "lib/x.py"].map(str::to_owned).to_vec());
        adapter.version = ["cat", "b.py"].map(str::to_owned).to_vec();
        let digest = |solver: &ExternalSolver| {
            digest_of_program(solver, &Version::asked(solver, &|| true).expect("in time"))
        };
        #[cfg(unix)]
        for (target, link) in
            [("../src", "src/back"), ("../elsewhere", "src/linked"), ("nowhere", "src/dangling")]
        {
            std::os::unix::fs::symlink(target, at(link)).expect("a link");
        }
        for (name, is_part) in [
            ("a.sh", true),
            ("input.txt", true),
            ("src/deep/k.py", true),
            ("src/new.so", true),
            ("lib/x.py", true),
            ("lib/y.py", false),
            ("src/__pycache__/k.pyc", false),
            ("b.py", true),
            #[cfg(unix)]
            ("elsewhere/z.py", true),
        ] {
            let before = digest(&adapter).expect("known");
            let kept = fs::read_to_string(at(name)).ok();
            write(name, "2");
            assert_eq!(digest(&adapter).expect("known") != before, is_part, "{name}");
            kept.map_or_else(|| fs::remove_file(at(name)), |text| fs::write(at(name), text))
                .expect("as it was");
            assert_eq!(digest(&adapter).expect("known"), before, "{name} as it was");
        }
        // All that the version command prints counts, and what it does not tell is not known.
        for (version, is_known) in
            [(&["cat", "b.py"][..], true), (&["true"], false), (&["sh", "-c", "echo 1; exit 3"], false)]
        {
            adapter.version = version.iter().map(|word| (*word).to_owned()).collect();
            assert_eq!(digest(&adapter).is_ok(), is_known, "{version:?}");
        }
        let lines = |second: &str| ["printf".to_owned(), format!("1\n{second}")].to_vec();
        let of = |second: &str| {
            digest(&ExternalSolver { version: lines(second), ..adapter.clone() }).expect("known")
        };
        assert_ne!(of("a"), of("b"), "the second line");
        adapter.version = ["printenv", "INPUT"].map(str::to_owned).to_vec();
        let told = Version::asked(&adapter, &|| true).expect("in time").line;
        assert_eq!(told, Some(at("input.txt").display().to_string()), "it has the environment of the solver");
        adapter.known_by = Some(vec!["gone".to_owned()]);
        assert!(digest(&adapter).expect_err("not there").contains("gone cannot be read"));
    }
}
