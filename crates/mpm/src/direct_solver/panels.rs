//! The factors of a front as solutions read them: panels of four rows, column by column.
//!
//! A solution takes each number of the factors once, so it lasts as long as they take to come from memory. They lie in the
//! order in which they are used, and the sums of a panel stay in registers.

#![expect(
    clippy::inline_always,
    reason = "what `wide!` compiles for wider registers must be inlined into it"
)]

use crate::direct_solver::first_rows;
use crate::wide::wide;
use nalgebra::DMatrix;
use std::ops::Range;

/// Rows of a panel, and columns whose products are summed apart.
const WIDTH: usize = 4;

/// Entries of a column in the rows of a panel.
type Rows = [f64; WIDTH];

/// Columns of a panel's own rows; zeros beyond the last.
type Triangle = [Rows; WIDTH];

/// `L` and `U` of a front.
#[derive(Clone, Debug)]
pub(crate) struct Panels {
    /// Unknowns that the front eliminates.
    count: usize,
    /// Those and the unknowns of its boundary.
    height: usize,
    /// `L` from the first panel to the last: the columns before the panel's rows.
    lower: Vec<Rows>,
    /// `U` from the last panel to the first: the columns beyond the panel's rows.
    upper: Vec<Rows>,
    /// `L` and `U` of the rows of each panel, with one over the pivots on the diagonal of `U`.
    triangles: Vec<[Triangle; 2]>,
}

impl Panels {
    /// Room for the factors of a front that eliminates so many unknowns before so many of its boundary.
    pub fn of_shape(count: usize, boundary: usize) -> Self {
        let height = count + boundary;
        let lower = (0..height).step_by(WIDTH).map(|first| count.min(first)).sum();
        let upper = (0..count).step_by(WIDTH).map(|first| height - count.min(first + WIDTH)).sum();
        let [lower, upper] = [lower, upper].map(Vec::with_capacity);
        let triangles = vec![[Triangle::default(); 2]; count.div_ceil(WIDTH)];
        Self { count, height, lower, upper, triangles }
    }

    /// Numbers in `L` and `U` without the triangles, at most.
    pub fn numbers(&self) -> usize {
        WIDTH * (self.lower.capacity() + self.upper.capacity())
    }

    /// Takes the factors of a front: `left`, `[count + boundary][count]`, holds `L` below its diagonal and `U` on and above
    /// it; `right`, `[count][boundary]`, the rest of `U`.
    pub fn take(&mut self, left: &DMatrix<f64>, right: &DMatrix<f64>) {
        let (count, height) = (self.count, self.height);
        self.lower.clear();
        for first in (0..height).step_by(WIDTH) {
            self.lower.extend((0..count.min(first)).map(|column| rows_of(left, column, first..height)));
        }
        self.upper.clear();
        for first in (0..count).step_by(WIDTH).rev() {
            let end = count.min(first + WIDTH);
            self.upper.extend((end..count).map(|column| rows_of(left, column, first..end)));
            self.upper.extend((0..height - count).map(|column| rows_of(right, column, first..end)));
            let [lower, upper] = &mut self.triangles[first / WIDTH];
            for (place, column) in (first..end).enumerate() {
                lower[place] = rows_of(left, column, first..height);
                upper[place] = rows_of(left, column, first..end);
                upper[place][place] = 1.0 / upper[place][place];
            }
        }
    }

    /// Replaces the values of the front by `L⁻¹` of them, and takes from those of its boundary, which follow, what they are
    /// tied to.
    pub fn go_down(&self, values: &mut [f64]) {
        wide!({
            let mut left = &self.lower[..];
            for (panel, first) in (0..self.height).step_by(WIDTH).enumerate() {
                let (solved, rest) = values.split_at_mut(first);
                let (columns, later) = left.split_at(self.count.min(first));
                let mut rows = less_product(rest, columns, solved);
                if let Some([triangle, _]) = self.triangles.get(panel) {
                    for n in 0..WIDTH {
                        for row in n + 1..WIDTH {
                            rows[row] -= triangle[n][row] * rows[n];
                        }
                    }
                }
                put(rest, &rows);
                left = later;
            }
        });
    }

    /// Replaces the values of the front by `U⁻¹` of what they are without those of its boundary, which follow.
    pub fn go_up(&self, values: &mut [f64]) {
        wide!({
            let mut left = &self.upper[..];
            for (panel, [_, triangle]) in self.triangles.iter().enumerate().rev() {
                let first = panel * WIDTH;
                let (rest, solved) = values.split_at_mut(self.count.min(first + WIDTH));
                let rest = &mut rest[first..];
                let (columns, later) = left.split_at(solved.len());
                let mut rows = less_product(rest, columns, solved);
                for n in (0..WIDTH).rev() {
                    rows[n] *= triangle[n][n];
                    for row in 0..n {
                        rows[row] -= triangle[n][row] * rows[n];
                    }
                }
                put(rest, &rows);
                left = later;
            }
        });
    }
}

/// The rows of a panel in a column of a matrix, of which only some rows are taken.
#[inline]
fn rows_of(matrix: &DMatrix<f64>, column: usize, rows: Range<usize>) -> Rows {
    first_rows(&matrix.as_slice()[column * matrix.nrows()..][rows])
}

/// Puts the rows of a panel to the front of a column, which may end before them.
#[inline(always)]
fn put(column: &mut [f64], rows: &Rows) {
    match column.first_chunk_mut() {
        Some(place) => *place = *rows,
        None => column.iter_mut().zip(rows).for_each(|(place, row)| *place = *row),
    }
}

/// The first of some values, less the product of a panel's columns with as many factors; further factors are not used.
#[inline(always)]
fn less_product(values: &[f64], columns: &[Rows], factors: &[f64]) -> Rows {
    let factors = &factors[..columns.len()];
    let ((columns, last_columns), (factors, last_factors)) =
        (columns.as_chunks::<WIDTH>(), factors.as_chunks::<WIDTH>());
    let mut sums = [[0.0; WIDTH]; WIDTH];
    for (columns, factors) in columns.iter().zip(factors) {
        for n in 0..WIDTH {
            for row in 0..WIDTH {
                sums[n][row] += columns[n][row] * factors[n];
            }
        }
    }
    for (column, factor) in last_columns.iter().zip(last_factors) {
        for row in 0..WIDTH {
            sums[0][row] += column[row] * factor;
        }
    }
    let mut rows = first_rows(values);
    for row in 0..WIDTH {
        rows[row] -= (sums[0][row] + sums[1][row]) + (sums[2][row] + sums[3][row]);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::in_narrow_registers;
    use nalgebra::DVector;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solutions_are_those_of_the_dense_triangles(
            count in 0..23usize, boundary in 0..23usize, seed in 1..1_000_000_u32,
        ) {
            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 23) - 1.0
            };
            let left = DMatrix::from_fn(count + boundary, count, |row, column| {
                random() / 4.0 + if row == column { 2.0 } else { 0.0 }
            });
            let right = DMatrix::from_fn(count, boundary, |_, _| random());
            let start = DVector::from_fn(count + boundary, |_, _| random());
            let mut panels = Panels::of_shape(count, boundary);
            panels.take(&left, &right);
            let solved = |solve: fn(&Panels, &mut [f64])| {
                let mut values = start.clone();
                solve(&panels, values.as_mut_slice());
                let mut narrow = start.clone();
                in_narrow_registers(|| solve(&panels, narrow.as_mut_slice()));
                assert_eq!(narrow, values, "the same bits on every processor");
                values
            };
            let mut lower = DMatrix::identity(count + boundary, count + boundary);
            let mut upper = lower.clone();
            for column in 0..count {
                lower.view_mut((column + 1, column), (count + boundary - column - 1, 1))
                    .copy_from(&left.view((column + 1, column), (count + boundary - column - 1, 1)));
                upper.view_mut((0, column), (column + 1, 1)).copy_from(&left.view((0, column), (column + 1, 1)));
            }
            upper.view_mut((0, count), (count, boundary)).copy_from(&right);
            prop_assert!((lower * solved(Panels::go_down) - &start).amax() < 1e-12);
            prop_assert!((upper * solved(Panels::go_up) - &start).amax() < 1e-12);
        }
    }
}
