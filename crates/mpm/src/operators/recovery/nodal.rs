//! Nodal recovery: means at the nodes of the values of their cells, interpolated to the points (Detournay &
//! Dzik 2006; Jassim, Stolle & Vermeer 2013).
//!
//! `p_i = Σ_c V_c p_c / Σ_c V_c` over the occupied cells `c` around node `i`, then `p_p = Σ_i N_i(x_p) p_i` with
//! the hats `N_i` of the point's cell.

use crate::operators::basis::{Hat, ShapeFunction};
use crate::operators::recovery::points_in_cells::PointsInCells;
use crate::operators::row::Row;

/// Means at the nodes, `[node]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalMeans {
    mean: Vec<f64>,
    /// Volume of the cells around each node.
    volume: Vec<f64>,
}

impl NodalMeans {
    /// Room for so many nodes.
    pub fn with_nodes(count: usize) -> Self {
        Self { mean: vec![0.0; count], volume: vec![0.0; count] }
    }

    /// Takes the means of what is given at the cells.
    pub fn fit<const D: usize>(&mut self, at: &PointsInCells<'_, D>, sites: &[f64]) {
        self.mean.fill(0.0);
        self.volume.fill(0.0);
        visit_corners(at, |node, cell| {
            self.mean[node] += at.cells.volume(cell) * sites[cell];
            self.volume[node] += at.cells.volume(cell);
        });
        for (mean, volume) in self.mean.iter_mut().zip(&self.volume) {
            if *volume > 0.0 {
                *mean /= volume;
            }
        }
    }

    /// Value of the means at a point.
    #[inline]
    pub fn value<const D: usize>(&self, at: &PointsInCells<'_, D>, point: usize) -> f64 {
        hats(at, point).map(|(node, weight)| weight * self.mean[node]).sum()
    }
}

/// The same as rows: the cells that each point recovers its value from, with their weights.
pub fn rows<const D: usize>(at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); at.grid.node_count()];
    visit_corners(at, |node, cell| around[node].push(cell));
    let row = |point: usize| {
        let mut row: Vec<(usize, f64)> = Vec::new();
        for (node, weight) in hats(at, point) {
            let total: f64 = around[node].iter().map(|cell| at.cells.volume(*cell)).sum();
            for cell in &around[node] {
                let share = weight * at.cells.volume(*cell) / total;
                match row.iter_mut().find(|entry| entry.0 == *cell) {
                    Some(entry) => entry.1 += share,
                    None => row.push((*cell, share)),
                }
            }
        }
        row
    };
    (0..at.positions.len()).map(row).collect()
}

/// Visits every occupied cell with each of its corner nodes: `(node, cell)`.
#[inline]
fn visit_corners<const D: usize>(at: &PointsInCells<'_, D>, mut visitor: impl FnMut(usize, usize)) {
    for cell in at.cells.occupied() {
        for node in at.grid.corners(at.cells.first_node(cell)) {
            visitor(node, cell);
        }
    }
}

/// Corners of a point's cell with the weights of their hats at the point.
#[inline]
fn hats<const D: usize>(
    at: &PointsInCells<'_, D>,
    point: usize,
) -> impl Iterator<Item = (usize, f64)> + use<D> {
    // Of the cell that the point belongs to, which for water above the last cell is the one below it.
    let (home, place) = (at.cells.of_point[point], at.grid.held_in_cells(&at.positions[point]));
    let cell = at.grid.cell_index(home);
    let rows: [Row<2>; D] = std::array::from_fn(|d| Hat::row(place[d], cell[d], 0.0));
    let nodes = at.grid.corners(at.cells.first_node(home));
    nodes
        .enumerate()
        .map(move |(corner, node)| (node, (0..D).map(|d| rows[d].weights[corner >> d & 1]).product()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::recovery::tests::{SiteBlock, applied};
    use oedometer_soil::tensor::Vector;

    #[test]
    fn nodal_means_reproduce_a_plane_inside_and_constants_everywhere() {
        let block = SiteBlock::new(0.25, [4, 4], 2);
        let at = block.at();
        let field = |x: &Vector<2>| 2.0 + 3.0 * x[0] - x[1];
        let sites: Vec<f64> =
            (0..at.grid.cell_count()).map(|cell| field(&at.grid.cell_centre(cell))).collect();
        let mut means = NodalMeans::with_nodes(at.grid.node_count());
        means.fit(&at, &sites);
        for (point, row) in rows(&at).iter().enumerate() {
            let (place, value) = (&at.positions[point], means.value(&at, point));
            assert!((row.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-14);
            assert!((applied(row, &sites) - value).abs() < 1e-13);
            if place.iter().all(|x| (0.25..0.75).contains(x)) {
                assert!((value - field(place)).abs() < 1e-13);
            }
        }
    }
}
