//! A matrix and its factors, each in the form that suits its band.

use crate::direct_solver::banded::{Banded, BandedLu};
use crate::direct_solver::frontal_lu::FrontalLu;
use crate::direct_solver::singular::Singular;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::time_limit::TimeLimit;

/// Diagonals of a band beyond which fronts are the faster.
const WIDEST_BAND: usize = 200;

/// A square matrix over a fixed set of places.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemMatrix {
    /// By its diagonals.
    Banded(Banded),
    /// By its entries.
    Sparse(SparseMatrix),
}

impl SystemMatrix {
    /// A matrix of zeros with the places `(row, column)` that `visit` tells; `positions` are those of the
    /// unknowns in space, `[unknown][component]`, m.
    pub fn spanning<const D: usize>(
        positions: &[[f64; D]],
        visit: impl Fn(&mut dyn FnMut(usize, usize)),
    ) -> Self {
        let (mut lower, mut upper) = (0, 0);
        visit(&mut |row, column| {
            lower = lower.max(row.saturating_sub(column));
            upper = upper.max(column.saturating_sub(row));
        });
        if lower + upper <= WIDEST_BAND {
            return Self::Banded(Banded::zeros(positions.len(), lower, upper));
        }
        Self::Sparse(SparseMatrix::spanning(positions, visit))
    }

    /// Adds to an entry, which must be one of the places.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match self {
            Self::Banded(matrix) => matrix.add(row, column, value),
            Self::Sparse(matrix) => matrix.add(row, column, value),
        }
    }

    /// `rest ← rest − A values`.
    pub fn take_product(&self, values: &[f64], rest: &mut [f64]) {
        match self {
            Self::Banded(matrix) => matrix.take_product(values, rest),
            Self::Sparse(matrix) => matrix.take_product(values, rest),
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        match self {
            Self::Banded(matrix) => matrix.clear(),
            Self::Sparse(matrix) => matrix.clear(),
        }
    }
}

/// The factors of a matrix.
#[derive(Clone, Debug)]
pub enum Factors {
    /// Of a band.
    Banded(Box<BandedLu>),
    /// Of a sparse matrix.
    Frontal(Box<FrontalLu>),
}

impl Factors {
    /// Room for the factors of matrices of a shape, made and used by so many threads where that pays.
    pub fn of_shape(shape: &SystemMatrix, threads: usize) -> Self {
        match shape {
            SystemMatrix::Banded(matrix) => Self::Banded(Box::new(BandedLu::of_shape(matrix))),
            SystemMatrix::Sparse(matrix) => Self::Frontal(Box::new(FrontalLu::of_shape(matrix, threads))),
        }
    }

    /// Gives factorisations up at the end of a time.
    pub fn end_within(&mut self, time_limit: TimeLimit) {
        match self {
            Self::Banded(factors) => factors.end_within(time_limit),
            Self::Frontal(factors) => factors.end_within(time_limit),
        }
    }

    /// Factors a matrix of the shape; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    ///
    /// # Panics
    /// Never for a matrix of the shape that these factors were made for.
    pub fn factor(&mut self, matrix: &SystemMatrix) -> Result<(), Singular> {
        match (self, matrix) {
            (Self::Banded(factors), SystemMatrix::Banded(matrix)) => factors.factor(matrix),
            (Self::Frontal(factors), SystemMatrix::Sparse(matrix)) => {
                factors.factor(matrix, |entry| matrix.entries()[entry])
            }
            _ => unreachable!("factors of another shape"),
        }
    }

    /// Factors `fixed + factor · scaled`, both of the shape; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a column has no pivot.
    ///
    /// # Panics
    /// Never for matrices of the shape that these factors were made for.
    pub fn factor_combination(
        &mut self,
        fixed: &SystemMatrix,
        factor: f64,
        scaled: &SystemMatrix,
    ) -> Result<(), Singular> {
        match (self, fixed, scaled) {
            (Self::Banded(factors), SystemMatrix::Banded(fixed), SystemMatrix::Banded(scaled)) => {
                factors.factor_combination(fixed, factor, scaled)
            }
            (Self::Frontal(factors), SystemMatrix::Sparse(fixed), SystemMatrix::Sparse(scaled)) => {
                let (constant, rate) = (fixed.entries(), scaled.entries());
                factors.factor(fixed, |entry| constant[entry] + factor * rate[entry])
            }
            _ => unreachable!("factors of another shape"),
        }
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        match self {
            Self::Banded(factors) => factors.solve(values),
            Self::Frontal(factors) => factors.solve(values),
        }
    }
}
