//! Sparse rows: what is left of an operator where a whole band would be zeros.

/// Rows of column–value pairs, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SparseRows {
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl SparseRows {
    /// No row yet.
    pub fn new() -> Self {
        Self { starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    /// Appends a row.
    pub fn push_row(&mut self, entries: impl IntoIterator<Item = (usize, f64)>) {
        for (column, value) in entries {
            self.columns.push(column);
            self.values.push(value);
        }
        self.starts.push(self.columns.len());
    }

    /// Product of a row with a vector.
    #[inline]
    pub fn product(&self, row: usize, vector: &[f64]) -> f64 {
        let range = self.starts[row]..self.starts[row + 1];
        let mut sum = 0.0;
        for (column, value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
            sum += value * vector[*column];
        }
        sum
    }

    /// The entries of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }
}

/// Adds a value to the entry of a column in a short row that is being made.
pub fn accumulate(row: &mut Vec<(usize, f64)>, column: usize, value: f64) {
    match row.iter_mut().find(|(other, _)| *other == column) {
        Some((_, sum)) => *sum += value,
        None => row.push((column, value)),
    }
}
