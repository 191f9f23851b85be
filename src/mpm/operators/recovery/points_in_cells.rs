//! Where the points are among cells and nodes: what every way of recovery looks at.

use crate::mpm::state::cells::Cells;
use crate::mpm::state::grid::Grid;
use crate::mpm::state::nodes::Nodes;
use crate::soil::tensor::Vector;

/// Where the points are among cells and nodes.
#[derive(Clone, Copy, Debug)]
pub struct PointsInCells<'a, const D: usize> {
    /// Background grid.
    pub grid: &'a Grid<D>,
    /// Cells with their volumes, and the cell of each point.
    pub cells: &'a Cells<D>,
    /// Nodes with their supports.
    pub nodes: &'a Nodes<D>,
    /// Places of the points, m, `[point][component]`.
    pub positions: &'a [Vector<D>],
}

impl<'a, const D: usize> PointsInCells<'a, D> {
    /// The parts of a body.
    #[inline]
    pub fn of(
        grid: &'a Grid<D>,
        cells: &'a Cells<D>,
        nodes: &'a Nodes<D>,
        positions: &'a [Vector<D>],
    ) -> Self {
        Self { grid, cells, nodes, positions }
    }
}
