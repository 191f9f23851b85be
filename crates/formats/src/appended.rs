//! What is appended to VTK's XML files behind an underscore: base64, or raw bytes, which stay on disk until an array of
//! them is asked for.

use crate::input_file;
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// What begins the appended data.
const MARK: &[u8] = b"<AppendedData";
/// Bytes of a file that are looked through at once for it.
const LOOK: u64 = 1 << 20;

/// Appended data.
#[derive(Clone, Copy, Debug)]
pub enum Appended<'a> {
    /// In base64.
    Base64(&'a [u8]),
    /// Raw.
    Raw(Raw<'a>),
}

/// Raw bytes.
#[derive(Clone, Copy, Debug)]
pub enum Raw<'a> {
    /// In memory.
    Bytes(&'a [u8]),
    /// In a file, from a byte of it on.
    File(&'a File, u64, usize),
}

impl<'a> Raw<'a> {
    /// How many there are.
    pub fn count(self) -> usize {
        match self {
            Self::Bytes(bytes) => bytes.len(),
            Self::File(_, _, length) => length,
        }
    }

    /// So many bytes from one on.
    ///
    /// # Errors
    /// When there are fewer, or the file cannot be read.
    pub fn part(self, from: usize, length: usize) -> Result<Cow<'a, [u8]>, String> {
        let Some(end) = from.checked_add(length).filter(|end| *end <= self.count()) else {
            let there = self.count().saturating_sub(from);
            return Err(format!("{length} bytes are declared and {there} are there: the file is cut"));
        };
        match self {
            Self::Bytes(bytes) => Ok(bytes[from..end].into()),
            Self::File(mut file, start, _) => {
                let mut part = vec![0; length];
                let read =
                    file.seek(SeekFrom::Start(start + from as u64)).and_then(|_| file.read_exact(&mut part));
                read.map_err(|error| format!("it cannot be read at its byte {from}: {error}"))?;
                Ok(part.into())
            }
        }
    }
}

/// Where a text ends, where its appended data begin, and whether these are raw.
struct Parting {
    end: usize,
    data: usize,
    is_raw: bool,
}

/// Parts a file at its appended data, which are no XML; none where it has none.
fn parting(bytes: &[u8]) -> Result<Option<Parting>, String> {
    let Some(end) = bytes.windows(MARK.len()).position(|window| window == MARK) else { return Ok(None) };
    let rest = &bytes[end..];
    let cut = || "its appended data are cut off".to_owned();
    let tag = rest.iter().position(|symbol| *symbol == b'>').ok_or_else(cut)?;
    let is_raw = rest[..tag].windows(3).any(|window| window == b"raw");
    let underscore = rest[tag..].iter().position(|symbol| *symbol == b'_').ok_or_else(cut)?;
    Ok(Some(Parting { end, data: end + tag + underscore + 1, is_raw }))
}

/// The XML of a file in memory, and what is appended to it.
///
/// # Errors
/// When the appended data are cut off before they begin.
pub fn parted(bytes: &[u8]) -> Result<(&[u8], Option<Appended<'_>>), String> {
    let Some(Parting { end, data, is_raw }) = parting(bytes)? else { return Ok((bytes, None)) };
    let data = &bytes[data..];
    let appended = if is_raw { Appended::Raw(Raw::Bytes(data)) } else { Appended::Base64(data) };
    Ok((&bytes[..end], Some(appended)))
}

/// A file with all of it in memory but raw appended data.
pub struct Opened {
    file: File,
    bytes: Vec<u8>,
    /// Where its raw data begin.
    raw: Option<u64>,
    length: u64,
}

impl Opened {
    /// Opens a file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = input_file::open(path)?;
        let length = file.metadata()?.len();
        let mut bytes = Vec::new();
        let mut seen = 0;
        while file.by_ref().take(LOOK).read_to_end(&mut bytes)? > 0 {
            // A mark, and what follows it, may lie across the end of what was read before.
            let found = parting(&bytes[seen..]);
            if let Ok(Some(Parting { end, data, is_raw })) = found {
                if is_raw {
                    bytes.truncate(seen + end);
                    return Ok(Self { file, bytes, raw: Some((seen + data) as u64), length });
                }
                bytes.reserve_exact(usize::try_from(length).unwrap_or(0).saturating_sub(bytes.len()));
                file.read_to_end(&mut bytes)?;
                break;
            }
            if found.is_ok() {
                seen = bytes.len().saturating_sub(MARK.len());
            }
        }
        Ok(Self { file, bytes, raw: None, length })
    }

    /// Bytes of the whole file.
    pub fn size(&self) -> usize {
        usize::try_from(self.length).unwrap_or(usize::MAX)
    }

    /// Its XML, and what is appended to it.
    ///
    /// # Errors
    /// When the appended data are cut off before they begin.
    pub fn parted(&self) -> Result<(&[u8], Option<Appended<'_>>), String> {
        let Some(start) = self.raw else { return parted(&self.bytes) };
        let length = usize::try_from(self.length.saturating_sub(start)).unwrap_or(usize::MAX);
        Ok((&self.bytes, Some(Appended::Raw(Raw::File(&self.file, start, length)))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_parted_where_it_is_in_memory_and_raw_data_stay_on_disk() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("a.vtu");
        for (way, head) in [("raw", 10), ("raw", (1 << 20) - 5), ("base64", 10), ("none", 10)] {
            let mut bytes = vec![b' '; head];
            bytes.extend(b"<X/>");
            if way != "none" {
                bytes.extend(format!("<AppendedData encoding=\"{way}\">\n _").bytes());
            }
            bytes.extend(0..200_u8);
            std::fs::write(&path, &bytes).expect("a file");
            let opened = Opened::open(&path).expect("a file");
            let (text, appended) = opened.parted().expect("parted");
            let (text_in_memory, in_memory) = parted(&bytes).expect("parted");
            assert_eq!((text, opened.size()), (text_in_memory, bytes.len()), "{way}");
            match (appended, in_memory) {
                (Some(Appended::Raw(on_disk)), Some(Appended::Raw(in_memory))) => {
                    assert!(matches!(on_disk, Raw::File(..)), "they stay there");
                    assert_eq!(on_disk.count(), 200);
                    assert_eq!(on_disk.part(7, 50), in_memory.part(7, 50));
                    assert_eq!(on_disk.part(7, 50).expect("there")[0], 7);
                    for (from, length) in [(150, 51), (201, 0), (0, usize::MAX), (usize::MAX, 1)] {
                        assert_eq!(on_disk.part(from, length), in_memory.part(from, length));
                        assert!(on_disk.part(from, length).is_err_and(|why| why.contains("cut")));
                    }
                }
                (Some(Appended::Base64(one)), Some(Appended::Base64(other))) => assert_eq!(one, other),
                (None, None) => assert_eq!(way, "none"),
                other => panic!("{way}: {other:?}"),
            }
        }
    }
}
