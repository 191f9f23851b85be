//! Banded matrices and their LU factorisation with partial pivoting.
//!
//! Unknowns ordered along the column keep every operator within a narrow band, so that factoring and solving are linear in
//! the number of cells (Golub & Van Loan 2013, algorithm 4.3.1).

use crate::direct_solver::Singular;
use crate::time_limit::TimeLimit;
use crate::wide::{LANES, wide};

/// Columns between two looks at the clock.
const COLUMNS_TO_CLOCK: usize = 1024;

/// A square matrix whose entries lie within `lower` diagonals below and `upper` above the main one, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct Banded {
    size: usize,
    lower: usize,
    upper: usize,
    /// Entry `(i, j)` at `j * height + lower + upper + i − j`; the first `lower` places of a column have room for what
    /// row interchanges fill in.
    entries: Vec<f64>,
}

impl Banded {
    /// A matrix of zeros.
    pub fn zeros(size: usize, lower: usize, upper: usize) -> Self {
        Self { size, lower, upper, entries: vec![0.0; size * (2 * lower + upper + 1)] }
    }

    /// Stored entries of a column.
    fn height(&self) -> usize {
        2 * self.lower + self.upper + 1
    }

    /// Adds to an entry, which must lie within the band.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        assert!(column + self.lower >= row && column <= row + self.upper);
        let place = column * self.height() + self.lower + self.upper + row - column;
        self.entries[place] += value;
    }

    /// The stored entries, column by column.
    pub fn entries(&self) -> &[f64] {
        &self.entries
    }

    /// The stored entries, to be changed.
    pub fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// `rest ← rest − A values`.
    pub fn subtract_product(&self, values: &[f64], rest: &mut [f64]) {
        for (column, entries) in self.entries.chunks_exact(self.height()).enumerate() {
            let first = column.saturating_sub(self.upper);
            let rows = first..(column + self.lower + 1).min(self.size);
            let start = self.lower + self.upper + first - column;
            subtract_multiple(&mut rest[rows], values[column], &entries[start..]);
        }
    }
}

/// The factors of a banded matrix.
#[derive(Clone, Debug)]
pub struct BandedLu {
    /// `U` above the diagonal, one over the pivots on it, the multipliers of `L` below.
    factors: Banded,
    /// Rows from each column's diagonal down to the one that took its place.
    pivots: Vec<usize>,
    /// Diagonals of `U` above the main one that hold something.
    reach: usize,
}

impl BandedLu {
    /// Room for the factors of matrices of a shape.
    pub fn of_shape(shape: &Banded) -> Self {
        Self { factors: shape.clone(), pivots: vec![0; shape.size], reach: 0 }
    }

    /// Factors a matrix; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot, or the time is over.
    pub fn factor(&mut self, matrix: &Banded, time_limit: TimeLimit) -> Result<(), Singular> {
        self.factors.entries.copy_from_slice(&matrix.entries);
        wide!(self.eliminate(time_limit))
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn eliminate(&mut self, time_limit: TimeLimit) -> Result<(), Singular> {
        let (size, height) = (self.factors.size, self.factors.height());
        let (lower, upper) = (self.factors.lower, self.factors.upper);
        let diagonal = lower + upper;
        let mut end = 0;
        self.reach = 0;
        for column in 0..size {
            if column % COLUMNS_TO_CLOCK == COLUMNS_TO_CLOCK - 1 && time_limit.is_over() {
                return Err(Singular { row: column });
            }
            let below = lower.min(size - 1 - column);
            let (left, right) = self.factors.entries.split_at_mut((column + 1) * height);
            let pivot_column = &mut left[column * height + diagonal..][..=below];
            let mut pivot = 0;
            for row in 1..=below {
                if pivot_column[row].abs() > pivot_column[pivot].abs() {
                    pivot = row;
                }
            }
            pivot_column.swap(0, pivot);
            if pivot_column[0] == 0.0 || !pivot_column[0].is_finite() {
                return Err(Singular { row: column });
            }
            self.pivots[column] = pivot;
            pivot_column[0] = 1.0 / pivot_column[0];
            let (per_pivot, multipliers) = (pivot_column[0], &mut pivot_column[1..]);
            for multiplier in multipliers.iter_mut() {
                *multiplier *= per_pivot;
            }
            // Columns that the pivot row reaches.
            end = end.max((column + pivot + upper + 1).min(size));
            self.reach = self.reach.max(end - 1 - column);
            for (ahead, other) in (1..end - column).zip(right.chunks_exact_mut(height)) {
                let rows = &mut other[diagonal - ahead..][..=below];
                rows.swap(0, pivot);
                let value = rows[0];
                if value != 0.0 {
                    subtract_multiple(&mut rows[1..], value, multipliers);
                }
            }
        }
        Ok(())
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&self, values: &mut [f64]) {
        wide!(self.substitute(values));
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn substitute(&self, values: &mut [f64]) {
        let Banded { size, lower, upper, ref entries } = self.factors;
        let (height, diagonal) = (self.factors.height(), lower + upper);
        for (column, factors) in entries.chunks_exact(height).enumerate() {
            values.swap(column, column + self.pivots[column]);
            let value = values[column];
            let below = lower.min(size - 1 - column);
            subtract_multiple(&mut values[column + 1..][..below], value, &factors[diagonal + 1..]);
        }
        for (column, factors) in entries.chunks_exact(height).enumerate().rev() {
            let value = values[column] * factors[diagonal];
            values[column] = value;
            let above = self.reach.min(column);
            subtract_multiple(&mut values[column - above..column], value, &factors[diagonal - above..]);
        }
    }
}

/// `rest ← rest − factor · entries`.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn subtract_multiple(rest: &mut [f64], factor: f64, entries: &[f64]) {
    // Bands are a few registers wide: by fours they leave three numbers at most, where the compiler's own loop leaves more.
    let count = rest.len().min(entries.len());
    let (fours, last) = rest[..count].as_chunks_mut::<LANES>();
    let (entries, last_entries) = entries[..count].as_chunks::<LANES>();
    for (rest, entries) in fours.iter_mut().zip(entries) {
        for i in 0..LANES {
            rest[i] -= factor * entries[i];
        }
    }
    for (rest, entry) in last.iter_mut().zip(last_entries) {
        *rest -= factor * entry;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solutions_are_those_of_the_dense_matrix(
            size in 1..64usize, lower in 0..5usize, upper in 0..50usize, seed in 0..1000u32,
        ) {
            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 23) - 1.0
            };
            let mut banded = Banded::zeros(size, lower, upper);
            let mut dense = DMatrix::zeros(size, size);
            for row in 0..size {
                for column in row.saturating_sub(lower)..(row + upper + 1).min(size) {
                    // A weak diagonal makes rows change places.
                    let value = random() * if row == column { 0.1 } else { 1.0 };
                    banded.add(row, column, value);
                    dense[(row, column)] = value;
                }
            }
            let right = DVector::from_fn(size, |_, _| random());
            let mut lu = BandedLu::of_shape(&banded);
            // The dense factors say whether there is a solution worth comparing.
            let svd = dense.clone().svd(false, false).singular_values;
            prop_assume!(svd.min() > 1e-6 * svd.max());
            prop_assert_eq!(lu.factor(&banded, TimeLimit::default()), Ok(()));
            let mut solution = right.as_slice().to_vec();
            lu.solve(&mut solution);
            let residual = &dense * DVector::from_vec(solution) - right;
            prop_assert!(residual.amax() < 1e-8, "{}", residual.amax());
        }
    }

    #[test]
    fn a_zero_diagonal_needs_the_pivot_and_a_zero_column_is_named() {
        let mut saddle = Banded::zeros(2, 1, 1);
        saddle.add(0, 1, 2.0);
        saddle.add(1, 0, 4.0);
        let mut lu = BandedLu::of_shape(&saddle);
        assert_eq!(lu.factor(&saddle, TimeLimit::default()), Ok(()));
        let mut values = [6.0, 8.0];
        lu.solve(&mut values);
        assert_eq!(values, [2.0, 3.0]);
        let zero = Banded::zeros(2, 1, 1);
        assert_eq!(lu.factor(&zero, TimeLimit::default()), Err(Singular { row: 0 }));
    }
}
