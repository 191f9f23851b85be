//! LU factorisation of dense blocks in place, by halves (Toledo 1997): nearly all of the work is products of matrices, and
//! those have the same bits on every processor, without fused operations.

#![expect(
    clippy::inline_always,
    reason = "what `wide!` compiles for wider registers must be inlined into it"
)]

use crate::direct_solver::first_rows;
use crate::wide::wide;
use nalgebra::{DMatrixView, DMatrixViewMut};
use std::array;
use std::ops::Range;

/// Columns that are eliminated one by one: products of narrower matrices are slower.
const NARROW: usize = 16;

/// Replaces a tall matrix by `L` and `U` of its first rows, as many as columns, and the rest of `L` below. Pivots are taken
/// among its first `pivot_rows` rows; `pivots` becomes how many rows below its own each was found. A column without a
/// pivot has a zero on the diagonal.
pub(crate) fn factor_columns(mut matrix: DMatrixViewMut<'_, f64>, pivot_rows: usize, pivots: &mut [usize]) {
    let columns = matrix.ncols();
    if columns <= NARROW {
        eliminate_one_by_one(&mut matrix, pivot_rows, pivots);
        return;
    }
    let half = columns / 2;
    let (mut left, mut right) = matrix.columns_range_pair_mut(..half, half..);
    let (first, second) = pivots.split_at_mut(half);
    factor_columns(left.as_view_mut(), pivot_rows, first);
    swap_rows(&mut right, first);
    let (mut above, mut below) = right.rows_range_pair_mut(..half, half..);
    solve_unit_lower(left.rows_range(..half), above.as_view_mut());
    subtract_product(&mut below, left.rows_range(half..), above.as_view());
    factor_columns(below, pivot_rows - half, second);
    swap_rows(&mut left.rows_range_mut(half..), second);
}

fn eliminate_one_by_one(matrix: &mut DMatrixViewMut<'_, f64>, pivot_rows: usize, pivots: &mut [usize]) {
    for (place, below) in pivots.iter_mut().enumerate() {
        *below = matrix.column(place).rows_range(place..pivot_rows).icamax();
        matrix.swap_rows(place, place + *below);
        let (mut done, mut later) = matrix.columns_range_pair_mut(..place + 1, place + 1..);
        let pivot = done[(place, place)];
        if pivot == 0.0 {
            continue;
        }
        let mut factors = done.column_mut(place);
        let factors = &mut factors.as_mut_slice()[place + 1..];
        wide!({
            for factor in &mut *factors {
                *factor /= pivot;
            }
            for mut column in later.column_iter_mut() {
                let (pivot_entry, rest) = column.as_mut_slice()[place..].split_at_mut(1);
                subtract_multiple(rest, factors, pivot_entry[0]);
            }
        });
    }
}

/// Swaps rows of a matrix in the order of pivots.
pub(crate) fn swap_rows(matrix: &mut DMatrixViewMut<'_, f64>, pivots: &[usize]) {
    for (row, below) in pivots.iter().enumerate() {
        matrix.swap_rows(row, row + below);
    }
}

/// `B ← L⁻¹ B` for a lower triangle with ones on its diagonal.
pub(crate) fn solve_unit_lower(lower: DMatrixView<'_, f64>, mut right: DMatrixViewMut<'_, f64>) {
    let count = lower.nrows();
    if count <= NARROW {
        let columns: Vec<_> = lower.column_iter().collect();
        wide!(for mut values in right.column_iter_mut() {
            let values = values.as_mut_slice();
            for (place, column) in columns.iter().enumerate() {
                let (done, rest) = values.split_at_mut(place + 1);
                subtract_multiple(rest, &column.as_slice()[place + 1..], done[place]);
            }
        });
        return;
    }
    let half = count / 2;
    let (mut above, mut below) = right.rows_range_pair_mut(..half, half..);
    let (upper_rows, lower_rows) = lower.rows_range_pair(..half, half..);
    solve_unit_lower(upper_rows.columns_range(..half), above.as_view_mut());
    let (left, corner) = lower_rows.columns_range_pair(..half, half..);
    subtract_product(&mut below, left, above.as_view());
    solve_unit_lower(corner, below);
}

/// Rows and columns of a product whose sums stay in registers together, and terms between two visits to memory.
const TILE: [usize; 3] = [8, 4, 64];

/// `C ← C − A B`.
pub(crate) fn subtract_product(
    c: &mut DMatrixViewMut<'_, f64>,
    a: DMatrixView<'_, f64>,
    b: DMatrixView<'_, f64>,
) {
    const COLUMNS: usize = TILE[1];
    // The rows of A that a tile takes, term by term; those beyond the last are zero.
    let mut panel = [[0.0; TILE[0]]; TILE[2]];
    for first_term in (0..a.ncols()).step_by(TILE[2]) {
        let terms = first_term..a.ncols().min(first_term + TILE[2]);
        for first_row in (0..a.nrows()).step_by(TILE[0]) {
            let rows = first_row..a.nrows().min(first_row + TILE[0]);
            let panel = &mut panel[..terms.len()];
            for (tile, term) in panel.iter_mut().zip(terms.clone()) {
                *tile = first_rows(&a.column(term).as_slice()[rows.clone()]);
            }
            let tiled = c.ncols() - c.ncols() % COLUMNS;
            for first in (0..tiled).step_by(COLUMNS) {
                subtract_tile::<COLUMNS>(c, panel, &b, (rows.clone(), terms.start, first));
            }
            for first in tiled..c.ncols() {
                subtract_tile::<1>(c, panel, &b, (rows.clone(), terms.start, first));
            }
        }
    }
}

/// Some terms of some rows of the product, in `N` columns from one on.
#[inline(always)]
fn subtract_tile<const N: usize>(
    c: &mut DMatrixViewMut<'_, f64>,
    panel: &[[f64; TILE[0]]],
    b: &DMatrixView<'_, f64>,
    (rows, first_term, first): (Range<usize>, usize, usize),
) {
    let columns: [_; N] = array::from_fn(|n| b.column(first + n));
    let columns = columns.each_ref().map(|column| &column.as_slice()[first_term..]);
    let sums = wide!({
        let factors = columns.map(|column| &column[..panel.len()]);
        let mut sums = [[0.0; TILE[0]]; N];
        for (term, tile) in panel.iter().enumerate() {
            for n in 0..N {
                let factor = factors[n][term];
                for (sum, value) in sums[n].iter_mut().zip(tile) {
                    *sum += value * factor;
                }
            }
        }
        sums
    });
    for (n, sums) in sums.iter().enumerate() {
        let mut column = c.column_mut(first + n);
        for (value, sum) in column.as_mut_slice()[rows.clone()].iter_mut().zip(sums) {
            *value -= sum;
        }
    }
}

/// `rest ← rest − factor column`.
#[inline(always)]
fn subtract_multiple(rest: &mut [f64], column: &[f64], factor: f64) {
    for (value, entry) in rest.iter_mut().zip(column) {
        *value -= entry * factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::in_narrow_registers;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn factors_multiply_to_the_matrix_with_its_rows_swapped(
            columns in 1..70usize, pivot_rows_below in 0..5usize, below in 0..40usize, seed in 1..1_000_000_u32,
        ) {
            let (pivot_rows, rows) = (columns + pivot_rows_below, columns + pivot_rows_below + below);
            let mut state = seed;
            let matrix = DMatrix::from_fn(rows, columns, |_, _| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 23) - 1.0
            });
            let (mut factors, mut swapped, mut pivots) = (matrix.clone(), matrix, vec![0; columns]);
            factor_columns(factors.as_view_mut(), pivot_rows, &mut pivots);
            swap_rows(&mut swapped.as_view_mut(), &pivots);
            let lower = DMatrix::from_fn(rows, columns, |row, column| match row.cmp(&column) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => 1.0,
                std::cmp::Ordering::Greater => factors[(row, column)],
            });
            prop_assert!(lower.rows(0, pivot_rows).amax() <= 1.0, "the largest of a column is its pivot");
            let upper = factors.rows(0, columns).upper_triangle();
            prop_assert!((&lower * &upper - &swapped).amax() < 1e-12 * lower.amax().max(1.0).powi(2));
            let mut right = swapped.clone();
            solve_unit_lower(lower.rows(0, columns), right.rows_mut(0, columns));
            prop_assert!((lower.rows(0, columns) * right.rows(0, columns) - swapped.rows(0, columns)).amax() < 1e-10);
        }
    }

    #[test]
    fn products_are_those_of_nalgebra_at_every_remainder_of_their_blocks() {
        for (rows, terms, columns) in
            [(1, 1, 1), (3, 4, 5), (9, 7, 4), (16, 8, 11), (5, 0, 3), (0, 3, 2), (2, 6, 0)]
        {
            let number =
                |seed: usize| move |row: usize, column: usize| 1.0 / (1 + seed + 3 * row + 7 * column) as f64;
            let [a, b, c] = [(rows, terms), (terms, columns), (rows, columns)]
                .map(|(rows, columns)| DMatrix::from_fn(rows, columns, number(rows + 2 * columns)));
            let mut product = c.clone();
            subtract_product(&mut product.as_view_mut(), a.as_view(), b.as_view());
            assert!((&product + &a * &b - &c).amax() < 1e-14, "{rows} x {terms} x {columns}");
            let mut narrow = c;
            in_narrow_registers(|| subtract_product(&mut narrow.as_view_mut(), a.as_view(), b.as_view()));
            assert_eq!(narrow, product, "the same bits on every processor");
        }
    }

    #[test]
    fn a_column_without_a_pivot_has_a_zero_on_the_diagonal() {
        for empty in [0, 7, 20, 39] {
            let mut matrix = DMatrix::<f64>::identity(40, 40);
            matrix[(empty, empty)] = 0.0;
            factor_columns(matrix.as_view_mut(), 40, &mut [0; 40]);
            assert_eq!((0..40).find(|place| matrix[(*place, *place)] == 0.0), Some(empty));
        }
    }
}
