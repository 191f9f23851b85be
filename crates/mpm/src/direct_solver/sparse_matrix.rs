//! A sparse square matrix, row by row.

use std::sync::Arc;

/// Entries of a row that there is room for from the start: rows of a body in the plane grow no further, each listed from
/// both sides.
const USUAL_ROW: usize = 128;

/// A square matrix with a fixed pattern, which includes the diagonal and is symmetric: elimination fills those places in
/// anyway.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseMatrix {
    /// The pattern, which matrices share.
    shape: Arc<Shape>,
    entries: Vec<f64>,
}

/// Where the entries are.
#[derive(Debug, PartialEq)]
struct Shape {
    /// Place of each unknown in space, m; zeros beyond the dimension.
    positions: Vec<[f64; 3]>,
    /// First entry of each row, and the end of the last.
    starts: Vec<usize>,
    /// Column of each entry, rising in a row.
    columns: Vec<u32>,
}

impl SparseMatrix {
    /// Zeros at the places `(row, column)` that `visit` lists; `positions` as `[unknown][component]`, m.
    ///
    /// # Panics
    /// Beyond 2³² unknowns, whose matrix no memory holds.
    pub fn spanning<const D: usize>(
        positions: &[[f64; D]],
        visit: impl Fn(&mut dyn FnMut(usize, usize)),
    ) -> Self {
        let number = |unknown: usize| u32::try_from(unknown).expect("fewer than 2^32 unknowns");
        let with_diagonal = |row: usize| {
            let mut columns = Vec::with_capacity(USUAL_ROW);
            columns.push(number(row));
            columns
        };
        let mut rows: Vec<Vec<u32>> = (0..positions.len()).map(with_diagonal).collect();
        visit(&mut |row, column| {
            rows[row].push(number(column));
            rows[column].push(number(row));
        });
        for columns in &mut rows {
            columns.sort_unstable();
            columns.dedup();
        }
        let mut starts = vec![0];
        let mut columns = Vec::with_capacity(rows.iter().map(Vec::len).sum());
        for row in rows {
            columns.extend(row);
            starts.push(columns.len());
        }
        let in_space = |place: &[f64; D]| std::array::from_fn(|d| place.get(d).copied().unwrap_or(0.0));
        let positions = positions.iter().map(in_space).collect();
        let entries = vec![0.0; columns.len()];
        Self { shape: Arc::new(Shape { positions, starts, columns }), entries }
    }

    /// Place of each unknown in space, m.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.shape.positions
    }

    /// Number of the first entry of a row, and its columns.
    pub fn row(&self, row: usize) -> (usize, &[u32]) {
        let Shape { starts, columns, .. } = &*self.shape;
        (starts[row], &columns[starts[row]..starts[row + 1]])
    }

    /// Number of the entry at one of the places.
    ///
    /// # Panics
    /// At any other place.
    pub fn entry(&self, row: usize, column: usize) -> usize {
        let (start, columns) = self.row(row);
        let place = columns.partition_point(|other| (*other as usize) < column);
        assert_eq!(columns[place] as usize, column, "a place of the pattern");
        start + place
    }

    /// The entries, in the order of their numbers.
    pub fn entries(&self) -> &[f64] {
        &self.entries
    }

    /// The entries, to be changed.
    pub fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Adds to an entry, which must be one of the places.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let entry = self.entry(row, column);
        self.entries[entry] += value;
    }

    /// `rest ← rest − A values`.
    pub fn subtract_product(&self, values: &[f64], rest: &mut [f64]) {
        for (row, rest) in rest.iter_mut().enumerate().take(self.shape.positions.len()) {
            let (start, columns) = self.row(row);
            let entries = &self.entries[start..start + columns.len()];
            *rest = entries
                .iter()
                .zip(columns)
                .fold(*rest, |rest, (a, column)| rest - a * values[*column as usize]);
        }
    }
}
