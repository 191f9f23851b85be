//! Nodal recovery: means at the nodes of the values at the sites, interpolated to the points.
//!
//! ```text
//! p_i = Σ_s W_is p_s / Σ_s W_is,    p_p = Σ_i S_ip p_i
//! ```
//!
//! Of values in cells (Detournay & Dzik 2006; Jassim, Stolle & Vermeer 2013) `W` is the volume of the cell at its
//! corners, and `S` are the hats of the point's cell. Of values at points it is the pressure as a nodal field of its own,
//! the mixed weak form of the continuity with the shape functions `N` of the velocities, its mass lumped (after Chen,
//! Zhang, Sze, Kan & Qiu 2018; docs/theory.md, Eq. 20): `W_ip = N_ip V_p`, `S = N`. The forces of the second are the
//! adjoint of the first. Nodal means do not see a divergence that changes its sign from cell to cell, which stays at the
//! points (the mode of Q1-Q1 elements).

use crate::operators::basis::{Hat, ShapeFunction};
use crate::operators::recovery::points_in_cells::PointsInCells;
use crate::operators::row::Row;

/// Sites of the values that are averaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sites {
    /// In the occupied cells.
    Cells,
    /// At the points.
    Points,
}

/// Means at the nodes, `[node]`.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalMeans {
    sites: Sites,
    mean: Vec<f64>,
    /// Volume around each node, m^D.
    volume: Vec<f64>,
}

impl NodalMeans {
    /// Room for `nodes` nodes.
    pub fn new(sites: Sites, nodes: usize) -> Self {
        Self { sites, mean: vec![0.0; nodes], volume: vec![0.0; nodes] }
    }

    /// Computes the means of the values at the sites.
    pub fn fit<const D: usize>(&mut self, at: &PointsInCells<'_, D>, values: &[f64]) {
        self.mean.fill(0.0);
        self.volume.fill(0.0);
        self.sites.visit(at, |site, node, volume| {
            self.mean[node] += volume * values[site];
            self.volume[node] += volume;
        });
        for (mean, volume) in self.mean.iter_mut().zip(&self.volume) {
            if *volume > 0.0 {
                *mean /= volume;
            }
        }
    }

    /// Value of the means at a point.
    pub fn value<const D: usize>(&self, at: &PointsInCells<'_, D>, point: usize) -> f64 {
        let mut value = 0.0;
        self.sites.visit_point(at, point, |node, share| value += share * self.mean[node]);
        value
    }

    /// The sites that each point recovers its value from, with their shares.
    pub fn rows<const D: usize>(&self, at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
        let mut around: Vec<Vec<(usize, f64)>> = vec![Vec::new(); at.grid.node_count()];
        self.sites.visit(at, |site, node, volume| {
            if volume > 0.0 {
                around[node].push((site, volume));
            }
        });
        let totals: Vec<f64> =
            around.iter().map(|volumes| volumes.iter().map(|entry| entry.1).sum()).collect();
        let row = |point: usize| {
            let mut entries: Vec<(usize, f64)> = Vec::new();
            self.sites.visit_point(at, point, |node, share| {
                let of_node = around[node].iter();
                entries.extend(of_node.map(|(site, volume)| (*site, share * volume / totals[node])));
            });
            entries.sort_by_key(|entry| entry.0);
            entries.dedup_by(|next, kept| {
                let is_same = next.0 == kept.0;
                if is_same {
                    kept.1 += next.1;
                }
                is_same
            });
            entries
        };
        (0..at.positions.len()).map(row).collect()
    }
}

impl Sites {
    /// Visits every site with each node that takes its value, and with what volume: `(site, node, volume)`.
    fn visit<const D: usize>(self, at: &PointsInCells<'_, D>, mut visitor: impl FnMut(usize, usize, f64)) {
        match self {
            Self::Cells => {
                for cell in at.cells.occupied() {
                    for node in at.grid.corners(at.cells.first_node(cell)) {
                        visitor(cell, node, at.cells.volume(cell));
                    }
                }
            }
            Self::Points => {
                for point in 0..at.positions.len() {
                    let volume = at.volume(point);
                    at.basis.visit(at.grid.node_stride(), point, |node, value, _| {
                        visitor(point, node, value * volume);
                    });
                }
            }
        }
    }

    /// Visits the nodes that a point takes its value from, with their shares.
    fn visit_point<const D: usize>(
        self,
        at: &PointsInCells<'_, D>,
        point: usize,
        mut visitor: impl FnMut(usize, f64),
    ) {
        match self {
            Self::Cells => {
                // Of the cell that the point belongs to, which for water above the last cell is the one below it.
                let (home, place) = (at.cells.of_point[point], at.grid.held_in_cells(&at.positions[point]));
                let cell = at.grid.cell_index(home);
                let rows: [Row<2>; D] = std::array::from_fn(|d| Hat::row(place[d], cell[d], 0.0));
                for (corner, node) in at.grid.corners(at.cells.first_node(home)).enumerate() {
                    visitor(node, (0..D).map(|d| rows[d].values[corner >> d & 1]).product());
                }
            }
            Self::Points => at.basis.visit(at.grid.node_stride(), point, |node, value, _| {
                if value > 0.0 {
                    visitor(node, value);
                }
            }),
        }
    }
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
        let mut means = NodalMeans::new(Sites::Cells, at.grid.node_count());
        means.fit(&at, &sites);
        for (point, row) in means.rows(&at).iter().enumerate() {
            let (place, value) = (&at.positions[point], means.value(&at, point));
            assert!((row.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-14);
            assert!((applied(row, &sites) - value).abs() < 1e-13);
            if place.iter().all(|x| (0.25..0.75).contains(x)) {
                assert!((value - field(place)).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_nodal_field_keeps_constants_and_does_not_see_a_checkerboard() {
        let block = SiteBlock::new(0.25, [6, 6], 2);
        let at = block.at();
        let mut field = NodalMeans::new(Sites::Points, at.grid.node_count());
        field.fit(&at, &vec![3.0; at.positions.len()]);
        for point in 0..at.positions.len() {
            assert!((field.value(&at, point) - 3.0).abs() < 1e-13);
        }
        // A checkerboard of cells has no mean at any node with four cells around it.
        let sign = |point: usize| {
            let [column, row] = at.grid.cell_of(&at.positions[point]);
            if (column + row) % 2 == 0 { 1.0 } else { -1.0 }
        };
        let board: Vec<f64> = (0..at.positions.len()).map(sign).collect();
        field.fit(&at, &board);
        let rows = field.rows(&at);
        for (point, place) in at.positions.iter().enumerate() {
            if place.iter().all(|x| (0.25..1.25).contains(x)) {
                assert!(field.value(&at, point).abs() < 1e-13, "{place:?}");
            }
            assert!((applied(&rows[point], &board) - field.value(&at, point)).abs() < 1e-13);
        }
    }

    #[test]
    fn recovery_and_force_of_a_nodal_field_are_adjoint() {
        // Σ V a R b = Σ V b R a: the operator is symmetric in the volumes of the points.
        let block = SiteBlock::new(0.5, [3, 2], 3);
        let at = block.at();
        let rows = NodalMeans::new(Sites::Points, at.grid.node_count()).rows(&at);
        for (point, row) in rows.iter().enumerate() {
            for (other, share) in row {
                let back = rows[*other].iter().find(|entry| entry.0 == point).map_or(0.0, |entry| entry.1);
                assert!((at.volume(point) * share - at.volume(*other) * back).abs() < 1e-15);
            }
        }
    }
}
