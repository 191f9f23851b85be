//! A table of somebody else's, opened: its header, and what is told of it by its name.

use crate::formats::import_error::ImportError;
use crate::formats::input_file;
use crate::import::mapping::TableLayout;
use std::fs::File;
use std::path::Path;

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
        self.header.iter().map(|column| format!("`{column}`")).collect::<Vec<_>>().join(", ")
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

/// Line of a record in its file, from 1.
pub fn line_of(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}
