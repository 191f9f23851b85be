//! Constant recovery: a point takes the value of its cell, `p_p = p_c`, or its own where the divergence is
//! taken at the points.

use crate::operators::recovery::points_in_cells::PointsInCells;

/// Value at a point of what is given at the cells.
#[inline]
pub fn value<const D: usize>(at: &PointsInCells<'_, D>, point: usize, sites: &[f64]) -> f64 {
    sites[at.cells.of_point[point]]
}

/// The cell of a point with its weight.
pub fn row<const D: usize>(at: &PointsInCells<'_, D>, point: usize) -> Vec<(usize, f64)> {
    vec![(at.cells.of_point[point], 1.0)]
}
