//! The tables of a study as files: the tidy one, those beside it, plain or compressed.

pub mod long_tables;
pub mod table_file;
pub mod tidy;

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
