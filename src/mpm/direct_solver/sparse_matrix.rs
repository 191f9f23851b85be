//! A square matrix by its entries, row by row.

/// Places of a row that are gathered before those named twice are dropped.
const GATHERED: usize = 1024;

/// A square matrix over a fixed set of places, with those of the transposed matrix and of the diagonal among
/// them: elimination fills them in anyway.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseMatrix {
    /// Place of each unknown in space, m; zeros beyond the dimension.
    positions: Vec<[f64; 3]>,
    /// First entry of each row, and the end of the last.
    starts: Vec<usize>,
    /// Column of each entry, rising in a row.
    columns: Vec<u32>,
    entries: Vec<f64>,
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
            let row = &mut rows[row];
            row.push(number(column));
            if row.len() >= GATHERED && row.len().is_power_of_two() {
                row.sort_unstable();
                row.dedup();
            }
        };
        visit(&mut |row, column| {
            note(row, column);
            note(column, row);
        });
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for mut row in rows {
            row.sort_unstable();
            row.dedup();
            columns.extend(row);
            starts.push(columns.len());
        }
        let in_space = |place: &[f64; D]| std::array::from_fn(|d| place.get(d).copied().unwrap_or(0.0));
        let positions = positions.iter().map(in_space).collect();
        Self { positions, starts, entries: vec![0.0; columns.len()], columns }
    }

    /// Place of each unknown in space, m.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Number of the first entry of a row, and its columns.
    pub fn row(&self, row: usize) -> (usize, &[u32]) {
        let start = self.starts[row];
        (start, &self.columns[start..self.starts[row + 1]])
    }

    /// Column of an entry.
    #[inline]
    pub fn column(&self, entry: usize) -> usize {
        self.columns[entry] as usize
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
        for (row, rest) in rest.iter_mut().enumerate().take(self.positions.len()) {
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
