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
pub(crate) struct RowsAtHand {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::record::csv::packed_table::packed_rows;
    use crate::record::csv::tidy;
    use crate::record::pack::member::unpacked;
    use crate::record::store::RecordStore;

    #[test]
    fn rows_come_back_by_what_they_are_of_and_leave_no_file() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let study = folder.path().join("study");
        let mut rows = RowsAtHand::in_folder(&study).expect("a file");
        let of = |case, generation| RowsOf { case, generation, program: 1, build: 2 };
        for (of, text) in [(of(1, 1), "a,1\n"), (of(2, 1), "b,2\nb,3\n"), (of(1, 2), "a,4\n")] {
            rows.keep(of, &packed_rows(of, text).expect("packed")).expect("kept");
        }
        let mut text = |of| rows.packed(of).and_then(|member| unpacked(&member));
        assert_eq!(text(of(2, 1)).as_deref(), Some("b,2\nb,3\n"));
        assert_eq!(text(of(1, 2)).as_deref(), Some("a,4\n"));
        assert_eq!(
            [text(of(3, 1)), text(of(2, 2)), text(of(1, 1))],
            [None, None, None],
            "another case, another run"
        );
        drop(rows);
        assert_eq!(fs::read_dir(&study).expect("a folder").count(), 0);
    }
    #[test]
    fn rows_at_hand_are_those_of_the_records_as_they_are_read_back() {
        let records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
             method = [\"MPM\", \"GC-SRI-patch\"]\nintegrator = [\"implicit\"]\ncells = [2, 3]\n",
        );
        let folder = tempfile::TempDir::new().expect("a folder");
        let store = RecordStore::for_cases(folder.path(), "s", 100);
        let (last, first) = records.split_last().expect("some");
        store.keep_rows_at_hand();
        for record in first {
            store.write(record).expect("written");
        }
        let mut rows = store.take_rows_at_hand().expect("asked for");
        store.write(last).expect("written");
        let again = RecordStore::for_cases(folder.path(), "s", 100);
        for record in &records {
            let of = again.entry(&record.case).expect("a record").rows();
            let read = tidy::rows_of("s", &again.kept(&record.case).expect("whole"));
            let at_hand = rows.packed(of).and_then(|member| unpacked(&member));
            assert_eq!(at_hand, (record != last).then_some(read), "none are made before or after");
        }
    }
}
