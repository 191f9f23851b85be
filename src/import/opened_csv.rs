//! A table of somebody else's, opened: its header, and what is told of it by its name.

use crate::import::mapping::TableLayout;
use oedometer_formats::bytes::short;
use oedometer_formats::import_error::ImportError;
use oedometer_formats::input_file;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Names of columns that a message lists.
const MOST_NAMES: usize = 30;

/// An open table.
pub struct CsvTable<'a> {
    /// Its file.
    pub path: &'a Path,
    /// Names of its columns.
    pub header: csv::StringRecord,
    reader: csv::Reader<File>,
}

impl<'a> CsvTable<'a> {
    /// Opens a file by the layout that its mapping declares.
    ///
    /// # Errors
    /// When it cannot be read, or has no header.
    pub fn open(path: &'a Path, layout: &TableLayout) -> Result<Self, ImportError> {
        let io = |source| ImportError::Io { path: path.to_owned(), source };
        let file = input_file::open(path).map_err(io)?;
        let as_byte = |mark: char| u8::try_from(mark).unwrap_or(b',');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(as_byte(layout.delimiter))
            .comment(layout.comment.map(as_byte))
            .trim(csv::Trim::All)
            .from_reader(file);
        let header = reader.headers();
        let header = header.map_err(|source| ImportError::Csv { path: path.to_owned(), source })?.clone();
        Ok(Self { path, header, reader })
    }

    /// The place of a column.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// All columns, as a message lists them.
    pub fn names(&self) -> String {
        let names = self.header.iter().take(MOST_NAMES).map(|column| format!("`{}`", short(column)));
        let more = self.header.len().saturating_sub(MOST_NAMES);
        let more = (more > 0).then(|| format!("and {more} more"));
        names.chain(more).collect::<Vec<_>>().join(", ")
    }

    /// The next line into a record that is kept; none at the end.
    ///
    /// # Errors
    /// When the line has other columns than the header, or is no text.
    pub fn next(&mut self, record: &mut csv::StringRecord) -> Result<bool, ImportError> {
        let read = self.reader.read_record(record);
        read.map_err(|source| ImportError::Csv { path: self.path.to_owned(), source })
    }
}

/// Whether the last line of a table ends. A table that is cut inside its last number is a sound one of another number.
///
/// # Errors
/// When it cannot be read.
pub fn is_ended(path: &Path) -> Result<bool, ImportError> {
    let last = || {
        let mut file = input_file::open(path)?;
        if file.metadata()?.len() == 0 {
            return Ok(b'\n');
        }
        let mut last = [0];
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last).map(|()| last[0])
    };
    let last = last().map_err(|source| ImportError::Io { path: path.to_owned(), source })?;
    Ok([b'\n', b'\r'].contains(&last))
}

/// A sentence on a table whose last line does not end.
pub fn not_ended(path: &Path) -> String {
    format!(
        "{} does not end with an end of line: it may be cut inside its last number; end the last line, too",
        path.display()
    )
}

/// Line of a record in its file, from 1.
pub fn line_of(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}
