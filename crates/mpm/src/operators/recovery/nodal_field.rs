//! Pressure as a nodal field of its own: the mixed weak form of the continuity with the functions `N` of the
//! velocities, its mass lumped (after Chen, Zhang, Sze, Kan & Qiu 2018; docs/theory.md, Eq. 20).
//!
//! `p_j = Σ_p N_jp V_p p_p / Σ_p N_jp V_p` of the values at the points, then `p_p = Σ_j N_jp p_j`: the forces of the
//! second are the adjoint of the first. The nodal means do not see a divergence that changes its sign from cell
//! to cell, which stays at the points (the mode of Q1-Q1 elements).

use crate::operators::recovery::points_in_cells::PointsInCells;

/// Means at the nodes, `[node]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalField {
    mean: Vec<f64>,
    /// Volume of the points around each node, m^D.
    volume: Vec<f64>,
}

impl NodalField {
    /// Room for so many nodes.
    pub fn with_nodes(count: usize) -> Self {
        Self { mean: vec![0.0; count], volume: vec![0.0; count] }
    }

    /// Takes the means of what is given at the points.
    pub fn fit<const D: usize>(&mut self, at: &PointsInCells<'_, D>, sites: &[f64]) {
        self.mean.fill(0.0);
        self.volume.fill(0.0);
        for (point, site) in sites.iter().enumerate() {
            let volume = at.volume(point);
            at.basis.visit(at.grid.node_stride(), point, |node, weight, _| {
                self.mean[node] += weight * volume * site;
                self.volume[node] += weight * volume;
            });
        }
        for (mean, volume) in self.mean.iter_mut().zip(&self.volume) {
            if *volume > 0.0 {
                *mean /= volume;
            }
        }
    }

    /// Value of the means at a point.
    #[inline]
    pub fn value<const D: usize>(&self, at: &PointsInCells<'_, D>, point: usize) -> f64 {
        let mut value = 0.0;
        at.basis.visit(at.grid.node_stride(), point, |node, weight, _| value += weight * self.mean[node]);
        value
    }
}

/// The same as rows: the points that each point recovers its value from, with their weights.
pub fn rows<const D: usize>(at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
    let mut around: Vec<Vec<(usize, f64)>> = vec![Vec::new(); at.grid.node_count()];
    for point in 0..at.positions.len() {
        at.basis.visit(at.grid.node_stride(), point, |node, weight, _| {
            if weight > 0.0 {
                around[node].push((point, weight * at.volume(point)));
            }
        });
    }
    let totals: Vec<f64> = around.iter().map(|shares| shares.iter().map(|share| share.1).sum()).collect();
    let row = |point: usize| {
        let mut entries: Vec<(usize, f64)> = Vec::new();
        at.basis.visit(at.grid.node_stride(), point, |node, weight, _| {
            if weight > 0.0 {
                entries.extend(
                    around[node].iter().map(|(other, share)| (*other, weight * share / totals[node])),
                );
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::recovery::tests::{SiteBlock, applied};

    #[test]
    fn constants_are_kept_and_what_changes_sign_from_cell_to_cell_is_not_seen() {
        let block = SiteBlock::new(0.25, [6, 6], 2);
        let at = block.at();
        let mut field = NodalField::with_nodes(at.grid.node_count());
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
        let rows = rows(&at);
        for (point, place) in at.positions.iter().enumerate() {
            if place.iter().all(|x| (0.25..1.25).contains(x)) {
                assert!(field.value(&at, point).abs() < 1e-13, "{place:?}");
            }
            assert!((applied(&rows[point], &board) - field.value(&at, point)).abs() < 1e-13);
        }
    }

    #[test]
    fn recovery_and_force_are_adjoint() {
        // Σ V a R b = Σ V b R a: the operator is symmetric in the volumes of the points.
        let block = SiteBlock::new(0.5, [3, 2], 3);
        let at = block.at();
        let rows = rows(&at);
        for (point, row) in rows.iter().enumerate() {
            for (other, weight) in row {
                let back = rows[*other].iter().find(|entry| entry.0 == point).map_or(0.0, |entry| entry.1);
                assert!((at.volume(point) * weight - at.volume(*other) * back).abs() < 1e-15);
            }
        }
    }
}
