//! Digest of an attached solver: its program and all files beside its adapter.

use crate::study::check::solvers::digest_of_file;
use crate::study::solver::ExternalSolver;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders beside an adapter that hold results and nothing that a result depends on.
const RESULTS: [&str; 4] = ["out", "golden", "report", "__pycache__"];
/// Files beside an adapter from which on it is not known what it is made of.
const MOST_FILES: usize = 2_000;
/// Bytes of these files from which on it is not known.
const MOST_BYTES: u64 = 100_000_000;
/// Digits of the digest.
const DIGITS: usize = 16;

/// Digest of the program that the command of a solver starts, and of the files in the folders of the files that it names:
/// an adapter imports what lies beside it. TOML files count where they are named, for the others are studies. `None`
/// where nothing beside the study is named, or where there is too much to read.
pub fn program_digest(solver: &ExternalSolver) -> Option<String> {
    let named: BTreeSet<PathBuf> = solver.command.iter().filter_map(|word| solver.file(word)).collect();
    let folders: BTreeSet<&Path> = named.iter().filter_map(|file| file.parent()).collect();
    let mut files = named.clone();
    for folder in folders {
        add_files(folder, &mut files)?;
    }
    let bytes = |file: &PathBuf| fs::metadata(file).map_or(0, |about| about.len());
    if named.is_empty() || files.iter().map(bytes).sum::<u64>() > MOST_BYTES {
        return None;
    }
    files.extend(solver.command.first().and_then(|word| found_by_system(word)));
    let mut hasher = blake3::Hasher::new();
    for file in &files {
        let name = file.strip_prefix(&solver.folder).unwrap_or(file);
        hasher.update(format!("{} {}\n", name.display(), digest_of_file(file)).as_bytes());
    }
    Some(hasher.finalize().to_hex()[..DIGITS].to_owned())
}

/// Adds the files below a folder that may decide a result; `None` where there are too many.
fn add_files(folder: &Path, files: &mut BTreeSet<PathBuf>) -> Option<()> {
    for entry in fs::read_dir(folder).ok()?.flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if name.starts_with('.') || RESULTS.contains(&name.as_str()) {
            continue;
        }
        // A link to a folder may lead back to it.
        if entry.file_type().ok()?.is_dir() {
            add_files(&path, files)?;
        } else if path.is_file() && path.extension().is_none_or(|ending| ending != "toml") {
            files.insert(path);
        }
        if files.len() > MOST_FILES {
            return None;
        }
    }
    Some(())
}

/// The program that the system finds by a name without a folder.
fn found_by_system(word: &str) -> Option<PathBuf> {
    let is_name = !word.contains(std::path::is_separator);
    let folders = std::env::var_os("PATH").filter(|_| is_name)?;
    std::env::split_paths(&folders).map(|folder| folder.join(word)).find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foreign::attachment::tests::solver;

    #[test]
    fn whatever_an_adapter_may_use_changes_the_digest_and_what_it_leaves_does_not() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str, text: &str| fs::write(at(name), text).expect("a file");
        for one in ["code", "out", "report", "__pycache__"] {
            fs::create_dir(at(one)).expect("a folder");
        }
        write("adapter.py", "1");
        write("code/element.py", "1");
        let adapter = solver(folder.path(), &["sh", "adapter.py", "{case}"]);
        let digest = || program_digest(&adapter).expect("known");
        let mut before = digest();
        assert_eq!(before.len(), DIGITS);
        for unused in
            ["out/record.json", "report/index.html", "__pycache__/element.pyc", ".cache", "study.toml"]
        {
            write(unused, "2");
            assert_eq!(digest(), before, "{unused}");
        }
        for used in ["adapter.py", "code/element.py", "code/new.so"] {
            write(used, "2");
            assert_ne!(digest(), before, "{used}");
            before = digest();
        }
        let other_shell = solver(folder.path(), &["cat", "adapter.py", "{case}"]);
        assert_ne!(program_digest(&other_shell), Some(before), "another program of the system");
    }

    #[test]
    fn what_a_solver_is_made_of_is_not_known_where_nothing_is_named_or_too_much_lies_there() {
        let folder = tempfile::TempDir::new().expect("a folder");
        fs::write(folder.path().join("adapter.py"), "1").expect("a file");
        assert_eq!(program_digest(&solver(folder.path(), &["python3", "-m", "solver"])), None);
        let adapter = solver(folder.path(), &["sh", "adapter.py"]);
        assert!(program_digest(&adapter).is_some());
        for number in 0..=MOST_FILES {
            fs::write(folder.path().join(number.to_string()), "").expect("a file");
        }
        assert_eq!(program_digest(&adapter), None);
    }
}
