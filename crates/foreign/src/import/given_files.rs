//! The files that a user gives: patterns, what kind they are, and their order by the numbers in their names.

use crate::import::step_times::numbers_in;
use oedometer_formats::{ImportError, Kind};
use std::cmp::Ordering;
use std::path::{Path, PathBuf};

/// The files of each argument; `*` and `?` stand for what a shell would put there.
///
/// # Errors
/// When no file matches a pattern.
pub fn files_of(arguments: &[PathBuf]) -> Result<Vec<Vec<PathBuf>>, ImportError> {
    let of_argument = |typed: &PathBuf| {
        let pattern = typed.to_string_lossy();
        if !pattern.contains(['*', '?']) || typed.exists() {
            return Ok(vec![typed.clone()]);
        }
        let refused = |why: &str| ImportError::content(typed, why);
        let matches = |pattern: &str| -> Result<Vec<PathBuf>, glob::PatternError> {
            Ok(glob::glob(pattern)?.flatten().filter(|path| path.is_file()).collect())
        };
        let mut files = matches(&pattern).unwrap_or_default();
        if files.is_empty() {
            // Brackets may be letters of a name.
            files = matches(&pattern.replace('[', "[[]")).map_err(|error| refused(error.msg))?;
        }
        if files.is_empty() {
            return Err(refused("no file matches this pattern"));
        }
        files.sort_by(|a, b| by_numbers(a, b));
        Ok(files)
    };
    arguments.iter().map(of_argument).collect()
}

/// The order of files by the numbers in the names of their folders (`Cycle10/data.pvtu` is after `Cycle9/data.pvtu`), then by
/// those in their own.
fn by_numbers(a: &Path, b: &Path) -> Ordering {
    let above = |path: &Path| path.parent().and_then(Path::parent).map(Path::to_owned);
    let compare = |a: &str, b: &str| numbers_in(a).partial_cmp(&numbers_in(b)).unwrap_or(Ordering::Equal);
    (above(a).cmp(&above(b)))
        .then_with(|| compare(&folder_of(a), &folder_of(b)))
        .then_with(|| a.parent().cmp(&b.parent()))
        .then_with(|| compare(&stem_of(a), &stem_of(b)))
}

/// Whether the names of two files, or of their folders, differ by their numbers alone and these fall.
pub(super) fn goes_back(before: &Path, after: &Path) -> bool {
    let falls = |before: &str, after: &str| {
        without_numbers(before) == without_numbers(after) && numbers_in(after) < numbers_in(before)
    };
    let above = |path: &Path| path.parent().and_then(Path::parent).map(Path::to_owned);
    if before.parent() == after.parent() {
        return falls(&stem_of(before), &stem_of(after));
    }
    before.file_name() == after.file_name()
        && above(before) == above(after)
        && falls(&folder_of(before), &folder_of(after))
}

/// The name of a file without its extension.
fn stem_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The name of the folder that a file is in.
fn folder_of(path: &Path) -> String {
    path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether all files are tables.
///
/// # Errors
/// When one cannot be read.
pub fn are_tables(given: &[Vec<PathBuf>]) -> Result<bool, ImportError> {
    for path in given.iter().flatten() {
        if Kind::of(path)? != Kind::Table {
            return Ok(false);
        }
    }
    Ok(true)
}

/// A name with each number replaced by one `#`.
pub(super) fn without_numbers(name: &str) -> String {
    let mut blank = name.replace(|symbol: char| symbol.is_ascii_digit(), "#");
    while blank.contains("##") {
        blank = blank.replace("##", "#");
    }
    blank
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_go_back_where_the_numbers_of_like_names_fall() {
        for (before, after, told) in [
            ("a_9.vtu", "a_10.vtu", false),
            ("a_10.vtu", "a_9.vtu", true),
            ("a_10.vtu", "b_9.vtu", false),
            ("col_ts_50_t_4.0875.vtu", "col_ts_100_t_8.175.vtu", false),
            ("t_0.5.csv", "t_0.25.csv", true),
            ("Cycle9/a.pvtu", "Cycle10/a.pvtu", false),
            ("Cycle10/a.pvtu", "Cycle9/a.pvtu", true),
            ("x/Cycle10/a.pvtu", "y/Cycle9/a.pvtu", false),
            ("mesh-20/a_1.vtu", "mesh-10/a_2.vtu", false),
        ] {
            assert_eq!(goes_back(Path::new(before), Path::new(after)), told, "{before} {after}");
        }
    }

    #[test]
    fn patterns_find_files_in_the_order_of_their_numbers() {
        let folder = tempfile::TempDir::new().expect("a folder");
        for name in ["a_10.vtk", "a_9.vtk", "b_1.vtk", "a_100.vtk"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        let given = files_of(&[folder.path().join("a_*.vtk")]).expect("files");
        let names: Vec<_> = given[0].iter().map(|path| path.file_name().expect("a name")).collect();
        assert_eq!(names, ["a_9.vtk", "a_10.vtk", "a_100.vtk"]);
        assert!(files_of(&[folder.path().join("c*")]).is_err());
        assert_eq!(without_numbers("col_ts_50_t_4.0875.vtu"), "col_ts_#_t_#.#.vtu");
    }
}
