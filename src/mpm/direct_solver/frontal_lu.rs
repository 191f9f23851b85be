//! LU factorisation of a sparse matrix, front by front (Duff & Reid 1983).
//!
//! A front gathers the rows and columns of the unknowns that it eliminates and what its children left there,
//! eliminates them with pivots among themselves, and leaves its remainder to its parent. All arithmetic is
//! dense, in one order, without fused operations: the same bits on every machine.

use crate::mpm::direct_solver::banded::less_products;
use crate::mpm::direct_solver::elimination::{Elimination, FrontShape};
use crate::mpm::direct_solver::front::{Front, Panel};
use crate::mpm::direct_solver::singular::Singular;
use crate::mpm::direct_solver::sparse_matrix::SparseMatrix;
use crate::mpm::wide::wide;

/// The factors of a sparse matrix.
#[derive(Clone, Debug)]
pub struct FrontalLu {
    elimination: Elimination,
    /// Factors of each front, one after the other: `[count][size]` of `L` and `U` in the rows that it
    /// eliminates, then `[boundary][count]` of `L` in those behind.
    factors: Vec<f64>,
    /// First entry of each front in `factors`.
    starts: Vec<usize>,
    /// Row of its front that took the place of each row.
    pivots: Vec<usize>,
    /// The front at work, `[size][size]`.
    front: Vec<f64>,
    /// Remainders that wait for their parents, the last on top.
    waiting: Vec<f64>,
    /// Row of the front at work of each place in the order of elimination.
    row_of_place: Vec<usize>,
    panel: Panel,
    /// A right-hand side in the order of elimination, and the part of it that a front has.
    ordered: Vec<f64>,
    gathered: Vec<f64>,
}

impl FrontalLu {
    /// Room for the factors of matrices of a shape.
    pub fn of_shape(shape: &SparseMatrix) -> Self {
        let elimination = Elimination::of(shape);
        let (mut starts, mut entries, mut largest) = (Vec::new(), 0, 0);
        let (mut waiting, mut most_waiting) = (0, 0);
        for front in &elimination.fronts {
            starts.push(entries);
            entries += front.factor_entries();
            largest = largest.max(front.size());
            let remainder = |front: &FrontShape| front.boundary.len() * front.boundary.len();
            let taken: usize =
                front.children.iter().map(|child| remainder(&elimination.fronts[*child])).sum();
            waiting = waiting - taken + remainder(front);
            most_waiting = most_waiting.max(waiting);
        }
        let size = elimination.order.len();
        Self {
            elimination,
            factors: vec![0.0; entries],
            starts,
            pivots: vec![0; size],
            front: vec![0.0; largest * largest],
            waiting: Vec::with_capacity(most_waiting),
            row_of_place: vec![0; size],
            panel: Panel::for_fronts_of(largest),
            ordered: vec![0.0; size],
            gathered: vec![0.0; largest],
        }
    }

    /// Factors the matrix of a shape whose entries `value` tells by their numbers; nothing is allocated.
    ///
    /// # Errors
    /// [`Singular`] when a front has no pivot for a column.
    pub fn factor(&mut self, shape: &SparseMatrix, value: impl Fn(usize) -> f64) -> Result<(), Singular> {
        self.waiting.clear();
        for (number, start) in self.starts.iter().enumerate() {
            let shape_of_front = &self.elimination.fronts[number];
            let (first, count, size) = (shape_of_front.first, shape_of_front.count, shape_of_front.size());
            if size == 0 {
                continue; // A cut that parted what was apart already.
            }
            let entries = &mut self.front[..size * size];
            entries.fill(0.0);
            let places = (first..first + count).chain(shape_of_front.boundary.iter().copied());
            for (row, place) in places.enumerate() {
                self.row_of_place[place] = row;
            }
            for (row, entry) in &shape_of_front.entries {
                let entry = *entry as usize;
                let row_of = |unknown: usize| self.row_of_place[self.elimination.place[unknown]];
                entries[row_of(*row as usize) * size + row_of(shape.column(entry))] += value(entry);
            }
            take_up_remainders(
                &self.elimination.fronts,
                number,
                &self.row_of_place,
                &mut self.waiting,
                entries,
            );
            let mut front = Front { entries, size, panel: &mut self.panel };
            front
                .eliminate(&mut self.pivots[first..first + count])
                .map_err(|column| Singular { row: self.elimination.order[first + column] })?;
            let (eliminated, behind) = entries.split_at(count * size);
            let factors = &mut self.factors[*start..][..shape_of_front.factor_entries()];
            let (upper, lower) = factors.split_at_mut(count * size);
            upper.copy_from_slice(eliminated);
            for (lower, row) in lower.chunks_exact_mut(count.max(1)).zip(behind.chunks_exact(size)) {
                lower.copy_from_slice(&row[..count]);
            }
            for row in behind.chunks_exact(size) {
                self.waiting.extend_from_slice(&row[count..]);
            }
        }
        Ok(())
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        wide!(self.substitute(values));
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "what runs in wide registers is inlined there")]
    fn substitute(&mut self, values: &mut [f64]) {
        let Self { elimination, ordered, gathered, .. } = self;
        for (value, unknown) in ordered.iter_mut().zip(&elimination.order) {
            *value = values[*unknown];
        }
        for (front, start) in elimination.fronts.iter().zip(&self.starts) {
            let (count, size) = (front.count, front.size());
            let (upper, lower) = self.factors[*start..][..front.factor_entries()].split_at(count * size);
            let (own, behind) = ordered[front.first..].split_at_mut(count);
            for (row, pivot) in self.pivots[front.first..][..count].iter().enumerate() {
                own.swap(row, *pivot);
            }
            for row in 1..count {
                let (known, rest) = own.split_at_mut(row);
                rest[0] = less_products(rest[0], &upper[row * size..][..row], known);
            }
            for (place, lower) in front.boundary.iter().zip(lower.chunks_exact(count.max(1))) {
                let value = &mut behind[place - front.first - count];
                *value = less_products(*value, lower, own);
            }
        }
        for (front, start) in elimination.fronts.iter().zip(&self.starts).rev() {
            let (count, size) = (front.count, front.size());
            let gathered = &mut gathered[..size];
            for (value, place) in gathered[count..].iter_mut().zip(&front.boundary) {
                *value = ordered[*place];
            }
            for row in (0..count).rev() {
                let upper = &self.factors[start + row * size..][..size];
                let known = &gathered[row + 1..];
                let value = less_products(ordered[front.first + row], &upper[row + 1..], known) / upper[row];
                gathered[row] = value;
                ordered[front.first + row] = value;
            }
        }
        for (value, unknown) in ordered.iter().zip(&elimination.order) {
            values[*unknown] = *value;
        }
    }
}

/// Adds the remainders of a front's children to it and takes them from those that wait.
fn take_up_remainders(
    fronts: &[FrontShape],
    number: usize,
    row_of_place: &[usize],
    waiting: &mut Vec<f64>,
    entries: &mut [f64],
) {
    let size = fronts[number].size();
    for child in fronts[number].children.iter().rev() {
        let boundary = &fronts[*child].boundary;
        let bottom = waiting.len() - boundary.len() * boundary.len();
        for (place, remainder) in boundary.iter().zip(waiting[bottom..].chunks_exact(boundary.len().max(1))) {
            let row = &mut entries[row_of_place[*place] * size..][..size];
            for (column, value) in boundary.iter().zip(remainder) {
                row[row_of_place[*column]] += value;
            }
        }
        waiting.truncate(bottom);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn solutions_are_those_of_the_dense_matrix(
            across in 1..24usize, up in 1..24usize, reach in 0..3usize, seed in 0..1000u32,
        ) {
            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 23) - 1.0
            };
            let count = across * up;
            let positions: Vec<[f64; 2]> =
                (0..count).map(|unknown| [(unknown % across) as f64, (unknown / across) as f64]).collect();
            let is_tied = |a: usize, b: usize| {
                (0..2).all(|d| (positions[a][d] - positions[b][d]).abs() <= reach as f64)
            };
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
                    // Neither symmetric nor dominant.
                    let value = random() + if a == b { 3.0 } else { 0.0 };
                    sparse.add(a, b, value);
                    dense[(a, b)] = value;
                }
            }
            let right = DVector::from_fn(count, |_, _| random());
            let mut lu = FrontalLu::of_shape(&sparse);
            prop_assert_eq!(lu.factor(&sparse, |entry| sparse.entries()[entry]), Ok(()));
            let mut solution = right.as_slice().to_vec();
            lu.solve(&mut solution);
            let mut rest = right.as_slice().to_vec();
            sparse.take_product(&solution, &mut rest);
            let residual = &dense * DVector::from_vec(solution) - right;
            prop_assert!(residual.iter().zip(&rest).all(|(a, b)| (a + b).abs() < 1e-9));
            prop_assert!(residual.amax() < 1e-7, "{}", residual.amax());
        }
    }

    #[test]
    fn a_row_of_zeros_is_named() {
        let positions: Vec<[f64; 2]> = (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20)]).collect();
        let mut matrix = SparseMatrix::spanning(&positions, |_| ());
        for row in (0..400).filter(|row| *row != 123) {
            matrix.add(row, row, 1.0);
        }
        let mut lu = FrontalLu::of_shape(&matrix);
        assert_eq!(lu.factor(&matrix, |entry| matrix.entries()[entry]), Err(Singular { row: 123 }));
    }
}
