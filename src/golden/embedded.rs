//! The golden values of the shipped studies inside the program, so that an installed one can check itself.

use crate::golden::{GoldenError, GoldenFile};
use std::io::Read;
use std::path::Path;

/// Names, lengths and texts of the golden files in one compressed stream, packed by `build.rs`.
const PACKED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/golden.z"));

/// The text of a study's golden file, where the program has it.
fn text_of(study: &str) -> Option<String> {
    let mut whole = Vec::new();
    flate2::read::ZlibDecoder::new(PACKED).read_to_end(&mut whole).ok()?;
    let mut rest = whole.as_slice();
    while let Some(end) = rest.iter().position(|byte| *byte == b'\n') {
        let (name, length) = std::str::from_utf8(&rest[..end]).ok()?.split_once(' ')?;
        let (text, after) = rest[end + 1..].split_at_checked(length.parse().ok()?)?;
        if name == study {
            return String::from_utf8(text.to_vec()).ok();
        }
        rest = after;
    }
    None
}

impl GoldenFile {
    /// Reads a shipped study's golden file from a folder, or takes the one inside the program where the folder has
    /// none.
    ///
    /// # Errors
    /// As [`GoldenFile::read`].
    pub fn read_or_embedded(folder: &Path, study: &str) -> Result<Self, GoldenError> {
        match Self::read(folder, study) {
            Err(GoldenError::Missing(path)) => match text_of(study) {
                Some(text) => Self::from_text(&text).map_err(|reason| {
                    GoldenError::refused(&path, "inside the program cannot be read", reason)
                }),
                None => Err(GoldenError::Missing(path)),
            },
            found => found,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_has_the_golden_values_of_the_repository_to_the_bit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
        let nowhere = Path::new("nowhere");
        for study in ["terzaghi-mesh", "work-precision", "column-in-the-plane", "references"] {
            let own = GoldenFile::read_or_embedded(nowhere, study).expect("inside the program");
            assert_eq!(own, GoldenFile::read(&root, study).expect("in the repository"), "{study}");
        }
        let missing = GoldenFile::read_or_embedded(nowhere, "no-such-study");
        assert!(matches!(missing, Err(GoldenError::Missing(_))));
    }
}
