//! Rows of a large study's table, made while its records are at hand and kept in a file of nobody else's until the
//! table is written in the order of the study: to read a record back takes longer than to make it.
//!
//! The file has no name on systems that let it go, and is nobody's a day later on others: a run that is killed leaves
//! nothing, and the next one makes the rows of its records.

use crate::record::csv::packed_table::{RowsOf, is_rows_of};
use crate::record::pack::member::{HEADER, Header};
use crate::record::whole_file::create_part;
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Rows of records, packed.
#[derive(Debug)]
pub struct RowsAtHand {
    file: File,
    /// Its name, where the system would not let it go.
    path: Option<PathBuf>,
    end: u64,
    /// Where the last rows of a case begin; their header says how long they are.
    places: HashMap<u64, u64>,
}

impl RowsAtHand {
    /// A file for them in the folder of a study's results.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn in_folder(study: &Path) -> io::Result<Self> {
        fs::create_dir_all(study)?;
        let (path, file) = create_part(study, "rows")?;
        let path = fs::remove_file(&path).is_err().then_some(path);
        Ok(Self { file, path, end: 0, places: HashMap::new() })
    }

    /// Keeps the rows of a record, packed.
    ///
    /// # Errors
    /// When the file system refuses; what was kept before is still there.
    pub fn keep(&mut self, of: RowsOf, member: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(member)?;
        self.places.insert(of.case, self.end);
        self.end += member.len() as u64;
        Ok(())
    }

    /// The rows of a record as they stand in the table, where they were kept.
    pub fn packed(&mut self, of: RowsOf) -> Option<Vec<u8>> {
        self.file.seek(SeekFrom::Start(*self.places.get(&of.case)?)).ok()?;
        let mut member = vec![0; HEADER];
        self.file.read_exact(&mut member).ok()?;
        member.resize(Header::read(&member)?.length as usize, 0);
        self.file.read_exact(&mut member[HEADER..]).ok()?;
        is_rows_of(&member, of).then_some(member)
    }
}

impl Drop for RowsAtHand {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            let _ = fs::remove_file(path);
        }
    }
}
