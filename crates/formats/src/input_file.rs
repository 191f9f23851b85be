//! Opens files that a user or another file names: regular files only, up to the size of any result.
//!
//! A device or a pipe may never end, and a file that refers to other files may refer to one of these.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

/// Largest file that is read, bytes.
pub const LARGEST: u64 = 8 << 30;
/// Largest text file that is read, bytes: a study of a million cases takes less.
pub const LARGEST_TEXT: u64 = 16_000_000;

/// Opens a file.
///
/// # Errors
/// When it is missing, not a regular file, or too large.
pub fn open(path: &Path) -> io::Result<File> {
    // Checked before it is opened, because opening a pipe waits for its writer; and again after, if it was replaced.
    check(&std::fs::metadata(path)?, LARGEST)?;
    let file = File::open(path)?;
    check(&file.metadata()?, LARGEST)?;
    Ok(file)
}

/// The bytes of a file.
///
/// # Errors
/// Those of [`open`], and when it cannot be read.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, LARGEST)
}

/// The text of a small file.
///
/// # Errors
/// Those of [`read`], and when it is not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_at_most(path, LARGEST_TEXT)?).map_err(|_| refused("it is not UTF-8".to_owned()))
}

fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let about = file.metadata()?;
    check(&about, most)?;
    let mut bytes = Vec::with_capacity(usize::try_from(about.len()).unwrap_or(0));
    // A file may grow while it is read.
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn check(about: &Metadata, most: u64) -> io::Result<()> {
    if about.is_dir() {
        return Err(refused("it is a folder".to_owned()));
    }
    if !about.is_file() {
        return Err(refused("it is not a regular file: a device or a pipe may never end".to_owned()));
    }
    if about.len() > most {
        return Err(refused(format!("it has {} bytes, and at most {most} are read", about.len())));
    }
    Ok(())
}

fn refused(why: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn devices_pipes_folders_and_files_larger_than_any_result_are_refused_before_they_are_read() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let pipe = at("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
        assert!(made.success());
        std::os::unix::fs::symlink(&pipe, at("link")).expect("a link");
        let large = File::create(at("large")).expect("a file");
        large.set_len(LARGEST + 1).expect("a file of holes");
        for (path, told) in [
            (Path::new("/dev/zero").to_owned(), "a device or a pipe"),
            (pipe, "a device or a pipe"),
            (at("link"), "a device or a pipe"),
            (folder.path().to_owned(), "a folder"),
            (at("large"), "at most 8589934592"),
            (at("nowhere"), "No such file"),
        ] {
            for refused in [open(&path).map(|_| ()), read(&path).map(|_| ()), read_text(&path).map(|_| ())] {
                assert!(refused.is_err_and(|error| error.to_string().contains(told)), "{}", path.display());
            }
        }
        large.set_len(LARGEST_TEXT + 1).expect("a smaller one");
        assert!(read_text(&at("large")).is_err_and(|error| error.to_string().contains("at most 16000000")));
        std::fs::write(at("text"), "a").expect("a file");
        assert_eq!(read_text(&at("text")).expect("a text"), "a");
        std::fs::write(at("bytes"), [0xff, 0xfe]).expect("a file");
        assert!(read_text(&at("bytes")).is_err_and(|error| error.to_string().contains("UTF-8")));
    }
}
