//! Banded LU factorisation without pivoting, for systems whose symmetric part is positive.
//!
//! Without pivoting the band keeps its width; the growth of the factors is bounded where the
//! symmetric part is positive definite (Golub & Van Loan 2013, section 4.1.4), and refinement with
//! a look at the residual says where it was not.

/// A banded matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct BandedMatrix {
    size: usize,
    /// Most columns that a row reaches to either side of its own.
    reach: usize,
    /// `2 reach + 1` numbers a row.
    rows: Vec<f64>,
}

/// `L U` of a banded matrix, with the matrix itself for refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct BandedFactors {
    matrix: BandedMatrix,
    factors: BandedMatrix,
}

/// Why a system has no solution.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the system of equations is singular in row {row} of {size}")]
pub struct SingularMatrix {
    /// Row of the pivot that vanished.
    pub row: usize,
    /// Rows there are.
    pub size: usize,
}

/// Rounds of iterative refinement.
const REFINEMENTS: usize = 2;
/// Pivot rows that are eliminated together: their updates pass over each later row once.
const BLOCK: usize = 4;

impl BandedMatrix {
    /// A zero matrix of `size` rows that reach `reach` columns to either side.
    pub fn zero(size: usize, reach: usize) -> Self {
        Self { size, reach, rows: vec![0.0; size * (2 * reach + 1)] }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Adds to an entry, which must lie in the band.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let width = 2 * self.reach + 1;
        self.rows[row * width + column + self.reach - row] += value;
    }

    fn get(&self, row: usize, column: usize) -> f64 {
        self.rows[row * (2 * self.reach + 1) + column + self.reach - row]
    }

    /// `b − A x`.
    pub fn residual(&self, right: &[f64], solution: &[f64]) -> Vec<f64> {
        let width = 2 * self.reach + 1;
        (0..self.size)
            .map(|row| {
                let first = row.saturating_sub(self.reach);
                let end = (row + self.reach + 1).min(self.size);
                let start = row * width + first + self.reach - row;
                let entries = &self.rows[start..start + end - first];
                let product: f64 = entries.iter().zip(&solution[first..end]).map(|(a, x)| a * x).sum();
                right[row] - product
            })
            .collect()
    }

    /// Factorises.
    ///
    /// # Errors
    /// When a pivot vanishes or is not finite.
    pub fn factorised(self) -> Result<BandedFactors, SingularMatrix> {
        let mut factors = self.clone();
        let (size, reach, width) = (self.size, self.reach, 2 * self.reach + 1);
        let mut first = 0;
        while first < size {
            let block = BLOCK.min(size - first);
            // The block's own rows, one after another.
            for pivot in first..first + block {
                let value = factors.get(pivot, pivot);
                if value == 0.0 || !value.is_finite() {
                    return Err(SingularMatrix { row: pivot, size });
                }
                for row in pivot + 1..(first + block).min(pivot + reach + 1) {
                    factors.eliminate(pivot, row);
                }
            }
            let last = first + block - 1;
            for row in last + 1..(last + reach + 1).min(size) {
                factors.eliminate_block(first, block, row, width);
            }
            first += block;
        }
        Ok(BandedFactors { matrix: self, factors })
    }

    /// Subtracts a multiple of a pivot's row from a later one and keeps the multiple.
    fn eliminate(&mut self, pivot: usize, row: usize) {
        let (reach, width) = (self.reach, 2 * self.reach + 1);
        let factor = self.get(row, pivot) / self.get(pivot, pivot);
        let end = (pivot + reach + 1).min(self.size);
        let (above, below) = self.rows.split_at_mut(row * width);
        let source = &above[pivot * width + reach + 1..pivot * width + end + reach - pivot];
        let start = pivot + reach - row;
        below[start] = factor;
        if factor != 0.0 {
            for (target, value) in below[start + 1..].iter_mut().zip(source) {
                *target -= factor * value;
            }
        }
    }

    /// The same with a block of pivot rows at once.
    fn eliminate_block(&mut self, first: usize, block: usize, row: usize, width: usize) {
        let reach = self.reach;
        let full = block == BLOCK && row <= first + reach && first + BLOCK + reach <= self.size;
        if !full {
            for pivot in first..first + block {
                if row <= pivot + reach {
                    self.eliminate(pivot, row);
                }
            }
            return;
        }
        let (above, below) = self.rows.split_at_mut(row * width);
        let pivot_row = |k: usize| &above[(first + k) * width..(first + k + 1) * width];
        let (a, b, c, d) = (pivot_row(0), pivot_row(1), pivot_row(2), pivot_row(3));
        let start = first + reach - row;
        let target = &mut below[start..start + reach + BLOCK];
        // Multipliers by forward substitution within the block.
        let m0 = target[0] / a[reach];
        let m1 = (target[1] - m0 * a[reach + 1]) / b[reach];
        let m2 = (target[2] - m0 * a[reach + 2] - m1 * b[reach + 1]) / c[reach];
        let m3 = (target[3] - m0 * a[reach + 3] - m1 * b[reach + 2] - m2 * c[reach + 1]) / d[reach];
        target[..BLOCK].copy_from_slice(&[m0, m1, m2, m3]);
        if [m0, m1, m2, m3] == [0.0; BLOCK] {
            return;
        }
        // Columns that all four pivot rows reach, then the tails of the later three.
        let inner = reach - (BLOCK - 1);
        let (shared, tail) = target[BLOCK..].split_at_mut(inner);
        let (a, b) = (&a[reach + 4..reach + 4 + inner], &b[reach + 3..]);
        let (c, d) = (&c[reach + 2..], &d[reach + 1..]);
        for (k, value) in shared.iter_mut().enumerate() {
            *value -= m0 * a[k] + m1 * b[k] + m2 * c[k] + m3 * d[k];
        }
        tail[0] -= m1 * b[inner] + m2 * c[inner] + m3 * d[inner];
        tail[1] -= m2 * c[inner + 1] + m3 * d[inner + 1];
        tail[2] -= m3 * d[inner + 2];
    }
}

impl BandedFactors {
    /// Solves `A x = b`, with refinement.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut solution = self.substituted(right.to_vec());
        for _ in 0..REFINEMENTS {
            let correction = self.substituted(self.matrix.residual(right, &solution));
            for (value, change) in solution.iter_mut().zip(correction) {
                *value += change;
            }
        }
        solution
    }

    /// Largest entry of `b − A x` over that of `b`.
    pub fn relative_residual(&self, right: &[f64], solution: &[f64]) -> f64 {
        let largest = |field: &[f64]| field.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        largest(&self.matrix.residual(right, solution)) / largest(right)
    }

    fn substituted(&self, mut right: Vec<f64>) -> Vec<f64> {
        let (size, reach, width) = (self.factors.size, self.factors.reach, 2 * self.factors.reach + 1);
        let row_of = |row: usize| &self.factors.rows[row * width..(row + 1) * width];
        for row in 0..size {
            let first = row.saturating_sub(reach);
            let factors = &row_of(row)[first + reach - row..reach];
            let known: f64 = factors.iter().zip(&right[first..row]).map(|(l, x)| l * x).sum();
            right[row] -= known;
        }
        for row in (0..size).rev() {
            let end = (row + reach + 1).min(size);
            let factors = row_of(row);
            let above = &factors[reach + 1..end + reach - row];
            let known: f64 = above.iter().zip(&right[row + 1..end]).map(|(u, x)| u * x).sum();
            right[row] = (right[row] - known) / factors[reach];
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_system_is_solved_whatever_its_band(size in 1..40_usize, reach in 0..9_usize, seed in 0..1000_u32) {
            // Pseudo-random entries with a positive symmetric part.
            let entry = |i: usize, j: usize| {
                let mix = (i * 7919 + j * 104_729 + seed as usize * 31) % 1000;
                mix as f64 / 1000.0 - 0.5
            };
            let mut matrix = BandedMatrix::zero(size, reach);
            for i in 0..size {
                for j in i.saturating_sub(reach)..(i + reach + 1).min(size) {
                    let dominant = if i == j { 2.0 * reach as f64 + 1.0 } else { 0.0 };
                    matrix.add(i, j, entry(i, j) + dominant);
                }
            }
            let exact: Vec<f64> = (0..size).map(|i| 1.0 + (i % 7) as f64).collect();
            let right: Vec<f64> = matrix.residual(&vec![0.0; size], &exact).iter().map(|x| -x).collect();
            let factors = matrix.factorised().expect("not singular");
            let found = factors.solve(&right);
            for (found, exact) in found.iter().zip(&exact) {
                prop_assert!((found - exact).abs() < 1e-12 * exact.abs().max(1.0));
            }
            prop_assert!(factors.relative_residual(&right, &found) < 1e-14);
        }
    }

    #[test]
    fn a_singular_matrix_names_its_row() {
        let mut matrix = BandedMatrix::zero(3, 1);
        matrix.add(0, 0, 1.0);
        matrix.add(2, 2, 1.0);
        assert_eq!(matrix.factorised(), Err(SingularMatrix { row: 1, size: 3 }));
    }
}
