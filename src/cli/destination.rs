//! Writes files that a user names for a copy of the verdicts. A regular file is replaced as a whole, a link is followed,
//! and other targets (a terminal, a pipe, `/dev/stdout`) are appended to. Also reads variables of the environment.

use crate::cli::exit::{Ended, Exit};
use crate::record::whole_file::write_whole;
use crate::render::escape::document;
use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes a document to a path.
///
/// # Errors
/// When the file system refuses, with the path.
pub fn write_document(path: &Path, text: &str) -> anyhow::Result<()> {
    let text = &document(text);
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    let target = fs::metadata(path);
    match target {
        // A device may be this program's own output, so it is not truncated.
        Ok(found) if !found.is_file() || is_system_path(path) => {
            through(path, OpenOptions::new().append(true), text)
        }
        Ok(_) if is_link => {
            let behind = fs::canonicalize(path).map_err(|error| refused(path, &error))?;
            write_whole(&behind, text.as_bytes()).map_err(|error| refused(path, &error))
        }
        Err(_) if is_link => through(path, OpenOptions::new().create(true).append(true), text),
        _ => write_whole(path, text.as_bytes()).map_err(|error| refused(path, &error)),
    }
}

/// Appends text to a file.
///
/// # Errors
/// When the file system refuses, with the path.
pub fn append(path: &Path, text: &str) -> anyhow::Result<()> {
    through(path, OpenOptions::new().create(true).append(true), &document(text))
}

fn through(path: &Path, options: &OpenOptions, text: &str) -> anyhow::Result<()> {
    let written = options.open(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| refused(path, &error))
}

fn refused(path: &Path, error: &dyn std::fmt::Display) -> anyhow::Error {
    Ended::with(Exit::CaseFailed, format!("cannot write {}: {error}", path.display()))
}

fn is_system_path(path: &Path) -> bool {
    path.starts_with("/dev") || path.starts_with("/proc")
}

/// Whether a variable of the environment is set, and not empty, `0`, `false`, `no` or `off`.
pub fn is_on(name: &str) -> bool {
    means_on(std::env::var_os(name))
}

fn means_on(value: Option<OsString>) -> bool {
    value.is_some_and(|value| {
        !["", "0", "false", "no", "off"].contains(&value.to_string_lossy().to_lowercase().as_str())
    })
}

/// The path in a variable of the environment, unless it is empty.
pub fn path_in(name: &str) -> Option<PathBuf> {
    std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_variable_is_on_unless_it_is_empty_or_says_off() {
        for (value, on) in
            [("true", true), ("1", true), ("yes", true), ("", false), ("0", false), ("False", false)]
        {
            assert_eq!(means_on(Some(value.into())), on, "`{value}`");
        }
        assert!(!means_on(None));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_its_file_is_replaced_as_a_whole() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "a longer text than the new one").expect("a file");
        for (link, target) in [("link", "file"), ("dangling", "new")] {
            std::os::unix::fs::symlink(at(target), at(link)).expect("a link");
            write_document(&at(link), "new text").expect("written");
            assert!(fs::symlink_metadata(at(link)).expect("it is there").is_symlink(), "{link}");
            assert_eq!(fs::read_to_string(at(target)).expect("a file"), "new text", "{link}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        write_document(Path::new("/dev/null"), "text").expect("written");
        let found = fs::metadata("/dev/null").expect("a device");
        assert!(found.file_type().is_char_device());
        let error = write_document(Path::new("/dev/full"), "text").expect_err("it is full");
        assert!(error.to_string().starts_with("cannot write /dev/full: No space left"), "{error}");
    }
}
