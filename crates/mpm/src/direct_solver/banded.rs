//! Banded matrices and their LU factorisation with partial pivoting.
//!
//! Unknowns ordered along the column keep every operator within a narrow band, so that factoring
//! and solving are linear in the number of cells (Golub & Van Loan 2013, algorithm 4.3.1).

use crate::direct_solver::singular::Singular;
use crate::time_limit::TimeLimit;
use crate::wide::wide;

/// Columns between two looks at the clock.
const COLUMNS_TO_CLOCK: usize = 1024;
/// A square matrix whose entries lie within `lower` diagonals below and `upper` above the main
/// one, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Banded {
    size: usize,
    lower: usize,
    upper: usize,
    /// Entries a row: the band and room for what pivoting fills in.
    width: usize,
    /// Entry `(i, j)` at `i * width + j + lower − i`.
    entries: Vec<f64>,
}

impl Banded {
    /// A matrix of zeros.
    pub fn zeros(size: usize, lower: usize, upper: usize) -> Self {
        let width = 2 * lower + upper + 1;
        Self { size, lower, upper, width, entries: vec![0.0; size * width] }
    }

    /// Adds to an entry, which must lie within the band.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        assert!(column + self.lower >= row && column <= row + self.upper);
        self.entries[row * self.width + column + self.lower - row] += value;
    }

    /// `self ← fixed + factor · scaled`, all of one shape.
    pub fn set_combination(&mut self, fixed: &Self, factor: f64, scaled: &Self) {
        for ((entry, fixed), scaled) in self.entries.iter_mut().zip(&fixed.entries).zip(&scaled.entries) {
            *entry = fixed + factor * scaled;
        }
    }

    /// `rest ← rest − A values`.
    pub fn take_product(&self, values: &[f64], rest: &mut [f64]) {
        for row in 0..self.size {
            let (first, end) = (row.saturating_sub(self.lower), (row + self.upper + 1).min(self.size));
            let entries = &self.entries[row * self.width + first + self.lower - row..];
            rest[row] = less_products(rest[row], entries, &values[first..end]);
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }
}

/// The factors of a banded matrix.
#[derive(Clone, Debug)]
pub struct BandedLu {
    /// The upper factor.
    factors: Banded,
    /// The lower factor, column by column, for that is how a right-hand side goes through it; each column filled up
    /// with zeros to whole [`GROUP`]s.
    multipliers: Vec<f64>,
    /// The same of the upper factor above its diagonal, each column filled up on top, where the band is narrow: rows
    /// of a few entries would wait for every addition. Else none.
    upper_columns: Vec<f64>,
    /// Entries of such columns of both factors.
    column_lengths: [usize; 2],
    /// A right-hand side on its way, with room for whole columns before and behind it.
    padded: Vec<f64>,
    /// Row that took the place of each row.
    pivots: Vec<usize>,
    /// One over the diagonal of the upper factor.
    per_diagonal: Vec<f64>,
    /// Column behind the last entry of each row: only rows that changed places reach as far as they
    /// might.
    ends: Vec<usize>,
    /// When it is given up.
    time_limit: TimeLimit,
}

impl BandedLu {
    /// Factors of the unit matrix, with room for those of matrices of a shape.
    pub fn of_shape(shape: &Banded) -> Self {
        let reach = shape.lower + shape.upper;
        let [below, above] = [shape.lower, reach].map(|entries| entries.next_multiple_of(GROUP));
        let above = if reach < SHORT_ROW { above } else { 0 };
        Self {
            factors: shape.clone(),
            multipliers: vec![0.0; shape.size * below],
            upper_columns: vec![0.0; shape.size * above],
            column_lengths: [below, above],
            padded: vec![0.0; above + shape.size + below],
            pivots: vec![0; shape.size],
            per_diagonal: vec![1.0; shape.size],
            ends: (1..=shape.size).collect(),
            time_limit: TimeLimit::default(),
        }
    }

    /// Gives a factorisation up at the end of a time, as if the column at work had no pivot.
    pub fn end_within(&mut self, time_limit: TimeLimit) {
        self.time_limit = time_limit;
    }

    /// Factors `fixed + factor · scaled`; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    pub fn factor_combination(
        &mut self,
        fixed: &Banded,
        factor: f64,
        scaled: &Banded,
    ) -> Result<(), Singular> {
        self.factors.set_combination(fixed, factor, scaled);
        self.eliminate()
    }

    /// Factors a matrix; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    pub fn factor(&mut self, matrix: &Banded) -> Result<(), Singular> {
        self.factors.entries.copy_from_slice(&matrix.entries);
        self.eliminate()
    }

    fn eliminate(&mut self) -> Result<(), Singular> {
        let Banded { size, lower, width, .. } = self.factors;
        let upper = self.factors.upper;
        let entries = &mut self.factors.entries;
        let ends = &mut self.ends;
        for (row, end) in ends.iter_mut().enumerate() {
            *end = (row + upper + 1).min(size);
        }
        for column in 0..size {
            if column % COLUMNS_TO_CLOCK == COLUMNS_TO_CLOCK - 1 && self.time_limit.is_over() {
                return Err(Singular { row: column });
            }
            let last = (column + lower).min(size - 1);
            let at = |row: usize| row * width + column + lower - row;
            let mut pivot = column;
            for row in column + 1..=last {
                if entries[at(row)].abs() > entries[at(pivot)].abs() {
                    pivot = row;
                }
            }
            let value = entries[at(pivot)];
            if value == 0.0 || !value.is_finite() {
                return Err(Singular { row: column });
            }
            self.pivots[column] = pivot;
            ends.swap(column, pivot);
            let reach = ends[column] - column;
            let either = reach.max(ends[pivot] - column);
            if pivot != column {
                for k in 0..either {
                    entries.swap(at(column) + k, at(pivot) + k);
                }
            }
            let per_value = 1.0 / value;
            self.per_diagonal[column] = per_value;
            let (above, below) = entries.split_at_mut((column + 1) * width);
            let pivot_row = &above[column * width + lower..][1..reach];
            for row in column + 1..=last {
                let start = (row - column - 1) * width + column + lower - row;
                let multiplier = below[start] * per_value;
                self.multipliers[column * self.column_lengths[0] + row - column - 1] = multiplier;
                if multiplier != 0.0 {
                    ends[row] = ends[row].max(column + reach);
                    for (entry, above) in below[start + 1..start + reach].iter_mut().zip(pivot_row) {
                        *entry -= multiplier * above;
                    }
                }
            }
        }
        self.turn_upper();
        Ok(())
    }

    /// Writes the upper factor down by columns, where they are wanted.
    fn turn_upper(&mut self) {
        let Banded { size, lower, width, ref entries, .. } = self.factors;
        let length = self.column_lengths[1];
        if length == 0 {
            return;
        }
        self.upper_columns.fill(0.0);
        for row in 0..size {
            let entries = &entries[row * width + lower..][1..self.ends[row] - row];
            for (before, entry) in entries.iter().enumerate() {
                self.upper_columns[(row + 1 + before) * length + length - 1 - before] = *entry;
            }
        }
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        wide!(self.substitute(values));
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn substitute(&mut self, values: &mut [f64]) {
        let Banded { size, lower, width, ref entries, .. } = self.factors;
        let [below, above] = self.column_lengths;
        let padded = &mut self.padded[..];
        padded[above..above + size].copy_from_slice(values);
        for column in 0..size {
            let place = above + column;
            padded.swap(place, above + self.pivots[column]);
            let value = padded[place];
            let multipliers = &self.multipliers[column * below..][..below];
            take_products(&mut padded[place + 1..][..below], multipliers, value);
        }
        if above > 0 {
            for column in (0..size).rev() {
                let value = padded[above + column] * self.per_diagonal[column];
                padded[above + column] = value;
                let entries = &self.upper_columns[column * above..][..above];
                take_products(&mut padded[column..][..above], entries, value);
            }
        } else {
            for row in (0..size).rev() {
                let upper = &entries[row * width + lower..][1..self.ends[row] - row];
                padded[row] =
                    less_products(padded[row], upper, &padded[row + 1..size]) * self.per_diagonal[row];
            }
        }
        values.copy_from_slice(&padded[above..above + size]);
    }
}

/// Entries of a column that are taken at once.
const GROUP: usize = 4;

/// `rest ← rest − factor · entries`, of whole groups.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn take_products(rest: &mut [f64], entries: &[f64], factor: f64) {
    for (rest, entries) in rest.as_chunks_mut::<GROUP>().0.iter_mut().zip(entries.as_chunks::<GROUP>().0) {
        for (rest, entry) in rest.iter_mut().zip(entries) {
            *rest -= entry * factor;
        }
    }
}

/// Sums that run side by side in [`less_products`]: one long chain would wait for every addition.
const LANES: usize = 8;
/// Rows shorter than this, those of columns, are one chain: they gain nothing from lanes.
const SHORT_ROW: usize = 32;

/// `start − Σ a_i b_i` over the shorter of the two.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
pub(super) fn less_products(start: f64, a: &[f64], b: &[f64]) -> f64 {
    let chain = |start, a: &[f64], b: &[f64]| a.iter().zip(b).fold(start, |sum, (a, b)| sum - a * b);
    let count = a.len().min(b.len());
    if count < SHORT_ROW {
        return chain(start, a, b);
    }
    let (a, b) = (&a[..count], &b[..count]);
    let (a_lanes, b_lanes) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = chain(start, a_lanes.remainder(), b_lanes.remainder());
    let mut sums = [0.0; LANES];
    for (a, b) in a_lanes.zip(b_lanes) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    rest - sums.iter().sum::<f64>()
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
            prop_assert_eq!(lu.factor(&banded), Ok(()));
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
        assert_eq!(lu.factor(&saddle), Ok(()));
        let mut values = [6.0, 8.0];
        lu.solve(&mut values);
        assert_eq!(values, [2.0, 3.0]);
        let zero = Banded::zeros(2, 1, 1);
        assert_eq!(lu.factor(&zero), Err(Singular { row: 0 }));
        let mut combined = BandedLu::of_shape(&saddle);
        assert_eq!(combined.factor_combination(&zero, 2.0, &saddle), Ok(()));
        let mut values = [12.0, 16.0];
        combined.solve(&mut values);
        assert_eq!(values, [2.0, 3.0]);
    }
}
