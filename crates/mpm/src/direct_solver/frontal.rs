//! LU factorisation of a sparse matrix, front by front (Duff & Reid 1983).
//!
//! Unknowns are ordered by nested dissection of their places (George 1973): a set is cut across its longest direction, and
//! those of the lower half that touch the upper half are its separator, eliminated after both halves. So a matrix of the
//! plane fills in as `N log N`, and its factors cost `N^1.5`. A front gathers the rows and columns of the unknowns of a
//! separator and what its halves left there, eliminates them with pivots among themselves, and leaves a Schur complement
//! to the front above. The order of all sums is fixed: any number of threads gives the same bits.

use crate::direct_solver::Singular;
use crate::direct_solver::dense::{
    factor_columns, solve_unit_lower, subtract_image, subtract_product, swap_rows, sweep_down, sweep_up,
};
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::time_limit::TimeLimit;
use nalgebra::DMatrix;

/// Unknowns of a set that is cut no further: a front of some hundred rows is as fast as two of half of them.
const SMALLEST_SET: usize = 96;

/// The factors of a sparse matrix.
#[derive(Clone, Debug)]
pub struct FrontalLu {
    /// Unknown at each place in the order of elimination.
    order: Vec<usize>,
    root: Front,
    threads: usize,
    /// A right-hand side in the order of elimination.
    ordered: Vec<f64>,
    /// Room for the part of it that a front needs.
    gathered: Vec<f64>,
}

/// Unknowns that are eliminated together, after those of the fronts below.
#[derive(Clone, Debug)]
struct Front {
    children: Vec<Front>,
    /// Place of its first unknown in the order of elimination.
    first: usize,
    /// Unknowns that it eliminates.
    count: usize,
    /// Later unknowns that it is tied to, as rising places in the order of elimination.
    boundary: Vec<usize>,
    /// Row of the front above for each unknown of the boundary.
    in_parent: Vec<usize>,
    /// Entries of the matrix that belong to it: row and column of the front, and number in the matrix.
    entries: Vec<[u32; 3]>,
    /// Columns that it eliminates, `[count + boundary][count]`: `L` and `U` of the pivots, below them the rest of `L`.
    left: DMatrix<f64>,
    /// The rest of `U`, `[count][boundary]`.
    right: DMatrix<f64>,
    /// How many rows below its own each pivot was found.
    pivots: Vec<usize>,
}

impl FrontalLu {
    /// Room for the factors of matrices of a pattern, made by so many threads.
    pub fn of_shape(shape: &SparseMatrix, threads: usize) -> Self {
        let count = shape.positions().len();
        let mut order = Vec::with_capacity(count);
        let mut root = dissect((0..count).collect(), shape, &mut vec![false; count], &mut order);
        let mut place = vec![0; count];
        for (number, unknown) in order.iter().enumerate() {
            place[*unknown] = number;
        }
        root.connect(shape, &order, &place);
        let gathered = vec![0.0; root.largest_part()];
        Self { order, root, threads, ordered: vec![0.0; count], gathered }
    }

    /// Factors a matrix of the pattern, unless the time ends first.
    ///
    /// # Errors
    /// [`Singular`] when a front has no pivot for a column, or the time is over.
    pub fn factor(&mut self, matrix: &SparseMatrix, time_limit: TimeLimit) -> Result<(), Singular> {
        match self.root.factor(matrix.entries(), time_limit, self.threads) {
            Ok(_) => Ok(()),
            Err(place) => Err(Singular { row: self.order[place] }),
        }
    }

    /// Replaces a right-hand side by the solution; nothing is allocated.
    pub fn solve(&mut self, values: &mut [f64]) {
        for (value, unknown) in self.ordered.iter_mut().zip(&self.order) {
            *value = values[*unknown];
        }
        self.root.go_forward(&mut self.ordered, &mut self.gathered);
        self.root.go_back(&mut self.ordered, &mut self.gathered);
        for (value, unknown) in self.ordered.iter().zip(&self.order) {
            values[*unknown] = *value;
        }
    }
}

/// Orders the unknowns of a set, half by half and the separator last. `is_upper` is all false between the calls.
fn dissect(set: Vec<usize>, matrix: &SparseMatrix, is_upper: &mut [bool], order: &mut Vec<usize>) -> Front {
    let (mut own, mut children) = (set, Vec::new());
    if own.len() > SMALLEST_SET {
        let positions = matrix.positions();
        let direction = longest_direction(&own, positions);
        let place = |unknown: &usize| positions[*unknown][direction];
        let mut places: Vec<f64> = own.iter().map(place).collect();
        let middle = places.len() / 2;
        let level = *places.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (low, high): (Vec<usize>, Vec<usize>) = own.iter().partition(|unknown| place(unknown) < level);
        for unknown in &high {
            is_upper[*unknown] = true;
        }
        let touches =
            |unknown: &&usize| matrix.row(**unknown).1.iter().any(|other| is_upper[*other as usize]);
        let (separator, apart): (Vec<usize>, Vec<usize>) = low.iter().partition(touches);
        for unknown in &high {
            is_upper[*unknown] = false;
        }
        // A set that is all separator is not worth cutting.
        if !apart.is_empty() {
            children = [apart, high].map(|half| dissect(half, matrix, is_upper, order)).into();
            own = separator;
        }
    }
    let (first, count) = (order.len(), own.len());
    order.extend(own);
    Front {
        children,
        first,
        count,
        boundary: Vec::new(),
        in_parent: Vec::new(),
        entries: Vec::new(),
        left: DMatrix::zeros(0, 0),
        right: DMatrix::zeros(0, 0),
        pivots: vec![0; count],
    }
}

/// Direction in which a set extends furthest.
fn longest_direction(set: &[usize], positions: &[[f64; 3]]) -> usize {
    let extent = |direction: usize| {
        let places = set.iter().map(|unknown| positions[*unknown][direction]);
        let (low, high) = places
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| (low.min(place), high.max(place)));
        high - low
    };
    (0..3).max_by(|a, b| extent(*a).total_cmp(&extent(*b))).unwrap_or(0)
}

impl Front {
    /// Finds the boundaries of the front and of those below it, and where the entries of the matrix go.
    fn connect(&mut self, matrix: &SparseMatrix, order: &[usize], place: &[usize]) {
        let (first, count, end) = (self.first, self.count, self.first + self.count);
        for child in &mut self.children {
            child.connect(matrix, order, place);
        }
        let unknowns = &order[first..end];
        let tied = unknowns.iter().flat_map(|unknown| matrix.row(*unknown).1);
        let of_children = self.children.iter().flat_map(|child| &child.boundary);
        self.boundary = tied.map(|other| &place[*other as usize]).chain(of_children).copied().collect();
        self.boundary.retain(|place| *place >= end);
        self.boundary.sort_unstable();
        self.boundary.dedup();
        self.boundary.shrink_to_fit();
        let boundary = &self.boundary;
        let row_of = |place: usize| match place.checked_sub(end) {
            None => place - first,
            Some(_) => count + boundary.partition_point(|other| *other < place),
        };
        for child in &mut self.children {
            child.in_parent = child.boundary.iter().map(|place| row_of(*place)).collect();
        }
        for (row, unknown) in unknowns.iter().enumerate() {
            let (start, columns) = matrix.row(*unknown);
            for (entry, other) in (start..).zip(columns) {
                let column = match place[*other as usize] {
                    earlier if earlier < first => continue,
                    place => row_of(place),
                };
                self.entries.push([row, column, entry].map(small));
                if column >= count {
                    let transposed = matrix.entry(*other as usize, *unknown);
                    self.entries.push([column, row, transposed].map(small));
                }
            }
        }
        self.entries.shrink_to_fit();
        self.left = DMatrix::zeros(count + boundary.len(), count);
        self.right = DMatrix::zeros(count, boundary.len());
    }

    /// Most unknowns that any front eliminates and has on its boundary.
    fn largest_part(&self) -> usize {
        let own = self.boundary.len() + self.count;
        self.children.iter().map(Self::largest_part).fold(own, usize::max)
    }

    /// Factors the fronts below and this one, by so many threads; the Schur complement of its boundary.
    ///
    /// # Errors
    /// The place without a pivot, or at which the time was over.
    fn factor(
        &mut self,
        entries: &[f64],
        time_limit: TimeLimit,
        threads: usize,
    ) -> Result<DMatrix<f64>, usize> {
        let left = match &mut self.children[..] {
            [low, high] if threads > 1 => {
                let (low, high) = std::thread::scope(|scope| {
                    let high = scope.spawn(|| high.factor(entries, time_limit, threads / 2));
                    (low.factor(entries, time_limit, threads.div_ceil(2)), high.join())
                });
                vec![low?, high.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?]
            }
            children => {
                let factored = children.iter_mut().map(|child| child.factor(entries, time_limit, 1));
                factored.collect::<Result<_, _>>()?
            }
        };
        if time_limit.is_over() {
            return Err(self.first);
        }
        let mut rest = self.gather(entries, left);
        self.eliminate(&mut rest)?;
        Ok(rest)
    }

    /// Fills the front with its entries of the matrix and what its children left; the block of the boundary.
    fn gather(&mut self, entries: &[f64], schur_complements: Vec<DMatrix<f64>>) -> DMatrix<f64> {
        let count = self.count;
        self.left.fill(0.0);
        self.right.fill(0.0);
        let mut rest = DMatrix::zeros(self.boundary.len(), self.boundary.len());
        for entry in &self.entries {
            let [row, column, entry] = entry.map(|number| number as usize);
            match column.checked_sub(count) {
                None => self.left[(row, column)] += entries[entry],
                Some(column) => self.right[(row, column)] += entries[entry],
            }
        }
        for (child, schur_complement) in self.children.iter().zip(schur_complements) {
            let rows = &child.in_parent;
            let own_rows = rows.partition_point(|row| *row < count);
            for (column, values) in rows.iter().zip(schur_complement.column_iter()) {
                match column.checked_sub(count) {
                    None => add_to_rows(column_of(&mut self.left, *column), rows, 0, values.as_slice()),
                    Some(column) => {
                        let (above, below) = values.as_slice().split_at(own_rows);
                        let (rows_above, rows_below) = rows.split_at(own_rows);
                        add_to_rows(column_of(&mut self.right, column), rows_above, 0, above);
                        add_to_rows(column_of(&mut rest, column), rows_below, count, below);
                    }
                }
            }
        }
        rest
    }

    /// Eliminates the unknowns of the front, with pivots among its own rows, from the block of the boundary.
    ///
    /// # Errors
    /// The place without a pivot.
    fn eliminate(&mut self, rest: &mut DMatrix<f64>) -> Result<(), usize> {
        let count = self.count;
        // Halves that do not touch each other have no separator.
        if count == 0 {
            return Ok(());
        }
        factor_columns(self.left.as_view_mut(), count, &mut self.pivots);
        let is_pivot = |value: f64| value != 0.0 && value.is_finite();
        if let Some(column) = (0..count).find(|column| !is_pivot(self.left[(*column, *column)])) {
            return Err(self.first + column);
        }
        swap_rows(&mut self.right.as_view_mut(), &self.pivots);
        let (own, below) = self.left.rows_range_pair(..count, count..);
        solve_unit_lower(own, self.right.as_view_mut());
        subtract_product(&mut rest.as_view_mut(), below, self.right.as_view());
        Ok(())
    }

    /// `b ← L⁻¹ b`.
    fn go_forward(&self, values: &mut [f64], gathered: &mut [f64]) {
        for child in &self.children {
            child.go_forward(values, gathered);
        }
        if self.count == 0 {
            return;
        }
        let own = &mut values[self.first..][..self.count];
        for (row, below) in self.pivots.iter().enumerate() {
            own.swap(row, row + below);
        }
        let gathered = &mut gathered[..self.count + self.boundary.len()];
        let (solved, change) = gathered.split_at_mut(self.count);
        solved.copy_from_slice(own);
        change.fill(0.0);
        sweep_down(self.left.as_slice(), gathered, self.count);
        let (solved, change) = gathered.split_at(self.count);
        own.copy_from_slice(solved);
        for (place, change) in self.boundary.iter().zip(change) {
            values[*place] += change;
        }
    }

    /// `b ← U⁻¹ b`.
    fn go_back(&self, values: &mut [f64], gathered: &mut [f64]) {
        self.go_back_in_own(values, gathered);
        for child in self.children.iter().rev() {
            child.go_back(values, gathered);
        }
    }

    fn go_back_in_own(&self, values: &mut [f64], gathered: &mut [f64]) {
        if self.count == 0 {
            return;
        }
        let later = &mut gathered[..self.boundary.len()];
        for (value, place) in later.iter_mut().zip(&self.boundary) {
            *value = values[*place];
        }
        let own = &mut values[self.first..][..self.count];
        subtract_image(self.right.as_slice(), later, own);
        sweep_up(self.left.as_slice(), self.count + self.boundary.len(), own);
    }
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
            let mut lu = FrontalLu::of_shape(&matrix, threads);
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
    fn a_row_of_zeros_is_named() {
        let positions: Vec<[f64; 2]> = (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20)]).collect();
        for (zeros, named) in [(&[123][..], 123), (&[290], 290), (&[123, 290], 123)] {
            let mut matrix = SparseMatrix::spanning(&positions, |_| ());
            for row in (0..400).filter(|row| !zeros.contains(row)) {
                matrix.add(row, row, 1.0);
            }
            for threads in 1..4 {
                let mut lu = FrontalLu::of_shape(&matrix, threads);
                let factored = lu.factor(&matrix, TimeLimit::default());
                assert_eq!(factored, Err(Singular { row: named }), "{zeros:?} on {threads} threads");
            }
        }
    }

    #[test]
    fn halves_are_apart_and_every_unknown_is_eliminated_once() {
        let side = 24;
        let (matrix, _, _) = grid(side, side, 2, 1);
        let lu = FrontalLu::of_shape(&matrix, 1);
        let mut eliminated = lu.order.clone();
        eliminated.sort_unstable();
        assert_eq!(eliminated, (0..side * side).collect::<Vec<_>>());
        let [low, high] = &lu.root.children[..] else { panic!("two halves") };
        let places = |front: &Front, from: usize| lu.order[from..front.first + front.count].to_vec();
        let (low_unknowns, high_unknowns) = (places(low, 0), places(high, low.first + low.count));
        for unknown in low_unknowns {
            let (_, tied) = matrix.row(unknown);
            assert!(!tied.iter().any(|other| high_unknowns.contains(&(*other as usize))));
        }
        assert_eq!(lu.root.count, 2 * side, "two rows of the square separate its halves");
    }
}
