//! Dense partial factorisation of a front: LU with pivots among its first rows, the rest updated.

use crate::mpm::wide::wide;

/// Columns that are factored before the rest is updated by them at once.
const PANEL: usize = 32;
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
            self.factor_panel(start, end, pivots)?;
            self.solve_panel_rows(start, end);
            self.update_rest(start, end);
            start = end;
        }
        Ok(())
    }

    /// LU of the panel's columns in all rows.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn factor_panel(&mut self, start: usize, end: usize, pivots: &mut [usize]) -> Result<(), usize> {
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
            let (above, below) = self.entries.split_at_mut((column + 1) * size);
            let pivot_row = &above[column * size..][column..end];
            let per_pivot = 1.0 / pivot_row[0];
            for row in below.chunks_exact_mut(size) {
                let row = &mut row[column..end];
                let multiplier = row[0] * per_pivot;
                row[0] = multiplier;
                if multiplier != 0.0 {
                    for (entry, above) in row[1..].iter_mut().zip(&pivot_row[1..]) {
                        *entry -= multiplier * above;
                    }
                }
            }
        }
        Ok(())
    }

    /// `U ← L⁻¹ U` in the panel's rows.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn solve_panel_rows(&mut self, start: usize, end: usize) {
        let size = self.size;
        for row in start + 1..end {
            let (above, below) = self.entries.split_at_mut(row * size);
            let (left, right) = below[..size].split_at_mut(end);
            for other in start..row {
                let multiplier = left[other];
                if multiplier != 0.0 {
                    let source = &above[other * size + end..][..size - end];
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
            for i in 0..TILE_ROWS {
                let (left, right) = block[i * size..][..size].split_at_mut(tiled);
                take_products(&left[start..end], &above[start * size..], size, tiled, right);
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
