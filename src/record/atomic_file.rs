//! Files that are written completely or not at all, by renaming, and texts with a digest as their last field, which
//! reveals damage.

use crate::case::machine::host_name;
use serde::Serialize;
use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Letters of the host's name in a file's name.
const HOST_LETTERS: usize = 32;

/// Why a record could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file system said no.
    #[error("cannot {action} {path}: {source}")]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// Its answer.
        source: std::io::Error,
    },
    /// A record cannot be put into JSON.
    #[error("cannot write {path} as JSON: {source}")]
    Json {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
}

/// Where this process runs: host name, and a tag of its boot and its namespace of process numbers, within which a
/// number is one process. Shards in containers may share host name and process number both.
static PLACE: LazyLock<String> = LazyLock::new(|| {
    let host = host_name();
    let namespace = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    let tag = blake3::hash(format!("{host} {} {}", boot.trim(), namespace.display()).as_bytes()).to_hex();
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
    let host: String = host.chars().map(plain).take(HOST_LETTERS).collect();
    format!("{host}-{}", &tag[..8])
});

/// Writes a file under a temporary name and renames it, making its folders; it is on the disk then.
///
/// # Errors
/// When the file system refuses; nothing is left under the name then.
pub fn write_atomically(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    write_streamed(path, |file| file.write_all(content).and_then(|()| file.sync_all()))
}

/// Writes a file that can be made again from others, or whose loss is noticed: it takes its name whole, and the system
/// puts it on the disk in its own time.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_rebuildable(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    write_streamed(path, |file| file.write_all(content))
}

/// Writes a file under a temporary name as `fill` fills it, and renames it, making its folders.
///
/// # Errors
/// When the file system or `fill` refuses; nothing is left under the name then.
pub fn write_streamed(
    path: &Path,
    fill: impl FnOnce(&mut fs::File) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    let folder = folder_of(path);
    fs::create_dir_all(folder).map_err(|source| StoreError::Io {
        action: "create the folder",
        path: folder.to_owned(),
        source,
    })?;
    // A name that no other writer takes.
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = folder.join(format!(".{file}.{}.part", random_word()));
    let written = fs::File::create_new(&temporary).and_then(|mut file| fill(&mut file));
    written.and_then(|()| fs::rename(&temporary, path)).map_err(|source| {
        // What is half written is of no use to anyone.
        let _ = fs::remove_file(&temporary);
        StoreError::Io { action: "write", path: path.to_owned(), source }
    })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Host name and tag of where this process runs: two processes of one place see each other's locks.
pub fn place_of_this_process() -> &'static str {
    &PLACE
}

/// Sixteen hexadecimal digits, unique to this process and call.
pub fn random_word() -> String {
    format!("{:016x}", RandomState::new().build_hasher().finish())
}

/// What stands before the digest of an object.
const SEAL: &str = ",\"digest\":\"";
/// What stands behind it.
const END: &str = "\"}";
/// Hexadecimal digits of a digest.
const DIGEST_DIGITS: usize = 32;

/// The JSON of a value on one line, with the digest of it as the last field: made of the text and not of the value, so
/// that it is written and read once.
///
/// # Errors
/// When the value has no JSON.
pub fn sealed(value: &impl Serialize) -> serde_json::Result<String> {
    let content = serde_json::to_string(value)?;
    let content = content.strip_suffix('}').unwrap_or(&content);
    Ok(format!("{content}{SEAL}{}{END}", digest_of(content)))
}

/// Whether a text is as it was sealed.
pub fn is_whole(text: &str) -> bool {
    content_and_digest(text).is_some_and(|(content, digest)| digest_of(content) == digest)
}

/// What a text seals, and the digest that it has of it; none where it does not end as a seal does.
fn content_and_digest(text: &str) -> Option<(&str, &str)> {
    let text = text.strip_suffix(END)?;
    let (text, digest) = text.split_at_checked(text.len().checked_sub(DIGEST_DIGITS)?)?;
    Some((text.strip_suffix(SEAL)?, digest))
}

fn digest_of(content: &str) -> String {
    blake3::hash(content.as_bytes()).to_hex()[..DIGEST_DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_whole_as_it_was_sealed_and_no_longer_after_any_change() {
        let value = serde_json::json!({ "a": 1.5, "b": ["x", "y"] });
        let text = sealed(&value).expect("JSON");
        assert!(is_whole(&text), "{text}");
        let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(read["a"], value["a"]);
        for place in 0..text.len() {
            let mut damaged = text.clone().into_bytes();
            damaged[place] ^= 1;
            let damaged = String::from_utf8(damaged).expect("ASCII");
            assert!(!is_whole(&damaged), "byte {place} of {text}");
        }
        assert!(!is_whole("{}") && !is_whole(""));
    }

    #[test]
    fn a_file_is_there_whole_or_as_it_was_and_nothing_lies_beside_it() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let at = folder.path();
        let names = |folder: &Path| {
            let entries =
                fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("one").file_name());
            entries.map(|name| name.to_string_lossy().into_owned()).collect::<Vec<_>>()
        };
        let path = at.join("made/for/a.json");
        write_atomically(&path, b"first").expect("written");
        write_rebuildable(&path, b"second").expect("written");
        let half = write_streamed(&path, |file| {
            file.write_all(b"thi")?;
            Err(std::io::Error::other("no more"))
        });
        let told = half.expect_err("refused").to_string();
        assert_eq!(told, format!("cannot write {}: no more", path.display()));
        assert_eq!(fs::read_to_string(&path).expect("a file"), "second");
        assert_eq!(names(&at.join("made/for")), ["a.json"]);
        // A file in the place of its folder.
        let below = path.join("b.json");
        let told = write_atomically(&below, b"x").expect_err("refused").to_string();
        assert!(told.starts_with(&format!("cannot create the folder {}: ", path.display())), "{told}");
        assert_eq!(folder_of(Path::new("a.json")), Path::new("."));
        assert_eq!(folder_of(Path::new("b/a.json")), Path::new("b"));
        assert_ne!(random_word(), random_word());
        assert!(random_word().len() == 16 && random_word().bytes().all(|byte| byte.is_ascii_hexdigit()));
    }
}
