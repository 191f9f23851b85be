//! Planes through the stresses of neighbouring cells: how stresses slope where points are.

use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::state::points::Points;
use oedometer_soil::tensor::{Tensor, Vector, inverse};

/// Effective stress, Pa, and pressure, Pa; or their sums, or their slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stresses<const D: usize> {
    /// Effective stress, tension positive.
    pub effective: Tensor<D>,
    /// Pressure, compression positive.
    pub pressure: f64,
}

impl<const D: usize> Stresses<D> {
    const NONE: Self = Self { effective: [[0.0; D]; D], pressure: 0.0 };

    /// Adds a share of others.
    #[inline]
    fn add(&mut self, share: f64, other: &Self) {
        for (sum, number) in self.effective.as_flattened_mut().iter_mut().zip(other.effective.as_flattened())
        {
            *sum += share * number;
        }
        self.pressure += share * other.pressure;
    }
}

/// Means over the points of each cell, and the planes through them; flat index = cell.
#[derive(Clone, Debug, PartialEq)]
pub struct StressPlanes<const D: usize> {
    /// Mean place of the cell's points, by volume, m.
    middles: Vec<Vector<D>>,
    /// Means of their stresses, Pa.
    means: Vec<Stresses<D>>,
    /// Slopes of the stresses along each direction, Pa/m.
    pub slopes: Vec<[Stresses<D>; D]>,
    /// Places of the nodes, m.
    pub nodes: Vec<Vector<D>>,
}

impl<const D: usize> StressPlanes<D> {
    /// Room for the cells of a grid.
    pub fn new(grid: &Grid<D>) -> Self {
        let count = grid.cell_count();
        Self {
            middles: vec![[0.0; D]; count],
            means: vec![Stresses::NONE; count],
            slopes: vec![[Stresses::NONE; D]; count],
            nodes: (0..grid.node_count()).map(|node| grid.node_position(node)).collect(),
        }
    }

    /// Fits the planes to the stresses of the points in the cells that they were last located in.
    pub fn fit(&mut self, grid: &Grid<D>, cells: &Cells<D>, points: &Points<D>) {
        for cell in cells.occupied() {
            (self.middles[cell], self.means[cell]) = ([0.0; D], Stresses::NONE);
        }
        for (point, cell) in cells.of_point.iter().enumerate() {
            let share = points.volume(point) / cells.volume(*cell);
            for d in 0..D {
                self.middles[*cell][d] += share * points.position[point][d];
            }
            let stresses =
                Stresses { effective: points.effective_stress[point], pressure: points.pressure[point] };
            self.means[*cell].add(share, &stresses);
        }
        for cell in cells.occupied() {
            self.slopes[cell] = self.slopes_of(grid, cells, cell);
        }
    }

    /// Slopes between both neighbours of a cell, or to the only one, along each direction: exact for planes wherever the
    /// middles of the cells' points are. None along a direction without neighbours.
    fn slopes_of(&self, grid: &Grid<D>, cells: &Cells<D>, cell: usize) -> [Stresses<D>; D] {
        let (mut apart, mut differences) = ([[0.0; D]; D], [Stresses::NONE; D]);
        for d in 0..D {
            let stride = grid.cell_stride()[d];
            let or_own = |other: usize| if cells.is_occupied(other) { other } else { cell };
            let (lower, upper) = (or_own(cell - stride), or_own(cell + stride));
            if lower == upper {
                apart[d][d] = 1.0;
                continue;
            }
            apart[d] = std::array::from_fn(|e| self.middles[upper][e] - self.middles[lower][e]);
            differences[d] = self.means[upper];
            differences[d].add(-1.0, &self.means[lower]);
        }
        let (back, _) = inverse(&apart);
        let mut slopes = [Stresses::NONE; D];
        for d in 0..D {
            for e in 0..D {
                slopes[d].add(back[d][e], &differences[e]);
            }
        }
        slopes
    }
}
