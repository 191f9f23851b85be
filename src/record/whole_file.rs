//! Files that are written completely or not at all, by renaming, and texts with a digest as their last field, which
//! reveals damage.

use regex_lite::Regex;
use serde::Serialize;
use std::collections::HashSet;
use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex};
use std::time::{Duration, SystemTime};

/// Ending of a file that is being written.
const PART: &str = ".part";
/// Age after which such a file is abandoned, whatever machine wrote it.
const STALE: Duration = Duration::from_secs(24 * 3600);
/// Letters of the host's name in a file's name.
const HOST_LETTERS: usize = 32;

/// Why a record could not be read or written.
#[derive(Debug, thiserror::Error)]
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
    let boot = line_of("/proc/sys/kernel/random/boot_id");
    let tag = blake3::hash(format!("{host} {boot} {}", namespace.display()).as_bytes()).to_hex();
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
    let host: String = host.chars().map(plain).take(HOST_LETTERS).collect();
    format!("{host}-{}", &tag[..8])
});

fn line_of(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_default().trim().to_owned()
}

/// Name of this machine.
pub fn host_name() -> String {
    let told = ["/proc/sys/kernel/hostname", "/etc/hostname"].map(line_of);
    let host = told.into_iter().find(|name| !name.is_empty());
    host.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_else(|| "host".to_owned())
}

/// Writes a file under a temporary name and renames it, making its folders; it is on the disk then.
///
/// # Errors
/// When the file system refuses; nothing is left under the name then.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    remove_stale_once(folder_of(path));
    write_streamed(path, |file| file.write_all(content).and_then(|()| file.sync_all()))
}

/// Writes a file that can be made again from others, or whose loss is noticed: it takes its name whole, and the system
/// puts it on the disk in its own time.
///
/// # Errors
/// As [`write_whole`].
pub fn write_rebuildable(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    remove_stale_once(folder_of(path));
    write_streamed(path, |file| file.write_all(content))
}

/// Clears a folder of what writers that have ended left there, once in a run: some folders have thousands of files.
fn remove_stale_once(folder: &Path) {
    static SEEN: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);
    if SEEN.lock().is_ok_and(|mut seen| seen.insert(folder.to_owned())) {
        remove_stale(folder);
    }
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
        action: "make the folder",
        path: folder.to_owned(),
        source,
    })?;
    let temporary = folder.join(part_name(&path.file_name().unwrap_or_default().to_string_lossy()));
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

/// A name that no other writer takes: of this host, this process, and random.
fn part_name(file: &str) -> String {
    format!(".{file}.{}.{}.{}{PART}", *PLACE, std::process::id(), random_word())
}

/// Removes from a folder what a process of this place that has ended left there, and what is older than a day, whoever
/// wrote it. Whatever cannot be read or removed stays.
fn remove_stale(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(|name| is_stale(name, || age_of(&entry))) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn age_of(entry: &fs::DirEntry) -> Option<Duration> {
    let modified = entry.metadata().and_then(|about| about.modified()).ok()?;
    SystemTime::now().duration_since(modified).ok()
}

/// Whether a file was left by a writer that has certainly ended.
fn is_stale(name: &str, age: impl Fn() -> Option<Duration>) -> bool {
    static NAME: LazyLock<Option<Regex>> =
        LazyLock::new(|| Regex::new(r"^\..+\.([^.]+)\.([0-9]+)\.[0-9a-fA-F]{16}\.part$").ok());
    let Some(parts) = NAME.as_ref().and_then(|pattern| pattern.captures(name)) else { return false };
    (parts[1] == **PLACE && has_ended(&parts[2])) || age().is_some_and(|age| age > STALE)
}

/// Whether a process of this place is known to be no more; never where processes cannot be looked up.
fn has_ended(process: &str) -> bool {
    let all = Path::new("/proc");
    all.join("self").exists() && !all.join(process).exists()
}

/// What stands before the digest where every field has a line of its own, and where all is one line.
const SEALS: [&str; 2] = [",\n  \"digest\": \"", ",\"digest\":\""];
/// What ends the object there.
const ENDS: [&str; 2] = ["\n}", "}"];
/// Hexadecimal digits of a digest.
const DIGEST_DIGITS: usize = 32;

/// How a record is laid out as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Every field on a line of its own, for a file of one record.
    Lines,
    /// All on one line, for a file of many.
    OneLine,
}

/// The JSON of a value with the digest of it as the last field: made of the text and not of the value, so that it
/// is written and read once.
///
/// # Errors
/// When the value has no JSON.
pub fn sealed(value: &impl Serialize, layout: Layout) -> serde_json::Result<String> {
    let content = match layout {
        Layout::Lines => serde_json::to_string_pretty(value)?,
        Layout::OneLine => serde_json::to_string(value)?,
    };
    let (seal, end) = (SEALS[layout as usize], ENDS[layout as usize]);
    let content = content.strip_suffix(end).unwrap_or(&content);
    Ok(format!("{content}{seal}{}\"{end}", digest_of(content)))
}

/// Whether a text is as it was sealed, in either layout.
pub fn is_whole(text: &str) -> bool {
    SEALS.iter().zip(ENDS).any(|(seal, end)| sealed_by(text, seal, end).is_some_and(is_digest_of))
}

/// What a text seals, and the digest that it has of it; none where it does not end as a seal does.
fn sealed_by<'a>(text: &'a str, seal: &str, end: &str) -> Option<(&'a str, &'a str)> {
    let text = text.strip_suffix(end)?.strip_suffix('"')?;
    let (text, digest) = text.split_at_checked(text.len().checked_sub(DIGEST_DIGITS)?)?;
    Some((text.strip_suffix(seal)?, digest))
}

fn is_digest_of((content, digest): (&str, &str)) -> bool {
    digest_of(content) == digest
}

fn digest_of(content: &str) -> String {
    blake3::hash(content.as_bytes()).to_hex()[..DIGEST_DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY: Option<Duration> = Some(Duration::from_secs(24 * 3600 + 1));
    const NOW: Option<Duration> = Some(Duration::ZERO);
    /// Beyond what any kernel counts to.
    const NO_PROCESS: u32 = 4_194_305;

    #[test]
    fn two_writers_of_one_file_never_share_a_name() {
        let (one, other) = (part_name("record.json"), part_name("record.json"));
        assert_ne!(one, other);
        let of_process = format!(".{}.{}.", *PLACE, std::process::id());
        assert!(
            one.starts_with(".record.json.") && one.contains(&of_process) && one.ends_with(PART),
            "{one}"
        );
        assert!(one.len() < 200, "{one}");
    }

    #[test]
    fn what_a_living_or_foreign_process_writes_stays() {
        let named = |place: &str, process: u32| format!(".a.csv.{place}.{process}.0123456789abcdef.part");
        let own = std::process::id();
        assert!(!is_stale(&part_name("a.csv"), || NOW), "its writer is at it");
        assert!(
            !is_stale(&named("elsewhere-00000000", NO_PROCESS), || NOW),
            "nobody knows that it has ended"
        );
        assert!(is_stale(&named("elsewhere-00000000", own), || DAY), "a day is enough for any file");
        #[cfg(target_os = "linux")]
        assert!(is_stale(&named(&PLACE, NO_PROCESS), || NOW), "its writer has ended");
        for others in ["a.csv", ".a.csv.part", ".a.b.c.d.part", "record.json", ".x.host.12.zz.part"] {
            assert!(!is_stale(others, || DAY), "{others} is none of ours");
        }
    }

    #[test]
    fn a_write_clears_what_dead_writers_left_and_nothing_else() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let file = |name: &str| folder.path().join(name);
        let dead = file(&format!(".a.csv.{}.{NO_PROCESS}.0123456789abcdef.part", *PLACE));
        let foreign = file(".a.csv.elsewhere-00000000.7.0123456789abcdef.part");
        let old = file(".b.json.elsewhere-00000000.7.fedcba9876543210.part");
        for path in [&dead, &foreign, &old] {
            fs::write(path, "half").expect("written");
        }
        let two_days_ago = SystemTime::now() - 2 * STALE;
        let opened = fs::File::options().write(true).open(&old).expect("opened");
        opened.set_modified(two_days_ago).expect("aged");
        write_whole(&file("a.csv"), b"whole").expect("written");
        assert_eq!(fs::read(file("a.csv")).expect("the file"), b"whole");
        assert_eq!(dead.exists(), !cfg!(target_os = "linux"));
        assert!(foreign.exists() && !old.exists());
    }

    #[test]
    fn a_text_is_whole_in_both_layouts_and_no_longer_after_any_change() {
        let value = serde_json::json!({ "a": 1.5, "b": ["x", "y"] });
        for layout in [Layout::Lines, Layout::OneLine] {
            let text = sealed(&value, layout).expect("JSON");
            assert!(is_whole(&text), "{text}");
            let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(read["a"], value["a"]);
            for place in 0..text.len() {
                let mut damaged = text.clone().into_bytes();
                damaged[place] ^= 1;
                let damaged = String::from_utf8(damaged).expect("ASCII");
                assert!(!is_whole(&damaged), "byte {place} of {text}");
            }
        }
        assert!(!is_whole("{}") && !is_whole(""));
    }
}
