//! A square matrix by its entries, row by row.

use std::sync::Arc;

/// A square matrix over a fixed set of places, with those of the transposed matrix and of the diagonal among
/// them: elimination fills them in anyway.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseMatrix {
    /// Its places, which matrices of one shape share.
    shape: Arc<Shape>,
    entries: Vec<f64>,
}

/// Places of entries.
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
    /// Zeros at the places that `visit` tells; `positions` as `[unknown][component]`, m.
    ///
    /// # Panics
    /// Beyond 2³² unknowns, whose matrix no memory holds.
    pub fn spanning<const D: usize>(
        positions: &[[f64; D]],
        visit: impl Fn(&mut dyn FnMut(usize, usize)),
    ) -> Self {
        let number = |unknown: usize| u32::try_from(unknown).expect("fewer than 2^32 unknowns");
        let mut rows: Vec<Vec<u32>> = (0..positions.len()).map(|row| vec![number(row)]).collect();
        let mut note = |row: usize, column: usize| {
            let (row, column) = (&mut rows[row], number(column));
            if let Err(place) = row.binary_search(&column) {
                row.insert(place, column);
            }
        };
        visit(&mut |row, column| {
            note(row, column);
            note(column, row);
        });
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

    /// Column of an entry.
    #[inline]
    pub fn column(&self, entry: usize) -> usize {
        self.shape.columns[entry] as usize
    }

    /// The entries, in the order of their numbers.
    pub fn entries(&self) -> &[f64] {
        &self.entries
    }

    /// Adds to an entry, which must be one of the places.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let (start, columns) = self.row(row);
        let place = columns.partition_point(|other| (*other as usize) < column);
        assert_eq!(columns[place] as usize, column);
        self.entries[start + place] += value;
    }

    /// `rest ← rest − A values`.
    pub fn take_product(&self, values: &[f64], rest: &mut [f64]) {
        for (row, rest) in rest.iter_mut().enumerate().take(self.shape.positions.len()) {
            let (start, columns) = self.row(row);
            let entries = &self.entries[start..start + columns.len()];
            *rest = entries
                .iter()
                .zip(columns)
                .fold(*rest, |rest, (a, column)| rest - a * values[*column as usize]);
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }
}
