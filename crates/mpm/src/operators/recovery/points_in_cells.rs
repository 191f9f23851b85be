//! Places of the points among cells and nodes, the input of every recovery.

use crate::operators::sparse_rows::entry_of;
use crate::operators::stencil::PointStencils;
use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

/// Places of the points among cells and nodes: the input of every recovery.
#[derive(Clone, Copy, Debug)]
pub struct PointsInCells<'a, const D: usize> {
    /// Background grid.
    pub grid: &'a Grid<D>,
    /// Cells with their volumes, and the cell of each point.
    pub cells: &'a Cells<D>,
    /// Nodes with their supports.
    pub nodes: &'a Nodes<D>,
    /// Shape functions between points and nodes.
    pub basis: &'a PointStencils<D>,
    /// Places of the points, m, `[point][component]`.
    pub positions: &'a [Vector<D>],
    /// Volumes of the points in another state, m^D, and their ratio to those.
    pub volumes: [&'a [f64]; 2],
}

impl<const D: usize> PointsInCells<'_, D> {
    /// Volume of a point, m^D.
    pub fn volume(&self, point: usize) -> f64 {
        self.volumes[0][point] * self.volumes[1][point]
    }

    /// Nodes around a point, ascending, with the values of their shape functions there.
    pub fn around(&self, point: usize) -> Vec<(usize, f64)> {
        let mut row = Vec::new();
        self.basis.visit(self.grid.node_stride(), point, |node, value, _| {
            if value != 0.0 {
                *entry_of(&mut row, node, 0.0) += value;
            }
        });
        row
    }
}

/// [`PointsInCells`] of a body, field by field: what is recovered may be another field of it.
macro_rules! points_in_cells {
    ($body:expr, $basis:expr) => {
        $crate::operators::recovery::points_in_cells::PointsInCells {
            grid: &$body.grid,
            cells: &$body.cells,
            nodes: &$body.nodes,
            basis: &$basis,
            positions: &$body.points.position,
            volumes: [&$body.points.initial_volume, &$body.points.volume_ratio],
        }
    };
}
pub(crate) use points_in_cells;
