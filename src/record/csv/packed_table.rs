//! The tidy table of a large study: its rows compressed, a gzip member a case in the order of the study.
//!
//! `zcat STUDY.csv.gz` is the table. The header of a member says of which record its rows are, so that a table that
//! is written again makes rows only of records that are new, and copies the others as they are.

use crate::record::pack::index::{Index, Place};
use crate::record::pack::member::{Header, Kind, packed};
use crate::record::whole_file::{StoreError, write_streamed};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Which record the rows of a case are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowsOf {
    /// Number that the hash of the case is.
    pub case: u64,
    /// Count of the run that left the record.
    pub generation: u32,
    /// Tag of the program that made it.
    pub program: u64,
    /// Tag of that program's build.
    pub build: u64,
}

impl RowsOf {
    fn header(self) -> Header {
        let Self { case, generation, program, build } = self;
        Header { kind: Kind::Rows, generation, case, program, build, length: 0 }
    }

    fn of(header: &Header) -> Self {
        let Header { case, generation, program, build, .. } = *header;
        Self { case, generation, program, build }
    }
}

/// The rows of a record as a member of the table.
///
/// # Errors
/// When they are longer than a member may be.
pub fn packed_rows(of: RowsOf, rows: &str) -> std::io::Result<Vec<u8>> {
    packed(of.header(), rows.as_bytes())
}

/// Whether a member of the table has the rows of a record.
pub fn is_rows_of(member: &[u8], of: RowsOf) -> bool {
    Header::read(member).is_some_and(|header| header.kind == Kind::Rows && RowsOf::of(&header) == of)
}

/// Writes the table of cases in their order, each with which record its rows are made of. `rows` makes those of a
/// case, packed, none where its record cannot be read.
///
/// # Errors
/// When the file system refuses.
pub fn write_packed_table<C>(
    path: &Path,
    columns: &str,
    cases: impl Iterator<Item = (RowsOf, C)>,
    mut rows: impl FnMut(RowsOf, C) -> Option<std::io::Result<Vec<u8>>>,
) -> Result<(), StoreError> {
    // The columns are a member of their own, whose tag says what they are.
    let tag = blake3::hash(columns.as_bytes()).as_bytes()[..8]
        .iter()
        .fold(0, |tag, byte| tag << 8 | u64::from(*byte));
    let of_columns =
        Header { kind: Kind::Columns, ..RowsOf { case: 0, generation: 0, program: tag, build: 0 }.header() };
    let old = Index::of_file(path).unwrap_or_default();
    let is_old = |place: Place| place.header.kind == Kind::Columns && place.header.program == tag;
    let old = if old.columns().is_some_and(is_old) { old } else { Index::default() };
    write_streamed(path, |file| {
        let mut out = BufWriter::with_capacity(1 << 16, file);
        out.write_all(&packed(of_columns, columns.as_bytes())?)?;
        let mut reader = old.reader();
        for (of, case) in cases {
            let known = old.record(of.case).filter(|place| RowsOf::of(&place.header) == of);
            match known.and_then(|place| reader.bytes(place).ok()) {
                Some(member) => out.write_all(&member)?,
                None => {
                    if let Some(rows) = rows(of, case) {
                        out.write_all(&rows?)?;
                    }
                }
            }
        }
        out.flush()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::io::Read;

    fn text_of(path: &Path) -> String {
        let mut text = String::new();
        let file = std::fs::File::open(path).expect("a table");
        flate2::read::MultiGzDecoder::new(file).read_to_string(&mut text).expect("gzip");
        text
    }

    #[test]
    fn a_table_that_is_written_again_makes_only_the_rows_of_new_records() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("s.csv.gz");
        let made = Cell::new(0);
        let case = |case, generation| RowsOf { case, generation, program: 1, build: 2 };
        let write = |columns: &str, cases: &[RowsOf]| {
            made.set(0);
            let rows = |one: RowsOf, ()| {
                made.set(made.get() + 1);
                (one.case != 9).then(|| packed_rows(one, &format!("{},{}\n", one.case, one.generation)))
            };
            let cases = cases.iter().map(|one| (*one, ()));
            write_packed_table(&path, columns, cases, rows).expect("written");
            (text_of(&path), made.get())
        };
        let first = write("case,run\n", &[case(5, 1), case(3, 1), case(9, 1)]);
        assert_eq!(first, ("case,run\n5,1\n3,1\n".to_owned(), 3), "in the order that is asked for");
        let more = write("case,run\n", &[case(4, 2), case(5, 1), case(3, 2)]);
        assert_eq!(more, ("case,run\n4,2\n5,1\n3,2\n".to_owned(), 2), "one is new and one was run again");
        let other = write("case,count\n", &[case(5, 1)]);
        assert_eq!(other, ("case,count\n5,1\n".to_owned(), 1), "other columns, all rows anew");
    }
}
