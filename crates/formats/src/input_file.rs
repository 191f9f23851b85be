//! Opens files that a user or another file names: regular files only, up to the size of any result.
//!
//! A device or a pipe may never end, and a file that refers to other files may refer to one of these. What gzip packed is
//! unpacked, and text in UTF-16 or behind a byte order mark becomes plain UTF-8, before any reader sees it.

use flate2::read::MultiGzDecoder;
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

/// Largest file that is read, bytes.
pub const LARGEST: u64 = 8 << 30;
/// Largest text file that is read, bytes: a study of a million cases takes less.
pub const LARGEST_TEXT: u64 = 16_000_000;
/// Bytes that a packed file may become: this many in any case, and more per byte of the file.
const UNPACKED: (u64, u64) = (16 << 20, 200);
/// First bytes of gzip.
const GZIP: &[u8] = &[0x1f, 0x8b, 8];

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

/// The first bytes of a file, as [`read`] gives them.
///
/// # Errors
/// Those of [`open`], and when it cannot be read.
pub fn head(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.take(most as u64).read_to_end(&mut bytes)?;
    if bytes.starts_with(GZIP) {
        let mut unpacked = Vec::new();
        MultiGzDecoder::new(open(path)?)
            .take(most as u64)
            .read_to_end(&mut unpacked)
            .map_err(|error| damaged(&error))?;
        bytes = unpacked;
    }
    // A cut inside a pair is no damage here.
    let even = if wide(&bytes).is_some() { bytes.len() / 2 * 2 } else { bytes.len() };
    bytes.truncate(even);
    Ok(plain(bytes))
}

fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let about = file.metadata()?;
    check(&about, most)?;
    let mut bytes = Vec::with_capacity(usize::try_from(about.len()).unwrap_or(0));
    // A file may grow while it is read.
    file.take(most).read_to_end(&mut bytes)?;
    if bytes.starts_with(GZIP) {
        bytes = unpacked(&bytes, most)?;
    }
    Ok(plain(bytes))
}

/// The content of a file that gzip packed. Each member ends with a checksum, which is compared.
fn unpacked(packed: &[u8], most: u64) -> io::Result<Vec<u8>> {
    let (any, per_byte) = UNPACKED;
    let most = most.min(any + per_byte * packed.len() as u64);
    let mut bytes = Vec::new();
    MultiGzDecoder::new(packed).take(most + 1).read_to_end(&mut bytes).map_err(|error| damaged(&error))?;
    if bytes.len() as u64 > most {
        return Err(refused(format!("it decompresses to more than {most} bytes: decompress it first")));
    }
    Ok(bytes)
}

fn damaged(error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("its gzip is damaged or cut: {error}"))
}

/// Bytes at the start of a file that show UTF-16 without a mark: every other one is 0.
const LOOK: usize = 16;

/// How two bytes make a number.
type FromBytes = fn([u8; 2]) -> u16;

/// The order of the bytes of text in UTF-16, and how long its mark is.
fn wide(bytes: &[u8]) -> Option<(FromBytes, usize)> {
    match bytes {
        [0xff, 0xfe, ..] => return Some((u16::from_le_bytes, 2)),
        [0xfe, 0xff, ..] => return Some((u16::from_be_bytes, 2)),
        _ => {}
    }
    let (pairs, _) = bytes.get(..LOOK)?.as_chunks();
    let is_letter = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    let all =
        |is_it: fn(&[u8; 2], &dyn Fn(u8) -> bool) -> bool| pairs.iter().all(|pair| is_it(pair, &is_letter));
    if all(|[first, second], is_letter| is_letter(*first) && *second == 0) {
        return Some((u16::from_le_bytes, 0));
    }
    all(|[first, second], is_letter| *first == 0 && is_letter(*second)).then_some((u16::from_be_bytes, 0))
}

/// Bytes without a byte order mark; text in UTF-16 as UTF-8. Text that is not UTF-16 behind its mark stays as it is.
fn plain(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.starts_with(&[0xef, 0xbb, 0xbf]) {
        bytes.drain(..3);
        return bytes;
    }
    let Some((from_bytes, mark)) = wide(&bytes) else { return bytes };
    let (pairs, rest) = bytes[mark..].as_chunks();
    let text: Option<String> =
        char::decode_utf16(pairs.iter().map(|pair| from_bytes(*pair))).map(Result::ok).collect();
    match text.filter(|_| rest.is_empty()) {
        Some(text) => text.into_bytes(),
        None => bytes,
    }
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
        std::fs::write(at("bytes"), [0xff, 0xfe, 0x61]).expect("a file");
        assert!(read_text(&at("bytes")).is_err_and(|error| error.to_string().contains("UTF-8")));
    }

    #[test]
    fn packed_text_and_every_byte_order_mark_are_the_same_text() {
        use std::io::Write;
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.csv");
        let text = "t,y,p\n1,2,3 µ\n";
        let wide = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
            std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(order).collect()
        };
        let pack = |bytes: &[u8]| {
            let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
            packer.write_all(bytes).expect("memory");
            packer.finish().expect("memory")
        };
        let marked = ["\u{feff}".as_bytes(), text.as_bytes()].concat();
        let packed = pack(text.as_bytes());
        for bytes in [
            text.as_bytes().to_vec(),
            marked.clone(),
            wide(u16::to_le_bytes),
            wide(u16::to_be_bytes),
            wide(u16::to_le_bytes)[2..].to_vec(),
            wide(u16::to_be_bytes)[2..].to_vec(),
            packed.clone(),
            [pack(&text.as_bytes()[..4]), pack(&text.as_bytes()[4..])].concat(),
            pack(&wide(u16::to_le_bytes)),
        ] {
            std::fs::write(&path, &bytes).expect("a file");
            assert_eq!(read(&path).expect("text"), text.as_bytes());
            assert_eq!(read_text(&path).expect("text"), text);
            assert_eq!(head(&path, 4096).expect("text"), text.as_bytes());
        }
        // Each cut and each changed byte of what is packed is told, but in the head, which says nothing of the text.
        for cut in 3..packed.len() {
            std::fs::write(&path, &packed[..cut]).expect("a file");
            assert!(read(&path).is_err_and(|error| error.to_string().contains("gzip")), "{cut}");
        }
        for at in 10..packed.len() {
            let mut bytes = packed.clone();
            bytes[at] ^= 0x20;
            std::fs::write(&path, &bytes).expect("a file");
            // A bit behind the last code stands for nothing.
            let found = read(&path);
            assert!(found.is_err() || found.is_ok_and(|bytes| bytes == text.as_bytes()), "{at}");
        }
        let bomb = pack(&vec![0; 100 << 20]);
        std::fs::write(&path, &bomb).expect("a file");
        assert!(read(&path).is_err_and(|error| error.to_string().contains("decompress it first")));
    }
}
