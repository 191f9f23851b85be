//! Sparse rows: an operator as columns and values, one row after the other.

/// Rows of columns with their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SparseRows<T> {
    starts: Vec<usize>,
    entries: Vec<(u32, T)>,
}

impl<T: Copy> SparseRows<T> {
    /// The operator with the given rows.
    pub fn from_rows(rows: impl IntoIterator<Item = Vec<(usize, T)>>) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for row in rows {
            let numbered = |(column, value)| (u32::try_from(column).unwrap_or(u32::MAX), value);
            entries.extend(row.into_iter().map(numbered));
            starts.push(entries.len());
        }
        Self { starts, entries }
    }

    /// The entries of a row.
    #[inline]
    pub fn row(&self, row: usize) -> &[(u32, T)] {
        &self.entries[self.starts[row]..self.starts[row + 1]]
    }
}

impl SparseRows<f64> {
    /// Product of a row with a vector.
    #[inline]
    pub fn product(&self, row: usize, vector: &[f64]) -> f64 {
        self.row(row).iter().map(|(column, value)| value * vector[*column as usize]).sum()
    }
}

/// The entry of a column in a row sorted by column, inserted if missing.
pub fn entry_of<T>(row: &mut Vec<(usize, T)>, column: usize, zero: T) -> &mut T {
    let place = row.binary_search_by_key(&column, |entry| entry.0).unwrap_or_else(|place| {
        row.insert(place, (column, zero));
        place
    });
    &mut row[place].1
}
