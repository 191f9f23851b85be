//! Files that are written whole or not at all: under a name of their own first, then renamed.

use std::collections::HashSet;
use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex};
use std::time::{Duration, SystemTime};

/// Ending of a file that is being written.
const PART: &str = ".part";
/// Age after which such a file is nobody's, whatever machine wrote it.
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
    write_renamed(path, content, fs::File::sync_all)
}

/// The same of a file that can be made again from others: it takes its name whole, and the system puts it on the disk
/// in its own time.
///
/// # Errors
/// As [`write_whole`].
pub fn write_rebuildable(path: &Path, content: &[u8]) -> Result<(), StoreError> {
    remove_stale_once(folder_of(path));
    write_renamed(path, content, |_| Ok(()))
}

/// Clears a folder of what writers that are no more left, once in a run: some folders have thousands of files.
fn remove_stale_once(folder: &Path) {
    static SEEN: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);
    if SEEN.lock().is_ok_and(|mut seen| seen.insert(folder.to_owned())) {
        remove_stale(folder);
    }
}

/// The same, with what is done to the file before it takes its name.
///
/// # Errors
/// [`StoreError`] where a file cannot be written, finished or renamed.
pub fn write_renamed(
    path: &Path,
    content: &[u8],
    finish: impl Fn(&fs::File) -> std::io::Result<()>,
) -> Result<(), StoreError> {
    write_streamed(path, |file| {
        file.write_all(content)?;
        finish(file)
    })
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

/// Sixteen hexadecimal digits that nobody else has.
pub fn random_word() -> String {
    format!("{:016x}", RandomState::new().build_hasher().finish())
}

/// A file to write and to read for as long as this process runs, under a name that nobody else takes and that is
/// stale when it has ended.
///
/// # Errors
/// When the file system refuses.
pub fn create_part(folder: &Path, name: &str) -> std::io::Result<(PathBuf, fs::File)> {
    let path = folder.join(part_name(name));
    let file = fs::File::options().read(true).write(true).create_new(true).open(&path)?;
    Ok((path, file))
}

/// A name that no other writer takes: of this host, this process, and random.
fn part_name(file: &str) -> String {
    format!(".{file}.{}.{}.{}{PART}", *PLACE, std::process::id(), random_word())
}

/// Removes what writers that are no more left in a folder: a process of this place that has ended, or anyone's
/// after a day. Whatever cannot be read or removed stays.
pub fn remove_stale(folder: &Path) {
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

/// Whether a file is of a writer that is clearly no more.
fn is_stale(name: &str, age: impl Fn() -> Option<Duration>) -> bool {
    let Some(inner) = name.strip_prefix('.').and_then(|name| name.strip_suffix(PART)) else { return false };
    let mut parts = inner.rsplitn(4, '.');
    let (Some(random), Some(process), Some(place), Some(_)) =
        (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return false;
    };
    let is_random = random.len() == 16 && random.chars().all(|digit| digit.is_ascii_hexdigit());
    if !is_random || process.is_empty() || !process.chars().all(|digit| digit.is_ascii_digit()) {
        return false;
    }
    (place == *PLACE && has_ended(process)) || age().is_some_and(|age| age > STALE)
}

/// Whether a process of this place is known to be no more; never where processes cannot be looked up.
fn has_ended(process: &str) -> bool {
    let all = Path::new("/proc");
    all.join("self").exists() && !all.join(process).exists()
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
}
