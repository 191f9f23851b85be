//! A table of a study as a file: plain, or compressed by gzip, which pandas and others read as it is.

use crate::record::whole_file::{StoreError, write_whole};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a table is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableForm {
    /// `NAME.csv`.
    Plain,
    /// `NAME.csv.gz`: a tenth of it.
    Compressed,
}

impl TableForm {
    /// Both forms.
    const ALL: [Self; 2] = [Self::Plain, Self::Compressed];

    fn path(self, folder: &Path, name: &str) -> PathBuf {
        folder.join(match self {
            Self::Plain => format!("{name}.csv"),
            Self::Compressed => format!("{name}.csv.gz"),
        })
    }

    /// Writes a table under its name and takes away what another form left there: nobody reads an old one for it.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(self, folder: &Path, name: &str, text: &str) -> Result<PathBuf, StoreError> {
        let path = self.path(folder, name);
        match self {
            Self::Plain => write_whole(&path, text.as_bytes())?,
            Self::Compressed => write_whole(&path, &compressed(&path, text)?)?,
        }
        for other in Self::ALL.into_iter().filter(|other| *other != self) {
            let old = other.path(folder, name);
            if old.exists() {
                fs::remove_file(&old).map_err(|source| StoreError::Io {
                    action: "take away the older",
                    path: old.clone(),
                    source,
                })?;
            }
        }
        Ok(path)
    }
}

/// The same bytes for the same text: no time and no name stand in the head.
fn compressed(path: &Path, text: &str) -> Result<Vec<u8>, StoreError> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    let refused = |source| StoreError::Io { action: "compress", path: path.to_owned(), source };
    encoder.write_all(text.as_bytes()).map_err(refused)?;
    encoder.finish().map_err(refused)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;

    #[test]
    fn a_compressed_table_reads_back_and_no_other_form_is_left() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let text = "case,value\n".to_owned() + &"a,1\n".repeat(1000);
        let plain = TableForm::Plain.write(folder.path(), "t", &text).expect("written");
        let packed = TableForm::Compressed.write(folder.path(), "t", &text).expect("written");
        assert!(!plain.exists() && packed.ends_with("t.csv.gz"));
        let bytes = fs::read(&packed).expect("a file");
        assert!(bytes.len() < text.len() / 10, "{} bytes", bytes.len());
        let mut back = String::new();
        GzDecoder::new(bytes.as_slice()).read_to_string(&mut back).expect("gzip");
        assert_eq!(back, text);
        TableForm::Plain.write(folder.path(), "t", &text).expect("written");
        assert!(plain.exists() && !packed.exists());
    }
}
