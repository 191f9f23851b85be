//! LU factorisation of a sparse matrix, front by front (Duff & Reid 1983).
//!
//! A front gathers the rows and columns of the unknowns that it eliminates and what its children left there,
//! eliminates them with pivots among themselves, and leaves its remainder to its parent. All arithmetic is
//! dense, in one order, without fused operations: the same bits on every machine.

use crate::direct_solver::branch::{Branch, SMALLEST_HALF};
use crate::direct_solver::desk::{Desk, Factored};
use crate::direct_solver::elimination::Elimination;
use crate::direct_solver::singular::Singular;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::direct_solver::substitution::Substitution;
use crate::time_limit::TimeLimit;

/// The factors of a sparse matrix.
#[derive(Clone, Debug)]
pub struct FrontalLu {
    elimination: Elimination,
    /// The fronts in parts.
    whole: Branch,
    /// Factors of each front, one after the other, in the order in which a right-hand side goes through them.
    factors: Vec<f64>,
    /// First entry of each front in `factors`.
    starts: Vec<usize>,
    /// Row of its front that took the place of each row.
    pivots: Vec<usize>,
    /// One a thread.
    desks: Vec<Desk>,
    /// A right-hand side in the order of elimination.
    ordered: Vec<f64>,
    /// When it is given up.
    time_limit: TimeLimit,
}

impl FrontalLu {
    /// Room for the factors of matrices of a shape, made and used by so many threads. The same bits whatever their
    /// number.
    pub fn of_shape(shape: &SparseMatrix, threads: usize) -> Self {
        Self::parted(shape, threads, SMALLEST_HALF)
    }

    /// The same in parts of no fewer entries of the factors.
    fn parted(shape: &SparseMatrix, threads: usize, smallest_half: usize) -> Self {
        let elimination = Elimination::of(shape);
        let (mut starts, mut entries) = (Vec::new(), 0);
        for front in &elimination.fronts {
            starts.push(entries);
            entries += front.factor_entries();
        }
        let whole = Branch::whole(&elimination, &starts, smallest_half);
        let size = elimination.order.len();
        Self {
            factors: vec![0.0; entries],
            starts,
            pivots: vec![0; size],
            desks: (0..threads.clamp(1, whole.parts())).map(|_| Desk::of(&elimination)).collect(),
            ordered: vec![0.0; size],
            whole,
            elimination,
            time_limit: TimeLimit::default(),
        }
    }

    /// Gives a factorisation up at the end of a time, as if the front at work had no pivot.
    pub fn end_within(&mut self, time_limit: TimeLimit) {
        self.time_limit = time_limit;
    }

    /// Factors the matrix of a shape whose entries `value` tells by their numbers; nothing is allocated by one thread.
    ///
    /// # Errors
    /// [`Singular`] when a front has no pivot for a column.
    pub fn factor(
        &mut self,
        shape: &SparseMatrix,
        value: impl Fn(usize) -> f64 + Sync,
    ) -> Result<(), Singular> {
        self.desks.iter_mut().for_each(Desk::clear);
        let matrix = Factored { elimination: &self.elimination, shape, value, time_limit: self.time_limit };
        let room = (&mut self.factors[..], &mut self.pivots[..]);
        factor_branch(&self.whole, &matrix, room, &mut self.desks)
    }

    /// Replaces a right-hand side by the solution; nothing is allocated by one thread.
    pub fn solve(&mut self, values: &mut [f64]) {
        for (value, unknown) in self.ordered.iter_mut().zip(&self.elimination.order) {
            *value = values[*unknown];
        }
        let by = Substitution {
            fronts: &self.elimination.fronts,
            starts: &self.starts,
            factors: &self.factors,
            pivots: &self.pivots,
        };
        by.go_forward(&mut self.whole, &mut self.ordered, self.desks.len());
        by.go_back(&mut self.whole, &mut self.ordered, &mut self.desks);
        for (value, unknown) in self.ordered.iter().zip(&self.elimination.order) {
            values[*unknown] = *value;
        }
    }
}

/// Factors the fronts of a branch into its room among factors and pivots: its halves side by side where there are two
/// desks, else one after the other.
fn factor_branch<V: Fn(usize) -> f64 + Sync>(
    branch: &Branch,
    matrix: &Factored<'_, V>,
    (mut factors, mut pivots): (&mut [f64], &mut [usize]),
    desks: &mut [Desk],
) -> Result<(), Singular> {
    let parted = desks.len().div_ceil(2);
    let (desks, others) = desks.split_at_mut(parted);
    if let Some(halves) = &branch.halves {
        let [low, high] = &**halves;
        let (low_factors, rest) = factors.split_at_mut(low.entries.len());
        let (low_pivots, rest_of_pivots) = pivots.split_at_mut(low.places.len());
        let (high_factors, own) = rest.split_at_mut(high.entries.len());
        let (high_pivots, own_pivots) = rest_of_pivots.split_at_mut(high.places.len());
        (factors, pivots) = (own, own_pivots);
        let (low_room, high_room) = ((low_factors, low_pivots), (high_factors, high_pivots));
        if others.is_empty() {
            factor_branch(low, matrix, low_room, desks)?;
            factor_branch(high, matrix, high_room, desks)?;
        } else {
            let of_high = || factor_branch(high, matrix, high_room, others);
            let (low, high) = std::thread::scope(|scope| {
                let high = scope.spawn(of_high);
                (factor_branch(low, matrix, low_room, desks), high.join())
            });
            low?;
            high.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        }
    }
    let fronts = &matrix.elimination.fronts;
    for number in branch.fronts.clone() {
        let (own, rest) = factors.split_at_mut(fronts[number].factor_entries());
        let (own_pivots, rest_of_pivots) = pivots.split_at_mut(fronts[number].count);
        (factors, pivots) = (rest, rest_of_pivots);
        let other = if branch.halves.is_some() { others.first_mut() } else { None };
        desks[0].factor_front(number, matrix, (own, own_pivots), other)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// Unknowns on a grid, each tied to those within reach, with numbers that are neither symmetric nor dominant.
    fn grid(across: usize, up: usize, reach: usize, seed: u32) -> (SparseMatrix, DMatrix<f64>, Vec<f64>) {
        let mut state = seed;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        };
        let count = across * up;
        let positions: Vec<[f64; 2]> =
            (0..count).map(|unknown| [(unknown % across) as f64, (unknown / across) as f64]).collect();
        let is_tied =
            |a: usize, b: usize| (0..2).all(|d| (positions[a][d] - positions[b][d]).abs() <= reach as f64);
        let mut sparse = SparseMatrix::spanning(&positions, |visitor| {
            for a in 0..count {
                for b in (0..count).filter(|b| is_tied(a, *b)) {
                    visitor(a, b);
                }
            }
        });
        let mut dense = DMatrix::zeros(count, count);
        for a in 0..count {
            for b in (0..count).filter(|b| is_tied(a, *b)) {
                let value = random() + if a == b { 3.0 } else { 0.0 };
                sparse.add(a, b, value);
                dense[(a, b)] = value;
            }
        }
        (sparse, dense, (0..count).map(|_| random()).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn solutions_are_those_of_the_dense_matrix(
            across in 1..24usize, up in 1..24usize, reach in 0..3usize, seed in 0..1000u32,
            smallest_half in 1..4000usize,
        ) {
            let (sparse, dense, right) = grid(across, up, reach, seed);
            let mut lu = FrontalLu::parted(&sparse, 1, smallest_half);
            prop_assert_eq!(lu.factor(&sparse, |entry| sparse.entries()[entry]), Ok(()));
            let mut solution = right.clone();
            lu.solve(&mut solution);
            let mut rest = right.clone();
            sparse.take_product(&solution, &mut rest);
            let residual = &dense * DVector::from_vec(solution) - DVector::from_vec(right);
            prop_assert!(residual.iter().zip(&rest).all(|(a, b)| (a + b).abs() < 1e-9));
            prop_assert!(residual.amax() < 1e-7, "{}", residual.amax());
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (matrix, _, right) = grid(24, 24, 2, 7);
        let solution_of = |threads: usize, smallest_half: usize| {
            let mut lu = FrontalLu::parted(&matrix, threads, smallest_half);
            let mut solutions = Vec::new();
            // What one solution leaves behind must not reach the next.
            for factor in [1.0, 2.0] {
                assert_eq!(lu.factor(&matrix, |entry| factor * matrix.entries()[entry]), Ok(()));
                for _ in 0..2 {
                    let mut solution = right.clone();
                    lu.solve(&mut solution);
                    solutions.push(solution);
                }
            }
            (lu.desks.len(), solutions)
        };
        let (desks, whole) = solution_of(4, usize::MAX);
        assert_eq!(desks, 1, "it is not parted");
        let (desks, alone) = solution_of(1, 1000);
        assert_eq!(desks, 1);
        assert_eq!(alone[0], alone[1]);
        assert_eq!(alone[2], alone[3]);
        let difference =
            |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |d, (a, b)| d.max((a - b).abs()));
        assert!(difference(&whole[0], &alone[0]) < 1e-9);
        assert!(difference(&whole[2], &alone[2]) < 1e-9);
        for threads in 2..6 {
            let (desks, solutions) = solution_of(threads, 1000);
            assert_eq!(desks, threads.min(4), "two halvings give four parts");
            assert_eq!(solutions, alone, "{threads} threads");
        }
    }

    #[test]
    fn a_row_of_zeros_is_named() {
        let positions: Vec<[f64; 2]> = (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20)]).collect();
        for (zeros, named) in [(&[123][..], 123), (&[290], 290), (&[123, 290], 123)] {
            let mut matrix = SparseMatrix::spanning(&positions, |_| ());
            for row in (0..400).filter(|row| !zeros.contains(row)) {
                matrix.add(row, row, 1.0);
            }
            for threads in 1..4 {
                let mut lu = FrontalLu::parted(&matrix, threads, 1);
                assert_eq!(lu.desks.len(), threads);
                assert_eq!(
                    lu.factor(&matrix, |entry| matrix.entries()[entry]),
                    Err(Singular { row: named }),
                    "{zeros:?} on {threads} threads"
                );
            }
        }
    }
}
