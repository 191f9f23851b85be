//! LU factorisation of a sparse matrix, front by front (Duff & Reid 1983).
//!
//! Unknowns are eliminated in the order of nested dissection. A front gathers the rows and columns of the unknowns of a
//! separator and what its halves left there, eliminates them with pivots among themselves, keeps their factors for
//! solutions and leaves a Schur complement to the front above. The order of all sums is fixed: any number of threads gives
//! the same bits.

use crate::direct_solver::Singular;
use crate::direct_solver::dense::{factor_columns, solve_unit_lower, subtract_product, swap_rows};
use crate::direct_solver::dissection::{Part, dissected};
use crate::direct_solver::panels::Panels;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::time_limit::TimeLimit;
use nalgebra::DMatrix;

/// The factors of a sparse matrix.
#[derive(Clone, Debug)]
pub struct FrontalLu {
    root: Front,
    threads: usize,
    threads_of_solution: usize,
}

/// Numbers of the factors from which on a solution reads them faster on two threads: to start one takes as long as to read
/// some hundred thousand.
const NUMBERS_FOR_THREADS: usize = 1 << 19;

/// Unknowns that are eliminated together, after those of the fronts below.
#[derive(Clone, Debug)]
struct Front {
    children: Vec<Front>,
    /// Unknowns that it eliminates.
    unknowns: Vec<usize>,
    /// Row of the front above for each later unknown that it is tied to: its boundary.
    in_parent: Vec<usize>,
    /// Entries of the matrix that belong to it: row and column of the front, and number in the matrix.
    entries: Vec<[u32; 3]>,
    /// Its part of `L` and `U`.
    panels: Panels,
    /// How many rows below its own each pivot was found.
    pivots: Vec<usize>,
    /// Part of a solution: its unknowns, and its boundary.
    values: Vec<f64>,
}

/// The matrix of a front before and after its elimination.
struct Dense {
    /// Columns that it eliminates, `[count + boundary][count]`: then `L` and `U` of the pivots, below them the rest of `L`.
    left: DMatrix<f64>,
    /// The rest of its rows, `[count][boundary]`: then of `U`.
    right: DMatrix<f64>,
    /// The block of the boundary: then its Schur complement.
    rest: DMatrix<f64>,
}

impl FrontalLu {
    /// Room for the factors of matrices of a pattern, made by so many threads.
    pub fn of_shape(shape: &SparseMatrix, threads: usize) -> Self {
        let (order, root) = dissected(shape);
        let mut place = vec![0; order.len()];
        for (number, unknown) in order.iter().enumerate() {
            place[*unknown] = number;
        }
        let (root, _) = Front::connected(root, shape, &order, &place, threads);
        let is_large = root.numbers() >= NUMBERS_FOR_THREADS;
        Self { root, threads, threads_of_solution: if is_large { threads } else { 1 } }
    }

    /// Factors a matrix of the pattern, unless the time ends first.
    ///
    /// # Errors
    /// [`Singular`] when a front has no pivot for a column, or the time is over.
    pub fn factor(&mut self, matrix: &SparseMatrix, time_limit: TimeLimit) -> Result<(), Singular> {
        self.root.factor(matrix.entries(), time_limit, self.threads).map(|_| ())
    }

    /// Replaces a right-hand side by the solution; on one thread nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        self.root.go_forward(values, self.threads_of_solution);
        self.root.go_back(&[], self.threads_of_solution);
        self.root.put(values);
    }
}

impl Front {
    /// A front and those below it, and its boundary as rising places in the order of elimination.
    fn connected(
        part: Part,
        matrix: &SparseMatrix,
        order: &[usize],
        place: &[usize],
        threads: usize,
    ) -> (Self, Vec<usize>) {
        let Part { first, count, .. } = part;
        let end = first + count;
        let connect = |half, threads| Self::connected(half, matrix, order, place, threads);
        let halves = part.halves.map(|halves| on_halves(*halves, threads, connect));
        let (mut children, boundaries): (Vec<Self>, Vec<_>) = halves.into_iter().flatten().unzip();
        let unknowns = order[first..end].to_vec();
        let tied = unknowns.iter().flat_map(|unknown| matrix.row(*unknown).1);
        let tied = tied.map(|other| place[*other as usize]);
        let of_children = boundaries.iter().flatten().copied();
        let mut boundary: Vec<usize> = tied.chain(of_children).filter(|place| *place >= end).collect();
        boundary.sort_unstable();
        boundary.dedup();
        let row_of = |place: usize| match place.checked_sub(end) {
            None => place - first,
            Some(_) => count + boundary.partition_point(|other| *other < place),
        };
        for (child, boundary) in children.iter_mut().zip(&boundaries) {
            child.in_parent = boundary.iter().map(|place| row_of(*place)).collect();
        }
        let mut entries = Vec::new();
        for (row, unknown) in unknowns.iter().enumerate() {
            let (start, columns) = matrix.row(*unknown);
            for (entry, other) in (start..).zip(columns) {
                let column = match place[*other as usize] {
                    earlier if earlier < first => continue,
                    place => row_of(place),
                };
                entries.push([row, column, entry].map(small));
                if column >= count {
                    let transposed = matrix.entry(*other as usize, *unknown);
                    entries.push([column, row, transposed].map(small));
                }
            }
        }
        entries.shrink_to_fit();
        let front = Self {
            panels: Panels::of_shape(count, boundary.len()),
            pivots: vec![0; count],
            values: vec![0.0; count + boundary.len()],
            in_parent: Vec::new(),
            children,
            unknowns,
            entries,
        };
        (front, boundary)
    }

    /// Numbers in the factors of the front and of those below it, at most.
    fn numbers(&self) -> usize {
        self.panels.numbers() + self.children.iter().map(Self::numbers).sum::<usize>()
    }

    /// Runs a task on each of the fronts below, at once on more than one thread; returns the results in the order of the
    /// fronts.
    fn on_children<T: Send>(
        &mut self,
        threads: usize,
        task: impl Fn(&mut Self, usize) -> T + Sync,
    ) -> Vec<T> {
        match &mut self.children[..] {
            [low, high] => on_halves([low, high], threads, task).into(),
            _ => Vec::new(),
        }
    }

    /// Factors the fronts below and this one, by so many threads; the Schur complement of its boundary.
    ///
    /// # Errors
    /// The row without a pivot, or at which the time was over.
    fn factor(
        &mut self,
        entries: &[f64],
        time_limit: TimeLimit,
        threads: usize,
    ) -> Result<DMatrix<f64>, Singular> {
        let factored = self.on_children(threads, |child, threads| child.factor(entries, time_limit, threads));
        let schur_complements = factored.into_iter().collect::<Result<_, _>>()?;
        if time_limit.is_over() {
            return Err(Singular { row: self.unknowns.first().copied().unwrap_or(0) });
        }
        let mut dense = self.gather(entries, schur_complements);
        self.eliminate(&mut dense)?;
        self.panels.take(&dense.left, &dense.right);
        Ok(dense.rest)
    }

    /// The matrix of the front: its entries of the whole matrix, and what its children left.
    fn gather(&self, entries: &[f64], schur_complements: Vec<DMatrix<f64>>) -> Dense {
        let (count, outer) = (self.unknowns.len(), self.in_parent.len());
        let mut left = DMatrix::zeros(count + outer, count);
        let mut right = DMatrix::zeros(count, outer);
        let mut rest = DMatrix::zeros(outer, outer);
        for entry in &self.entries {
            let [row, column, entry] = entry.map(|number| number as usize);
            match column.checked_sub(count) {
                None => left[(row, column)] += entries[entry],
                Some(column) => right[(row, column)] += entries[entry],
            }
        }
        for (child, schur_complement) in self.children.iter().zip(schur_complements) {
            let rows = &child.in_parent;
            let pivot_rows = rows.partition_point(|row| *row < count);
            for (column, values) in rows.iter().zip(schur_complement.column_iter()) {
                match column.checked_sub(count) {
                    None => add_to_rows(column_of(&mut left, *column), rows, 0, values.as_slice()),
                    Some(column) => {
                        let (above, below) = values.as_slice().split_at(pivot_rows);
                        let (rows_above, rows_below) = rows.split_at(pivot_rows);
                        add_to_rows(column_of(&mut right, column), rows_above, 0, above);
                        add_to_rows(column_of(&mut rest, column), rows_below, count, below);
                    }
                }
            }
        }
        Dense { left, right, rest }
    }

    /// Eliminates the unknowns of the front, with pivots among its own rows, from the block of the boundary.
    ///
    /// # Errors
    /// The row without a pivot.
    fn eliminate(&mut self, Dense { left, right, rest }: &mut Dense) -> Result<(), Singular> {
        let count = self.unknowns.len();
        // Halves that do not touch each other have no separator.
        if count == 0 {
            return Ok(());
        }
        factor_columns(left.as_view_mut(), count, &mut self.pivots);
        // Of a normal number the inverse, by which solutions multiply, is finite.
        if let Some(column) = (0..count).find(|column| !left[(*column, *column)].is_normal()) {
            return Err(Singular { row: self.unknowns[column] });
        }
        swap_rows(&mut right.as_view_mut(), &self.pivots);
        let (square, below) = left.rows_range_pair(..count, count..);
        solve_unit_lower(square, right.as_view_mut());
        subtract_product(&mut rest.as_view_mut(), below, right.as_view());
        Ok(())
    }

    /// `L⁻¹ b`, into the values of the fronts.
    fn go_forward(&mut self, right: &[f64], threads: usize) {
        self.on_children(threads, |child, threads| child.go_forward(right, threads));
        let (eliminated, boundary) = self.values.split_at_mut(self.unknowns.len());
        for (value, unknown) in eliminated.iter_mut().zip(&self.unknowns) {
            *value = right[*unknown];
        }
        boundary.fill(0.0);
        for child in &self.children {
            add_to_rows(&mut self.values, &child.in_parent, 0, &child.values[child.unknowns.len()..]);
        }
        for (row, below) in self.pivots.iter().enumerate() {
            self.values.swap(row, row + below);
        }
        self.panels.go_down(&mut self.values);
    }

    /// `U⁻¹ b` of the values of the fronts, by those of the front above.
    fn go_back(&mut self, above: &[f64], threads: usize) {
        for (value, row) in self.values[self.unknowns.len()..].iter_mut().zip(&self.in_parent) {
            *value = above[*row];
        }
        self.panels.go_up(&mut self.values);
        let above = std::mem::take(&mut self.values);
        self.on_children(threads, |child, threads| child.go_back(&above, threads));
        self.values = above;
    }

    /// Puts the values of the fronts to their unknowns.
    fn put(&self, values: &mut [f64]) {
        for (unknown, value) in self.unknowns.iter().zip(&self.values) {
            values[*unknown] = *value;
        }
        self.children.iter().for_each(|child| child.put(values));
    }
}

/// Runs a task on both halves of a set, at once on more than one thread.
fn on_halves<H: Send, T: Send>(
    [low, high]: [H; 2],
    threads: usize,
    task: impl Fn(H, usize) -> T + Sync,
) -> [T; 2] {
    if threads < 2 {
        return [task(low, 1), task(high, 1)];
    }
    std::thread::scope(|scope| {
        let high = scope.spawn(|| task(high, threads / 2));
        let low = task(low, threads.div_ceil(2));
        [low, high.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))]
    })
}

/// A column of a matrix.
fn column_of(matrix: &mut DMatrix<f64>, column: usize) -> &mut [f64] {
    let rows = matrix.nrows();
    &mut matrix.as_mut_slice()[column * rows..][..rows]
}

/// Adds values to rows of a column that begins at row `first`.
fn add_to_rows(column: &mut [f64], rows: &[usize], first: usize, values: &[f64]) {
    for (row, value) in rows.iter().zip(values) {
        column[*row - first] += value;
    }
}

/// A number of an entry in less room.
///
/// # Panics
/// Beyond 2³² entries, whose matrix no memory holds.
fn small(number: usize) -> u32 {
    u32::try_from(number).expect("fewer than 2^32 entries")
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
        ) {
            let (sparse, dense, right) = grid(across, up, reach, seed);
            let mut lu = FrontalLu::of_shape(&sparse, 1);
            prop_assert_eq!(lu.factor(&sparse, TimeLimit::default()), Ok(()));
            let mut solution = right.clone();
            lu.solve(&mut solution);
            let mut rest = right.clone();
            sparse.subtract_product(&solution, &mut rest);
            let residual = &dense * DVector::from_vec(solution) - DVector::from_vec(right);
            prop_assert!(residual.iter().zip(&rest).all(|(a, b)| (a + b).abs() < 1e-9));
            prop_assert!(residual.amax() < 1e-7, "{}", residual.amax());
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (matrix, _, right) = grid(40, 40, 2, 7);
        let solutions = |threads: usize| {
            let mut lu = FrontalLu { threads_of_solution: threads, ..FrontalLu::of_shape(&matrix, threads) };
            // Factors and solutions must not depend on what was there before.
            [(); 2].map(|()| {
                assert_eq!(lu.factor(&matrix, TimeLimit::default()), Ok(()));
                let mut solution = right.clone();
                lu.solve(&mut solution);
                solution
            })
        };
        let alone = solutions(1);
        assert_eq!(alone[0], alone[1]);
        for threads in 2..6 {
            assert_eq!(solutions(threads), alone, "{threads} threads");
        }
    }

    #[test]
    fn a_row_without_a_pivot_is_named() {
        let positions: Vec<[f64; 2]> = (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20)]).collect();
        // One over the last of these values is infinite.
        for (rows, value, named) in
            [(&[123][..], 0.0, 123), (&[290], 0.0, 290), (&[123, 290], 0.0, 123), (&[290], 1e-310, 290)]
        {
            let mut matrix = SparseMatrix::spanning(&positions, |_| ());
            for row in 0..400 {
                matrix.add(row, row, if rows.contains(&row) { value } else { 1.0 });
            }
            for threads in 1..4 {
                let mut lu = FrontalLu::of_shape(&matrix, threads);
                let factored = lu.factor(&matrix, TimeLimit::default());
                assert_eq!(factored, Err(Singular { row: named }), "{rows:?} on {threads} threads");
            }
        }
        // Wherever in its front the row is, the last included.
        let mut lu = FrontalLu::of_shape(&SparseMatrix::spanning(&positions, |_| ()), 1);
        for without in 0..400 {
            let mut matrix = SparseMatrix::spanning(&positions, |_| ());
            (0..400).filter(|row| *row != without).for_each(|row| matrix.add(row, row, 1.0));
            assert_eq!(lu.factor(&matrix, TimeLimit::default()), Err(Singular { row: without }));
        }
    }
}
