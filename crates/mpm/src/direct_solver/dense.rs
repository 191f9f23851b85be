//! LU factorisation of dense blocks in place, by halves (Toledo 1997): nearly all of the work is products of matrices, and
//! those have the same bits on every processor, without fused operations.

#![expect(
    clippy::inline_always,
    reason = "what `wide!` compiles for wider registers must be inlined into it"
)]

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
                let (own, rest) = column.as_mut_slice()[place..].split_at_mut(1);
                subtract_columns(rest, [&*factors], [own[0]]);
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
                subtract_columns(rest, [&column.as_slice()[place + 1..]], [done[place]]);
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
                tile.fill(0.0);
                tile[..rows.len()].copy_from_slice(&a.column(term).as_slice()[rows.clone()]);
            }
            let whole = c.ncols() - c.ncols() % COLUMNS;
            for first in (0..whole).step_by(COLUMNS) {
                subtract_tile::<COLUMNS>(c, panel, &b, (rows.clone(), terms.start, first));
            }
            for first in whole..c.ncols() {
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

/// Columns of a triangle that a substitution takes together.
const SWEEP: usize = 4;

/// `rest ← rest − Σ x_k column_k`, columns at least as long as the rest.
#[inline(always)]
fn subtract_columns<const N: usize>(rest: &mut [f64], columns: [&[f64]; N], factors: [f64; N]) {
    let columns = columns.map(|column| &column[..rest.len()]);
    for (row, value) in rest.iter_mut().enumerate() {
        let mut sum = columns[0][row] * factors[0];
        for n in 1..N {
            sum += columns[n][row] * factors[n];
        }
        *value -= sum;
    }
}

/// Columns of a column-major block with so many rows, `N` of them from one on.
#[inline(always)]
fn columns_of<const N: usize>(block: &[f64], rows: usize, first: usize) -> [&[f64]; N] {
    array::from_fn(|n| &block[(first + n) * rows..][..rows])
}

/// Replaces the first values, as many as columns, by `L⁻¹` of them, and takes from those below what they are tied to: `L` is
/// the part of a tall block below its diagonal, which is one. One sweep over the block.
pub(crate) fn sweep_down(block: &[f64], values: &mut [f64], columns: usize) {
    wide!({
        let whole = columns - columns % SWEEP;
        for first in (0..whole).step_by(SWEEP) {
            sweep_down_columns::<SWEEP>(block, values, first);
        }
        for first in whole..columns {
            sweep_down_columns::<1>(block, values, first);
        }
    });
}

#[inline(always)]
fn sweep_down_columns<const N: usize>(block: &[f64], values: &mut [f64], first: usize) {
    let columns = columns_of::<N>(block, values.len(), first);
    let (done, rest) = values.split_at_mut(first + N);
    let own = &mut done[first..];
    for n in 1..N {
        for k in 0..n {
            own[n] -= columns[k][first + n] * own[k];
        }
    }
    subtract_columns(rest, columns.map(|column| &column[first + N..]), array::from_fn(|n| own[n]));
}

/// `own ← own − B later`, `B` with a row for each of its own values.
pub(crate) fn subtract_image(block: &[f64], later: &[f64], own: &mut [f64]) {
    wide!({
        let rows = own.len();
        let whole = later.len() - later.len() % SWEEP;
        for first in (0..whole).step_by(SWEEP) {
            let columns = columns_of::<SWEEP>(block, rows, first);
            subtract_columns(own, columns, array::from_fn(|n| later[first + n]));
        }
        for first in whole..later.len() {
            subtract_columns(own, columns_of::<1>(block, rows, first), [later[first]]);
        }
    });
}

/// Replaces values by `U⁻¹` of them: `U` is the part of a block with so many rows on its diagonal and above it.
pub(crate) fn sweep_up(block: &[f64], rows: usize, values: &mut [f64]) {
    wide!({
        let mut end = values.len();
        while end >= SWEEP {
            sweep_up_columns::<SWEEP>(block, rows, &mut values[..end]);
            end -= SWEEP;
        }
        while end > 0 {
            sweep_up_columns::<1>(block, rows, &mut values[..end]);
            end -= 1;
        }
    });
}

#[inline(always)]
fn sweep_up_columns<const N: usize>(block: &[f64], rows: usize, values: &mut [f64]) {
    let first = values.len() - N;
    let columns = columns_of::<N>(block, rows, first);
    let (rest, own) = values.split_at_mut(first);
    for n in (0..N).rev() {
        own[n] /= columns[n][first + n];
        for k in 0..n {
            own[k] -= columns[n][first + k] * own[n];
        }
    }
    subtract_columns(rest, columns, array::from_fn(|n| own[n]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::in_narrow_registers;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;
    use std::ops::AddAssign;

    proptest! {
        #[test]
        fn factors_multiply_to_the_matrix_with_its_rows_swapped(
            columns in 1..70usize, own_below in 0..5usize, below in 0..40usize, seed in 1..1_000_000_u32,
        ) {
            let (pivot_rows, rows) = (columns + own_below, columns + own_below + below);
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
            // Of a vector `L⁻¹` below, `U⁻¹` above, in wide registers as in narrow ones.
            let start: Vec<f64> = (0..rows).map(|row| (1.7 * row as f64).sin()).collect();
            let mut values = start.clone();
            sweep_down(factors.as_slice(), &mut values, columns);
            let mut narrow = start.clone();
            in_narrow_registers(|| sweep_down(factors.as_slice(), &mut narrow, columns));
            prop_assert_eq!(&narrow, &values);
            let own = DVector::from_column_slice(&values[..columns]);
            let mut whole = &lower * &own;
            whole.rows_mut(columns, below + own_below).add_assign(&DVector::from_column_slice(&values[columns..]));
            prop_assert!((whole - DVector::from_vec(start)).amax() < 1e-9 * own.amax().max(1.0));
            let scale = upper.diagonal().map(f64::abs).min();
            prop_assume!(scale > 1e-3);
            let mut solved = own.as_slice().to_vec();
            sweep_up(factors.as_slice(), rows, &mut solved);
            let solved = DVector::from_vec(solved);
            prop_assert!((&upper * &solved - &own).amax() < 1e-9 * solved.amax().max(1.0));
            let mut image = own.as_slice().to_vec();
            subtract_image(upper.as_slice(), solved.as_slice(), &mut image);
            prop_assert!(DVector::from_vec(image).amax() < 1e-9 * solved.amax().max(1.0));
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
            let mut found = c.clone();
            subtract_product(&mut found.as_view_mut(), a.as_view(), b.as_view());
            assert!((&found + &a * &b - &c).amax() < 1e-14, "{rows} x {terms} x {columns}");
            let mut narrow = c;
            in_narrow_registers(|| subtract_product(&mut narrow.as_view_mut(), a.as_view(), b.as_view()));
            assert_eq!(narrow, found, "the same bits on every processor");
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
