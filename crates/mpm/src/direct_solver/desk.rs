//! Where a thread factors front after front, and what waits there for the fronts to come.

use crate::direct_solver::elimination::{Elimination, FrontShape};
use crate::direct_solver::front::{Front, Panel};
use crate::direct_solver::singular::Singular;
use crate::direct_solver::sparse_matrix::SparseMatrix;
use crate::time_limit::TimeLimit;

/// The room of a thread.
#[derive(Clone, Debug)]
pub struct Desk {
    /// The front at work, `[size][size]`.
    front: Vec<f64>,
    /// Remainders that wait for their parents, the last on top.
    waiting: Vec<f64>,
    /// Row of the front at work of each place in the order of elimination.
    row_of_place: Vec<u32>,
    /// Neighbours in a child's remainder that are neighbours in the front at work.
    runs: Vec<Run>,
    panel: Panel,
    /// The part of a right-hand side that a front has.
    pub gathered: Vec<f64>,
}

/// Rows of a child's remainder, and columns, that lie side by side in its parent too.
#[derive(Clone, Copy, Debug)]
struct Run {
    in_child: usize,
    in_parent: usize,
    length: usize,
}

/// A matrix that is factored: its shape, its order and its entries by their numbers.
#[derive(Debug)]
pub struct Factored<'a, V> {
    /// The order.
    pub elimination: &'a Elimination,
    /// The shape.
    pub shape: &'a SparseMatrix,
    /// Gives an entry.
    pub value: V,
    /// When its factors are given up.
    pub time_limit: TimeLimit,
}

impl Desk {
    /// Room for every front of an elimination; memory is taken where it is used.
    pub fn of(elimination: &Elimination) -> Self {
        let (mut largest, mut waiting, mut most_waiting) = (0, 0, 0);
        for front in &elimination.fronts {
            largest = largest.max(front.size());
            let taken: usize =
                front.children.iter().map(|child| elimination.fronts[*child].remainder_entries()).sum();
            waiting = waiting - taken + front.remainder_entries();
            most_waiting = most_waiting.max(waiting);
        }
        Self {
            front: vec![0.0; largest * largest],
            waiting: Vec::with_capacity(most_waiting),
            row_of_place: vec![0; elimination.order.len()],
            runs: Vec::with_capacity(largest),
            panel: Panel::for_fronts_of(largest),
            gathered: vec![0.0; largest],
        }
    }

    /// Drops what waits.
    pub fn clear(&mut self) {
        self.waiting.clear();
    }

    /// Factors a front into its place among the factors and leaves its remainder on top of those that wait. The
    /// remainder of its last child may wait at another desk.
    ///
    /// # Errors
    /// [`Singular`] when it has no pivot for a column.
    pub fn factor_front<V: Fn(usize) -> f64>(
        &mut self,
        number: usize,
        matrix: &Factored<'_, V>,
        (factors, pivots): (&mut [f64], &mut [usize]),
        mut other: Option<&mut Self>,
    ) -> Result<(), Singular> {
        let fronts = &matrix.elimination.fronts;
        let shape = &fronts[number];
        let (count, size) = (shape.count, shape.size());
        if size == 0 {
            return Ok(()); // A cut that parted what was apart already.
        }
        if matrix.time_limit.is_over() {
            return Err(Singular { row: matrix.elimination.order[shape.first] });
        }
        self.gather(shape, matrix);
        let entries = &mut self.front[..size * size];
        for child in shape.children.iter().rev() {
            let waiting = other.take().map_or(&mut self.waiting, |other| &mut other.waiting);
            find_runs(&fronts[*child].boundary, &self.row_of_place, &mut self.runs);
            take_up_remainder(&fronts[*child], &self.runs, waiting, (&mut *entries, size));
        }
        Front { entries, size, panel: &mut self.panel }
            .eliminate(pivots)
            .map_err(|column| Singular { row: matrix.elimination.order[shape.first + column] })?;
        let (eliminated, behind) = entries.split_at(count * size);
        keep_factors(eliminated, behind, (count, size), factors);
        for row in behind.chunks_exact(size) {
            self.waiting.extend_from_slice(&row[count..]);
        }
        Ok(())
    }

    /// Fills the front at work with a front's own entries of the matrix.
    fn gather<V: Fn(usize) -> f64>(&mut self, shape: &FrontShape, matrix: &Factored<'_, V>) {
        let size = shape.size();
        let entries = &mut self.front[..size * size];
        entries.fill(0.0);
        let places = (shape.first..shape.first + shape.count).chain(shape.boundary.iter().copied());
        for (row, place) in (0..).zip(places) {
            self.row_of_place[place] = row;
        }
        let row_of = |unknown: usize| self.row_of_place[matrix.elimination.place[unknown]] as usize;
        for (row, entry) in &matrix.elimination.entries[shape.entries.clone()] {
            let entry = *entry as usize;
            entries[row_of(*row as usize) * size + row_of(matrix.shape.column(entry))] +=
                (matrix.value)(entry);
        }
    }
}

/// Keeps the rows of a front in the order in which a right-hand side goes through them: `L` within the rows that it
/// eliminates, `L` in those behind, then `U` from its last row to its first.
fn keep_factors(eliminated: &[f64], behind: &[f64], (count, size): (usize, usize), mut factors: &mut [f64]) {
    let mut keep = |row: &[f64]| {
        let (kept, rest) = std::mem::take(&mut factors).split_at_mut(row.len());
        kept.copy_from_slice(row);
        factors = rest;
    };
    for (row, entries) in eliminated.chunks_exact(size).enumerate() {
        keep(&entries[..row]);
    }
    for entries in behind.chunks_exact(size) {
        keep(&entries[..count]);
    }
    for (row, entries) in eliminated.chunks_exact(size).enumerate().rev() {
        keep(&entries[row..]);
    }
}

/// Finds the runs of a child's boundary in the front at work.
fn find_runs(boundary: &[usize], row_of_place: &[u32], runs: &mut Vec<Run>) {
    runs.clear();
    for (in_child, place) in boundary.iter().enumerate() {
        let in_parent = row_of_place[*place] as usize;
        match runs.last_mut() {
            Some(run) if run.in_parent + run.length == in_parent => run.length += 1,
            _ => runs.push(Run { in_child, in_parent, length: 1 }),
        }
    }
}

/// Adds the remainder of a child, the last of those that wait, to the front at work and takes it from them.
fn take_up_remainder(
    child: &FrontShape,
    runs: &[Run],
    waiting: &mut Vec<f64>,
    (entries, size): (&mut [f64], usize),
) {
    let bottom = waiting.len() - child.remainder_entries();
    let mut remainder = waiting[bottom..].chunks_exact(child.boundary.len().max(1));
    for rows in runs {
        let entries = entries[rows.in_parent * size..].chunks_exact_mut(size);
        for (entries, remainder) in entries.zip(remainder.by_ref()).take(rows.length) {
            for run in runs {
                let own = &mut entries[run.in_parent..][..run.length];
                for (entry, value) in own.iter_mut().zip(&remainder[run.in_child..]) {
                    *entry += value;
                }
            }
        }
    }
    waiting.truncate(bottom);
}
