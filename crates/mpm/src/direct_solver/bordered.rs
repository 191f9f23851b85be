//! Matrices with a last row and column that are full: the unknown that every balance along a plate
//! feels, and the balance that feels them all.
//!
//! Numbered among the others it would fill the factors of all. As a border it costs one more
//! right-hand side: with `A w = c` the last unknown is `(g − rᵀ A⁻¹ f)/(d − rᵀ w)` (block elimination; Golub &
//! Van Loan 2013, section 3.2).

use crate::direct_solver::singular::Singular;
use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::time_limit::TimeLimit;

/// A matrix, with a border or without.
#[derive(Clone, Debug, PartialEq)]
pub struct Bordered {
    core: SystemMatrix,
    border: Option<Border>,
}

/// The last row and column.
#[derive(Clone, Debug, PartialEq)]
struct Border {
    row: Vec<f64>,
    column: Vec<f64>,
    corner: f64,
}

impl Bordered {
    /// Zeros at the places `(row, column)` that `visit` tells, with a border of one unknown behind those at
    /// `positions` or of none; `positions` as `[unknown][component]`, m.
    pub fn spanning<const D: usize>(
        positions: &[[f64; D]],
        border: usize,
        visit: impl Fn(&mut dyn FnMut(usize, usize)),
    ) -> Self {
        let count = positions.len();
        let core = SystemMatrix::spanning(positions, |visitor| {
            visit(&mut |row, column| {
                if row < count && column < count {
                    visitor(row, column);
                }
            });
        });
        let zeros = vec![0.0; count];
        let border = (border > 0).then(|| Border { row: zeros.clone(), column: zeros, corner: 0.0 });
        Self { core, border }
    }

    /// Adds to an entry, which must lie within the band or the border.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match &mut self.border {
            Some(border) if row == border.row.len() && column == row => border.corner += value,
            Some(border) if row == border.row.len() => border.row[column] += value,
            Some(border) if column == border.row.len() => border.column[row] += value,
            _ => self.core.add(row, column, value),
        }
    }

    /// Whether it is narrow enough to be kept by its diagonals.
    pub fn is_banded(&self) -> bool {
        matches!(self.core, SystemMatrix::Banded(_))
    }

    /// `rest ← rest − A values`.
    pub fn take_product(&self, values: &[f64], rest: &mut [f64]) {
        self.core.take_product(values, rest);
        if let Some(border) = &self.border {
            let size = border.row.len();
            for (rest, column) in rest.iter_mut().zip(&border.column) {
                *rest -= column * values[size];
            }
            rest[size] -= products(&border.row, &values[..size]) + border.corner * values[size];
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.core.clear();
        if let Some(border) = &mut self.border {
            border.row.fill(0.0);
            border.column.fill(0.0);
            border.corner = 0.0;
        }
    }
}

/// The factors of such a matrix.
#[derive(Clone, Debug)]
pub struct BorderedLu {
    core: Factors,
    border: Option<EliminatedBorder>,
}

/// What the elimination of the core leaves of a border.
#[derive(Clone, Debug)]
struct EliminatedBorder {
    row: Vec<f64>,
    /// `A⁻¹ c`.
    solved_column: Vec<f64>,
    /// `1/(d − rᵀ A⁻¹ c)`.
    per_corner: f64,
}

impl BorderedLu {
    /// Factors of the unit matrix, with room for those of matrices of a shape, made and used by so many threads where
    /// that pays.
    pub fn of_shape(shape: &Bordered, threads: usize) -> Self {
        let eliminated = |border: &Border| EliminatedBorder {
            row: vec![0.0; border.row.len()],
            solved_column: vec![0.0; border.column.len()],
            per_corner: 1.0,
        };
        Self { core: Factors::of_shape(&shape.core, threads), border: shape.border.as_ref().map(eliminated) }
    }

    /// The same that give a factorisation up at the end of a time, as if it had no pivot.
    #[must_use]
    pub fn within(mut self, time_limit: TimeLimit) -> Self {
        self.core.end_within(time_limit);
        self
    }

    /// Factors `fixed + factor · scaled`; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    pub fn factor_combination(
        &mut self,
        fixed: &Bordered,
        factor: f64,
        scaled: &Bordered,
    ) -> Result<(), Singular> {
        self.core.factor_combination(&fixed.core, factor, &scaled.core)?;
        let (Some(own), Some(fixed), Some(scaled)) = (&mut self.border, &fixed.border, &scaled.border) else {
            return Ok(());
        };
        combine(&mut own.row, &fixed.row, factor, &scaled.row);
        combine(&mut own.solved_column, &fixed.column, factor, &scaled.column);
        own.eliminate(&mut self.core, fixed.corner + factor * scaled.corner)
    }

    /// Factors a matrix; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    pub fn factor(&mut self, matrix: &Bordered) -> Result<(), Singular> {
        self.core.factor(&matrix.core)?;
        let (Some(own), Some(border)) = (&mut self.border, &matrix.border) else { return Ok(()) };
        own.row.copy_from_slice(&border.row);
        own.solved_column.copy_from_slice(&border.column);
        own.eliminate(&mut self.core, border.corner)
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        let Some(border) = &self.border else { return self.core.solve(values) };
        let (core, last) = values.split_at_mut(border.row.len());
        self.core.solve(core);
        for last in last {
            *last = (*last - products(&border.row, core)) * border.per_corner;
            for (value, column) in core.iter_mut().zip(&border.solved_column) {
                *value -= column * *last;
            }
        }
    }
}

impl EliminatedBorder {
    /// Takes a column and a corner through the factors of the core.
    fn eliminate(&mut self, core: &mut Factors, corner: f64) -> Result<(), Singular> {
        core.solve(&mut self.solved_column);
        let left = corner - products(&self.row, &self.solved_column);
        if left == 0.0 || !left.is_finite() {
            return Err(Singular { row: self.row.len() });
        }
        self.per_corner = 1.0 / left;
        Ok(())
    }
}

fn combine(sum: &mut [f64], fixed: &[f64], factor: f64, scaled: &[f64]) {
    for ((sum, fixed), scaled) in sum.iter_mut().zip(fixed).zip(scaled) {
        *sum = fixed + factor * scaled;
    }
}

fn products(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn a_border_is_solved_as_the_dense_matrix_is() {
        let size = 9;
        let entry = |row: usize, column: usize| ((row * 7 + column * 13) % 11) as f64 - 4.5;
        let held = |row: usize, column: usize| row.abs_diff(column) <= 1 || row == size || column == size;
        let places = || (0..=size).flat_map(|row| (0..=size).map(move |column| (row, column)));
        let mut matrix = Bordered::spanning(&vec![[0.0]; size], 1, |visitor| {
            places()
                .filter(|(row, column)| held(*row, *column))
                .for_each(|(row, column)| visitor(row, column));
        });
        let mut dense = DMatrix::zeros(size + 1, size + 1);
        for (row, column) in places().filter(|(row, column)| held(*row, *column)) {
            matrix.add(row, column, entry(row, column));
            dense[(row, column)] = entry(row, column);
        }
        let right = DVector::from_fn(size + 1, |row, _| row as f64 - 3.0);
        let mut lu = BorderedLu::of_shape(&matrix, 1);
        let mut halves = matrix.clone();
        halves.clear();
        for combined in [false, true] {
            let factored =
                if combined { lu.factor_combination(&halves, 1.0, &matrix) } else { lu.factor(&matrix) };
            assert_eq!(factored, Ok(()));
            let mut solution = right.as_slice().to_vec();
            lu.solve(&mut solution);
            let residual = &dense * DVector::from_vec(solution) - &right;
            assert!(residual.amax() < 1e-11, "{}", residual.amax());
            let (values, mut rest) = ([0.5; 10], [0.0; 10]);
            matrix.take_product(&values, &mut rest);
            let product = &dense * DVector::from_row_slice(&values) + DVector::from_row_slice(&rest);
            assert!(product.amax() < 1e-12, "{}", product.amax());
        }
        let core_only = Bordered::spanning(&[[0.0]], 1, |visitor| visitor(0, 0));
        assert!(BorderedLu::of_shape(&core_only, 1).factor(&core_only).is_err());
    }
}
