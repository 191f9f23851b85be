//! The order in which a sparse matrix is eliminated, and what each of its fronts holds.

use crate::direct_solver::dissection::dissect;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use std::ops::Range;

/// Unknowns that are eliminated together, with those that they are tied to.
#[derive(Clone, Debug)]
pub struct FrontShape {
    /// Place of its first unknown in the order of elimination.
    pub first: usize,
    /// Unknowns that it eliminates.
    pub count: usize,
    /// Unknowns behind them that they are tied to, as rising places in the order of elimination.
    pub boundary: Vec<usize>,
    /// Fronts whose remainders it takes up: the last ones before it that nobody has taken up.
    pub children: Vec<usize>,
    /// Entries of the matrix that belong to it, in [`Elimination::entries`].
    pub entries: Range<usize>,
}

impl FrontShape {
    /// Rows of the front.
    pub fn size(&self) -> usize {
        self.count + self.boundary.len()
    }

    /// Entries of its factors.
    pub fn factor_entries(&self) -> usize {
        self.count * (self.size() + self.boundary.len())
    }

    /// Entries of `L` in the rows that it eliminates, ones on the diagonal left out.
    pub fn within(&self) -> usize {
        self.count * self.count.saturating_sub(1) / 2
    }

    /// Entries of `L`.
    pub fn lower_entries(&self) -> usize {
        self.within() + self.count * self.boundary.len()
    }

    /// Entries of what it leaves to its parent.
    pub fn remainder_entries(&self) -> usize {
        self.boundary.len() * self.boundary.len()
    }
}

/// The order of elimination of a matrix.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// Unknown at each place in the order.
    pub order: Vec<usize>,
    /// Place of each unknown.
    pub place: Vec<usize>,
    /// The fronts, in order.
    pub fronts: Vec<FrontShape>,
    /// Entries of the matrix by row and number, front after front.
    pub entries: Vec<(u32, u32)>,
}

impl Elimination {
    /// Orders the unknowns of a matrix by nested dissection.
    pub fn of(matrix: &SparseMatrix) -> Self {
        let separators = dissect(matrix);
        let mut elimination = Self {
            order: Vec::new(),
            place: vec![0; matrix.positions().len()],
            fronts: Vec::new(),
            entries: Vec::new(),
        };
        for separator in &separators {
            for unknown in &separator.unknowns {
                elimination.place[*unknown] = elimination.order.len();
                elimination.order.push(*unknown);
            }
        }
        let mut first = 0;
        for separator in separators {
            let count = separator.unknowns.len();
            let boundary = elimination.boundary(matrix, first..first + count, &separator.children);
            let children = separator.children;
            elimination.fronts.push(FrontShape { first, count, boundary, children, entries: 0..0 });
            first += count;
        }
        elimination.share_entries(matrix);
        elimination
    }

    /// Unknowns behind a front that it is tied to, itself or through its children.
    fn boundary(&self, matrix: &SparseMatrix, own: Range<usize>, children: &[usize]) -> Vec<usize> {
        let tied = self.order[own.clone()].iter().flat_map(|unknown| matrix.row(*unknown).1);
        let mut boundary: Vec<usize> =
            tied.map(|other| self.place[*other as usize]).filter(|place| *place >= own.end).collect();
        for child in children {
            boundary.extend(self.fronts[*child].boundary.iter().filter(|place| **place >= own.end));
        }
        boundary.sort_unstable();
        boundary.dedup();
        boundary.shrink_to_fit();
        boundary
    }

    /// An entry belongs to the front that eliminates its row or its column first.
    fn share_entries(&mut self, matrix: &SparseMatrix) {
        let mut front_of = Vec::with_capacity(self.order.len());
        for (number, front) in self.fronts.iter().enumerate() {
            front_of.extend(std::iter::repeat_n(number, front.count));
        }
        let front_of_entry = |place: usize, column: u32| front_of[self.place[column as usize].min(place)];
        let mut counts = vec![0; self.fronts.len()];
        for (row, place) in self.place.iter().enumerate() {
            for column in matrix.row(row).1 {
                counts[front_of_entry(*place, *column)] += 1;
            }
        }
        let mut end = 0;
        for (front, count) in self.fronts.iter_mut().zip(counts) {
            front.entries = end..end;
            end += count;
        }
        let mut entries = vec![(0, 0); end];
        for (row, place) in self.place.iter().enumerate() {
            let (start, columns) = matrix.row(row);
            for (entry, column) in columns.iter().enumerate() {
                let own = &mut self.fronts[front_of_entry(*place, *column)].entries;
                let numbers = (u32::try_from(row), u32::try_from(start + entry));
                if let (Ok(row), Ok(entry)) = numbers {
                    entries[own.end] = (row, entry);
                    own.end += 1;
                }
            }
        }
        self.entries = entries;
    }
}
