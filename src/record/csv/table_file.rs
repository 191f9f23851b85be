//! A table of a study as a file: plain, or compressed by gzip, which pandas and others read as it is.

use crate::record::whole_file::{StoreError, write_streamed};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::{BufWriter, Write};
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

    /// Writes a table of a header and of rows as `fill` makes them, on the disk at the end, and takes away what
    /// another form left there: nobody reads an old one for it.
    ///
    /// # Errors
    /// When the file system or `fill` refuses.
    pub fn write(
        self,
        folder: &Path,
        name: &str,
        header: &str,
        fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> Result<PathBuf, StoreError> {
        let path = self.path(folder, name);
        write_streamed(&path, |file| {
            let mut out = BufWriter::with_capacity(1 << 16, &mut *file);
            match self {
                Self::Plain => {
                    out.write_all(header.as_bytes())?;
                    fill(&mut out)?;
                }
                // The same bytes for the same rows: no time and no name stand in the head.
                Self::Compressed => {
                    let mut encoder = GzEncoder::new(&mut out, Compression::default());
                    encoder.write_all(header.as_bytes())?;
                    fill(&mut encoder)?;
                    encoder.finish()?;
                }
            }
            out.flush()?;
            drop(out);
            file.sync_all()
        })?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;

    #[test]
    fn a_compressed_table_reads_back_and_no_other_form_is_left() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let (header, rows) = ("case,value\n", "a,1\n".repeat(1000));
        let text = header.to_owned() + &rows;
        let written = |form: TableForm| {
            form.write(folder.path(), "t", header, |out| out.write_all(rows.as_bytes())).expect("written")
        };
        let plain = written(TableForm::Plain);
        let packed = written(TableForm::Compressed);
        assert!(!plain.exists() && packed.ends_with("t.csv.gz"));
        let bytes = fs::read(&packed).expect("a file");
        assert!(bytes.len() < text.len() / 10, "{} bytes", bytes.len());
        let mut back = String::new();
        GzDecoder::new(bytes.as_slice()).read_to_string(&mut back).expect("gzip");
        assert_eq!(back, text);
        written(TableForm::Plain);
        assert!(plain.exists() && !packed.exists());
    }
}
