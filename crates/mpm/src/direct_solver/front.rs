//! Dense partial factorisation of a front: LU with pivots among its first rows, the rest updated.

use crate::wide::wide;

/// Columns that are factored before the rest is updated by them at once.
const PANEL: usize = 32;
/// Columns of a panel that are factored before its others are.
const STRIP: usize = 8;
/// Rows behind the pivots that go through a panel side by side.
const ROWS_BEHIND: usize = 16;
/// Rows of the blocks whose sums stay in registers.
const TILE_ROWS: usize = 4;
/// Their columns: eight chains of additions in registers of four hide the time that each takes; what is left over is
/// taken by half as many.
const TILE_COLUMNS: usize = 8;
const HALF_TILE: usize = TILE_COLUMNS / 2;

/// Rows of a panel by tiles of columns, `[tile][row][column]`: what the inner loop reads lies side by side.
#[derive(Clone, Debug)]
pub struct Panel(Vec<f64>);

impl Panel {
    /// Room for the panels of fronts of up to `size` rows.
    pub fn for_fronts_of(size: usize) -> Self {
        Self(Vec::with_capacity(PANEL * size))
    }
}

/// A dense square matrix of which some first unknowns are eliminated.
pub struct Front<'a> {
    /// Its entries, `[row][column]`.
    pub entries: &'a mut [f64],
    /// Rows.
    pub size: usize,
    /// Room for a panel.
    pub panel: &'a mut Panel,
}

impl Front<'_> {
    /// Eliminates as many first unknowns as there are `pivots`, each with the largest pivot among their rows,
    /// and notes the row that took each one's place; behind them is left their Schur complement.
    ///
    /// # Errors
    /// The column without a pivot.
    pub fn eliminate(&mut self, pivots: &mut [usize]) -> Result<(), usize> {
        wide!(self.eliminate_panels(pivots))
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn eliminate_panels(&mut self, pivots: &mut [usize]) -> Result<(), usize> {
        let (mut start, count) = (0, pivots.len());
        while start < count {
            let end = (start + PANEL).min(count);
            let mut per_pivot = [0.0; PANEL];
            for strip in (start..end).step_by(STRIP) {
                let strip_end = (strip + STRIP).min(end);
                self.factor_strip(strip, strip_end, pivots, &mut per_pivot[strip - start..])?;
                self.solve_rows(strip, strip_end, end);
                self.update_columns(strip, strip_end, end, count);
            }
            self.divide_rows_behind(start, end, count, &per_pivot);
            self.solve_rows(start, end, self.size);
            self.update_rest(start, end);
            start = end;
        }
        Ok(())
    }

    /// LU of a strip's columns in the rows that are eliminated; one over each pivot.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn factor_strip(
        &mut self,
        start: usize,
        end: usize,
        pivots: &mut [usize],
        per_pivot: &mut [f64],
    ) -> Result<(), usize> {
        let size = self.size;
        for column in start..end {
            let mut pivot = column;
            let mut largest = self.entries[column * size + column].abs();
            for row in column + 1..pivots.len() {
                let value = self.entries[row * size + column].abs();
                if value > largest {
                    (pivot, largest) = (row, value);
                }
            }
            if largest == 0.0 || !largest.is_finite() {
                return Err(column);
            }
            pivots[column] = pivot;
            if pivot != column {
                let (above, below) = self.entries.split_at_mut(pivot * size);
                above[column * size..][..size].swap_with_slice(&mut below[..size]);
            }
            let (above, below) = self.entries[..pivots.len() * size].split_at_mut((column + 1) * size);
            let pivot_row = &above[column * size..][column..end];
            per_pivot[column - start] = 1.0 / pivot_row[0];
            for row in below.chunks_exact_mut(size) {
                let row = &mut row[column..end];
                let multiplier = row[0] * per_pivot[column - start];
                row[0] = multiplier;
                for (entry, above) in row[1..].iter_mut().zip(&pivot_row[1..]) {
                    *entry -= multiplier * above;
                }
            }
        }
        Ok(())
    }

    /// Takes a strip's product from the columns behind it, up to `columns`, in the rows behind it, up to `rows`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn update_columns(&mut self, start: usize, end: usize, columns: usize, rows: usize) {
        let size = self.size;
        let (above, below) = self.entries[..rows * size].split_at_mut(end * size);
        let whole = end + (columns - end) / STRIP * STRIP;
        for row in below.chunks_exact_mut(size) {
            let (left, right) = row.split_at_mut(end);
            for column in (end..whole).step_by(STRIP) {
                let tile = &mut right[column - end..][..STRIP];
                let mut sums = [0.0; STRIP];
                sums.copy_from_slice(tile);
                for (multiplier, above) in left[start..].iter().zip(above[start * size..].chunks_exact(size))
                {
                    let above = &above[column..][..STRIP];
                    for j in 0..STRIP {
                        sums[j] -= multiplier * above[j];
                    }
                }
                tile.copy_from_slice(&sums);
            }
            take_products(
                &left[start..],
                &above[start * size..],
                size,
                whole,
                &mut right[whole - end..columns - end],
            );
        }
    }

    /// `L ← L U⁻¹` of a panel in the rows behind those that are eliminated, whose numbers no pivot is chosen from.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn divide_rows_behind(&mut self, start: usize, end: usize, count: usize, per_pivot: &[f64; PANEL]) {
        let size = self.size;
        let (above, below) = self.entries.split_at_mut(count * size);
        // Columns of `U`: what an inner loop reads lies side by side.
        let mut upper = [[0.0; PANEL]; PANEL];
        for (row, entries) in above.chunks_exact(size).skip(start).take(end - start).enumerate() {
            for (column, entry) in entries[start..end].iter().enumerate() {
                upper[column][row] = *entry;
            }
        }
        let upper = &upper[..end - start];
        let mut blocks = below.chunks_exact_mut(ROWS_BEHIND * size);
        for block in &mut blocks {
            divide_rows::<ROWS_BEHIND>(upper, per_pivot, &mut block[start..], size);
        }
        let mut blocks = blocks.into_remainder().chunks_exact_mut(TILE_ROWS * size);
        for block in &mut blocks {
            divide_rows::<TILE_ROWS>(upper, per_pivot, &mut block[start..], size);
        }
        for row in blocks.into_remainder().chunks_exact_mut(size) {
            divide_rows::<1>(upper, per_pivot, &mut row[start..], size);
        }
    }

    /// `U ← L⁻¹ U` in some rows and the columns behind them, up to `columns`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn solve_rows(&mut self, start: usize, end: usize, columns: usize) {
        let size = self.size;
        for row in start + 1..end {
            let (above, below) = self.entries.split_at_mut(row * size);
            let (left, right) = below[..columns].split_at_mut(end);
            for other in start..row {
                let multiplier = left[other];
                if multiplier != 0.0 {
                    let source = &above[other * size + end..][..columns - end];
                    for (entry, above) in right.iter_mut().zip(source) {
                        *entry -= multiplier * above;
                    }
                }
            }
        }
    }

    /// Takes the panel's product from the rows and columns behind it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn update_rest(&mut self, start: usize, end: usize) {
        let (size, depth) = (self.size, end - start);
        let columns = size - end;
        let (tiles, has_half) = (columns / TILE_COLUMNS, columns % TILE_COLUMNS >= HALF_TILE);
        let whole = end + tiles * TILE_COLUMNS;
        let tiled = whole + if has_half { HALF_TILE } else { 0 };
        let packed = &mut self.panel.0;
        packed.clear();
        for tile in 0..tiles {
            for k in start..end {
                let first = k * size + end + tile * TILE_COLUMNS;
                packed.extend_from_slice(&self.entries[first..][..TILE_COLUMNS]);
            }
        }
        for k in (start..end).filter(|_| has_half) {
            packed.extend_from_slice(&self.entries[k * size + whole..][..HALF_TILE]);
        }
        let (above, below) = self.entries.split_at_mut(end * size);
        let mut blocks = below.chunks_exact_mut(TILE_ROWS * size);
        let mut multipliers = [[0.0; TILE_ROWS]; PANEL];
        for block in &mut blocks {
            for k in 0..depth {
                for i in 0..TILE_ROWS {
                    multipliers[k][i] = block[i * size + start + k];
                }
            }
            let mut panels = packed.chunks(depth * TILE_COLUMNS);
            for (tile, panel) in panels.by_ref().take(tiles).enumerate() {
                let column = end + tile * TILE_COLUMNS;
                take_tile::<TILE_COLUMNS>(&multipliers[..depth], panel, &mut block[column..], size);
            }
            for panel in panels {
                take_tile::<HALF_TILE>(&multipliers[..depth], panel, &mut block[whole..], size);
            }
            for column in tiled..size {
                let mut sums = [0.0; TILE_ROWS];
                for (i, sum) in sums.iter_mut().enumerate() {
                    *sum = block[i * size + column];
                }
                for (k, l) in multipliers[..depth].iter().enumerate() {
                    let above = above[(start + k) * size + column];
                    for i in 0..TILE_ROWS {
                        sums[i] -= l[i] * above;
                    }
                }
                for (i, sum) in sums.iter().enumerate() {
                    block[i * size + column] = *sum;
                }
            }
        }
        for row in blocks.into_remainder().chunks_exact_mut(size) {
            let (left, right) = row.split_at_mut(end);
            take_products(&left[start..end], &above[start * size..], size, end, right);
        }
    }
}

/// Takes `Σ_k l_k u_k` from a tile of so many columns at the start of each of its rows, `size` apart.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn take_tile<const COLUMNS: usize>(
    multipliers: &[[f64; TILE_ROWS]],
    panel: &[f64],
    rows: &mut [f64],
    size: usize,
) {
    let mut sums = [[0.0; COLUMNS]; TILE_ROWS];
    for (l, u) in multipliers.iter().zip(panel.chunks_exact(COLUMNS)) {
        for i in 0..TILE_ROWS {
            for j in 0..COLUMNS {
                sums[i][j] += l[i] * u[j];
            }
        }
    }
    for (i, sums) in sums.iter().enumerate() {
        for (entry, sum) in rows[i * size..][..COLUMNS].iter_mut().zip(sums) {
            *entry -= sum;
        }
    }
}

/// Divides rows, `size` apart, by `U` given by columns: each entry by those to its left in turn, then by its pivot.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn divide_rows<const ROWS: usize>(
    upper: &[[f64; PANEL]],
    per_pivot: &[f64; PANEL],
    rows: &mut [f64],
    size: usize,
) {
    let mut quotients = [[0.0; ROWS]; PANEL];
    for (column, upper) in upper.iter().enumerate() {
        let mut rest = [0.0; ROWS];
        for (i, rest) in rest.iter_mut().enumerate() {
            *rest = rows[i * size + column];
        }
        for (quotient, upper) in quotients[..column].iter().zip(upper) {
            for i in 0..ROWS {
                rest[i] -= quotient[i] * upper;
            }
        }
        for (i, rest) in rest.iter().enumerate() {
            quotients[column][i] = rest * per_pivot[column];
            rows[i * size + column] = quotients[column][i];
        }
    }
}

/// Takes multiples of the panel's rows from a row's end.
#[inline(always)]
#[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
fn take_products(multipliers: &[f64], panel: &[f64], size: usize, from: usize, row: &mut [f64]) {
    for (k, multiplier) in multipliers.iter().enumerate() {
        for (entry, above) in row.iter_mut().zip(&panel[k * size + from..]) {
            *entry -= multiplier * above;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_left_is_the_schur_complement(size in 1..90usize, share in 1..=8usize, seed in 0..1000u32) {
            let count = (share * size).div_ceil(8);
            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 23) - 1.0
            };
            let dense = DMatrix::from_fn(size, size, |row, column| {
                random() + if row == column { 4.0 } else { 0.0 }
            });
            let mut entries: Vec<f64> = dense.transpose().as_slice().to_vec();
            let mut pivots = vec![0; count];
            let mut panel = Panel::for_fronts_of(size);
            let eliminated = Front { entries: &mut entries, size, panel: &mut panel }.eliminate(&mut pivots);
            prop_assert_eq!(eliminated, Ok(()));
            let behind = size - count;
            let first = dense.view((0, 0), (count, count)).into_owned();
            prop_assume!(first.clone().svd(false, false).singular_values.min() > 1e-3);
            let right = dense.view((0, count), (count, behind)).into_owned();
            let solved = first.lu().solve(&right).expect("a pivot was found");
            let schur = dense.view((count, count), (behind, behind))
                - dense.view((count, 0), (behind, count)) * solved;
            for row in 0..behind {
                for column in 0..behind {
                    let left = entries[(count + row) * size + count + column];
                    prop_assert!((left - schur[(row, column)]).abs() < 1e-9, "{row} {column}");
                }
            }
        }
    }

    #[test]
    fn a_column_without_a_pivot_is_named() {
        let mut entries = [1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 0.0, 0.0, 1.0];
        let mut panel = Panel::for_fronts_of(3);
        let mut pivots = [0; 2];
        let eliminated = Front { entries: &mut entries, size: 3, panel: &mut panel }.eliminate(&mut pivots);
        assert_eq!(eliminated, Err(1));
    }
}
