//! The matrix of a linear system and its factors, each in the form that suits its band, with an optional border.
//!
//! The border is a full last row and column: the displacement of a rigid plate, which every balance along the plate
//! contains, and the plate's own balance. Numbered among the others it would fill the factors of all. As a border it
//! costs one more right-hand side: with `A w = c` the last unknown is `(g − rᵀ A⁻¹ f)/(d − rᵀ w)` (block elimination;
//! Golub & Van Loan 2013, section 3.2).

use crate::direct_solver::banded::{Banded, BandedLu};
use crate::direct_solver::frontal::FrontalLu;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::direct_solver::{Singular, dot};
use crate::time_limit::TimeLimit;

/// Diagonals of a band beyond which a sparse factorisation is faster.
const WIDEST_BAND: usize = 200;

/// A square matrix with a fixed pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemMatrix {
    core: Core,
    border: Option<Border>,
}

/// The matrix without its border.
#[derive(Clone, Debug, PartialEq)]
enum Core {
    Banded(Banded),
    Sparse(SparseMatrix),
}

/// The last row and column; among the factors `r`, `A⁻¹ c` and `1/(d − rᵀ A⁻¹ c)`.
#[derive(Clone, Debug, PartialEq)]
struct Border {
    row: Vec<f64>,
    column: Vec<f64>,
    corner: f64,
}

impl SystemMatrix {
    /// Zeros at the places `(row, column)` that `visit` lists, with a border of one unknown after those at `positions`
    /// (`[unknown][component]`, m) or without.
    pub fn spanning<const D: usize>(
        positions: &[[f64; D]],
        border: usize,
        visit: impl Fn(&mut dyn FnMut(usize, usize)),
    ) -> Self {
        let count = positions.len();
        let visit_core = |visitor: &mut dyn FnMut(usize, usize)| {
            visit(&mut |row, column| {
                if row < count && column < count {
                    visitor(row, column);
                }
            });
        };
        let (mut lower, mut upper) = (0, 0);
        visit_core(&mut |row, column| {
            lower = lower.max(row.saturating_sub(column));
            upper = upper.max(column.saturating_sub(row));
        });
        let core = if lower + upper <= WIDEST_BAND {
            Core::Banded(Banded::zeros(count, lower, upper))
        } else {
            Core::Sparse(SparseMatrix::spanning(positions, visit_core))
        };
        let zeros = vec![0.0; count];
        let border = (border > 0).then(|| Border { row: zeros.clone(), column: zeros, corner: 0.0 });
        Self { core, border }
    }

    /// Adds to an entry, which must be one of the places.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match &mut self.border {
            Some(border) if row == border.row.len() && column == row => border.corner += value,
            Some(border) if row == border.row.len() => border.row[column] += value,
            Some(border) if column == border.row.len() => border.column[row] += value,
            _ => match &mut self.core {
                Core::Banded(matrix) => matrix.add(row, column, value),
                Core::Sparse(matrix) => matrix.add(row, column, value),
            },
        }
    }

    fn entries_mut(&mut self) -> &mut [f64] {
        match &mut self.core {
            Core::Banded(matrix) => matrix.entries_mut(),
            Core::Sparse(matrix) => matrix.entries_mut(),
        }
    }

    fn entries(&self) -> &[f64] {
        match &self.core {
            Core::Banded(matrix) => matrix.entries(),
            Core::Sparse(matrix) => matrix.entries(),
        }
    }

    /// `self ← fixed + factor · scaled`, all of one pattern.
    pub fn set_combination(&mut self, fixed: &Self, factor: f64, scaled: &Self) {
        let combine = |sum: &mut [f64], fixed: &[f64], scaled: &[f64]| {
            for ((sum, fixed), scaled) in sum.iter_mut().zip(fixed).zip(scaled) {
                *sum = fixed + factor * scaled;
            }
        };
        combine(self.entries_mut(), fixed.entries(), scaled.entries());
        if let (Some(sum), Some(fixed), Some(scaled)) = (&mut self.border, &fixed.border, &scaled.border) {
            combine(&mut sum.row, &fixed.row, &scaled.row);
            combine(&mut sum.column, &fixed.column, &scaled.column);
            sum.corner = fixed.corner + factor * scaled.corner;
        }
    }

    /// `rest ← rest − A values`.
    pub fn subtract_product(&self, values: &[f64], rest: &mut [f64]) {
        match &self.core {
            Core::Banded(matrix) => matrix.subtract_product(values, rest),
            Core::Sparse(matrix) => matrix.subtract_product(values, rest),
        }
        if let Some(border) = &self.border {
            let size = border.row.len();
            for (rest, column) in rest.iter_mut().zip(&border.column) {
                *rest -= column * values[size];
            }
            rest[size] -= dot(&border.row, &values[..size]) + border.corner * values[size];
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.entries_mut().fill(0.0);
        if let Some(border) = &mut self.border {
            border.row.fill(0.0);
            border.column.fill(0.0);
            border.corner = 0.0;
        }
    }
}

/// The factors of a matrix.
#[derive(Clone, Debug)]
pub struct Factors {
    core: CoreFactors,
    border: Option<Border>,
    time_limit: TimeLimit,
}

#[derive(Clone, Debug)]
enum CoreFactors {
    Banded(BandedLu),
    Frontal(FrontalLu),
}

impl CoreFactors {
    fn solve(&mut self, values: &mut [f64]) {
        match self {
            Self::Banded(factors) => factors.solve(values),
            Self::Frontal(factors) => factors.solve(values),
        }
    }
}

impl Factors {
    /// Room for the factors of matrices of a pattern, made by so many threads where that pays; a factorisation is given
    /// up when the time is over.
    pub fn of_shape(shape: &SystemMatrix, threads: usize, time_limit: TimeLimit) -> Self {
        let core = match &shape.core {
            Core::Banded(matrix) => CoreFactors::Banded(BandedLu::of_shape(matrix)),
            Core::Sparse(matrix) => CoreFactors::Frontal(FrontalLu::of_shape(matrix, threads)),
        };
        Self { core, border: shape.border.clone(), time_limit }
    }

    /// Factors a matrix of the pattern.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot, or the time is over.
    ///
    /// # Panics
    /// Never for a matrix of the pattern that these factors were made for.
    pub fn factor(&mut self, matrix: &SystemMatrix) -> Result<(), Singular> {
        match (&mut self.core, &matrix.core) {
            (CoreFactors::Banded(factors), Core::Banded(matrix)) => {
                factors.factor(matrix, self.time_limit)?;
            }
            (CoreFactors::Frontal(factors), Core::Sparse(matrix)) => {
                factors.factor(matrix, self.time_limit)?;
            }
            _ => unreachable!("factors of another pattern"),
        }
        if let (Some(factored), Some(border)) = (&mut self.border, &matrix.border) {
            factored.clone_from(border);
            self.core.solve(&mut factored.column);
            let left = border.corner - dot(&factored.row, &factored.column);
            if left == 0.0 || !left.is_finite() {
                return Err(Singular { row: factored.row.len() });
            }
            factored.corner = 1.0 / left;
        }
        Ok(())
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        let Some(border) = &self.border else { return self.core.solve(values) };
        let (core, last) = values.split_at_mut(border.row.len());
        self.core.solve(core);
        for last in last {
            *last = (*last - dot(&border.row, core)) * border.corner;
            for (value, column) in core.iter_mut().zip(&border.column) {
                *value -= column * *last;
            }
        }
    }
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
        let mut matrix = SystemMatrix::spanning(&vec![[0.0]; size], 1, |visitor| {
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
        let mut lu = Factors::of_shape(&matrix, 1, TimeLimit::default());
        let mut combined = matrix.clone();
        combined.set_combination(&matrix, -0.5, &matrix);
        combined.set_combination(&combined.clone(), 0.5, &matrix);
        for matrix in [&matrix, &combined] {
            assert_eq!(lu.factor(matrix), Ok(()));
            let mut solution = right.as_slice().to_vec();
            lu.solve(&mut solution);
            let residual = &dense * DVector::from_vec(solution) - &right;
            assert!(residual.amax() < 1e-11, "{}", residual.amax());
            let (values, mut rest) = ([0.5; 10], [0.0; 10]);
            matrix.subtract_product(&values, &mut rest);
            let product = &dense * DVector::from_row_slice(&values) + DVector::from_row_slice(&rest);
            assert!(product.amax() < 1e-12, "{}", product.amax());
        }
        let core_only = SystemMatrix::spanning(&[[0.0]], 1, |visitor| visitor(0, 0));
        assert!(Factors::of_shape(&core_only, 1, TimeLimit::default()).factor(&core_only).is_err());
    }
}
