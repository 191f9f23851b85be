//! The tables of a study as files: the tidy one, those beside it, plain or compressed by gzip, which pandas and
//! others read as they are.

pub mod long_tables;
pub mod tidy;

use crate::record::atomic_file::{StoreError, write_streamed};
use flate2::Compression;
use flate2::write::GzEncoder;
use rayon::prelude::*;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Rows as lines of CSV.
fn lines_of<F: AsRef<[u8]>>(
    rows: impl IntoIterator<Item = impl IntoIterator<Item = F>>,
) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Things whose rows are made and compressed together: a gzip member.
const TOGETHER: usize = 16;
/// Members that are in memory at the same time.
const IN_MEMORY: usize = 64;

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

    /// A part of the file. Equal text gives equal bytes: a member's header has no time and no name.
    fn part(self, text: String) -> io::Result<Vec<u8>> {
        match self {
            Self::Plain => Ok(text.into_bytes()),
            Self::Compressed => {
                let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
                encoder.write_all(text.as_bytes())?;
                encoder.finish()
            }
        }
    }

    /// Writes a table of a header line and the rows of things, made on all cores and in the order of the things; it is
    /// on the disk at the end. Removes the file of the other form, so that an old table is not read by mistake.
    ///
    /// # Errors
    /// When the file system or `rows` refuses.
    pub fn write<T: Sync>(
        self,
        folder: &Path,
        name: &str,
        header: String,
        things: &[T],
        rows: impl Fn(&T) -> io::Result<String> + Sync,
    ) -> Result<PathBuf, StoreError> {
        let path = self.path(folder, name);
        let part_of = |things: &[T]| self.part(things.iter().map(&rows).collect::<io::Result<String>>()?);
        write_streamed(&path, |file| {
            file.write_all(&self.part(header)?)?;
            for batch in things.chunks(TOGETHER * IN_MEMORY) {
                let parts: Vec<io::Result<Vec<u8>>> = batch.par_chunks(TOGETHER).map(part_of).collect();
                for part in parts {
                    file.write_all(&part?)?;
                }
            }
            file.sync_all()
        })?;
        for other in Self::ALL.into_iter().filter(|other| *other != self) {
            let old = other.path(folder, name);
            if old.exists() {
                fs::remove_file(&old).map_err(|source| StoreError::Io {
                    action: "remove the older",
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
    use flate2::read::MultiGzDecoder;
    use std::io::Read;

    #[test]
    fn a_compressed_table_reads_back_and_no_other_form_is_left() {
        let folder = tempfile::TempDir::new().expect("a folder");
        // More than are in memory at the same time.
        let things: Vec<usize> = (0..=TOGETHER * (IN_MEMORY + 1)).collect();
        let row = |thing: &usize| format!("case {thing},1\n");
        let text = "case,value\n".to_owned() + &things.iter().map(row).collect::<String>();
        let written = |form: TableForm| {
            let header = "case,value\n".to_owned();
            form.write(folder.path(), "t", header, &things, |thing| Ok(row(thing))).expect("written")
        };
        let plain = written(TableForm::Plain);
        assert_eq!(fs::read_to_string(&plain).expect("a file"), text);
        let packed = written(TableForm::Compressed);
        assert!(!plain.exists() && packed.ends_with("t.csv.gz"));
        let bytes = fs::read(&packed).expect("a file");
        assert!(bytes.len() < text.len() / 2, "{} bytes", bytes.len());
        let mut back = String::new();
        MultiGzDecoder::new(bytes.as_slice()).read_to_string(&mut back).expect("gzip");
        assert_eq!(back, text);
        written(TableForm::Plain);
        assert!(plain.exists() && !packed.exists());
    }

    #[test]
    fn rows_that_cannot_be_made_leave_the_older_table() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let write = |rows: fn(&usize) -> io::Result<String>| {
            TableForm::Plain.write(folder.path(), "t", "a\n".to_owned(), &[1], rows)
        };
        let path = write(|_| Ok("1\n".to_owned())).expect("written");
        assert!(write(|_| Err(io::Error::other("no"))).is_err());
        assert_eq!(fs::read_to_string(path).expect("a file"), "a\n1\n");
    }
}
