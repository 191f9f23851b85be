//! The load on the material's surface, wherever the points have carried it.

use super::grid::{Grid, Vector};
use super::nodes::Nodes;
use super::points::Points;
use super::shape;

/// A uniform pressure on the upper outline of the material.
///
/// It acts at the outer edge of the outermost points' domains and is spread with the hat weights
/// there. Left on a node, it errs once the top cell empties; spread over the top point, it costs
/// percents of settlement.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedSurface {
    /// Load `q`, Pa, compression positive, carried by the total stress.
    pub load: f64,
    /// The points of the topmost row.
    top_points: Vec<usize>,
    /// Whether the edge follows the volume of the points because their domains do not.
    stretches: bool,
}

impl LoadedSurface {
    /// The surface of a lattice: the highest points of the initial configuration.
    pub fn of<const D: usize>(points: &Points<D>, load: f64) -> Self {
        let height = |point: usize| points.initial_position[point][D - 1];
        let highest = (0..points.len()).map(height).fold(f64::NEG_INFINITY, f64::max);
        let tolerance = 1e-9 * highest.abs();
        let top_points = (0..points.len()).filter(|point| height(*point) > highest - tolerance).collect();
        Self { load, top_points, stretches: false }
    }

    /// The surface of points whose domains keep their length: the material's edge still follows.
    #[must_use]
    pub fn stretching(self, stretches: bool) -> Self {
        Self { stretches, ..self }
    }

    /// Middle of the upper edge of a point's share of the material.
    #[inline]
    fn edge<const D: usize>(&self, points: &Points<D>, point: usize) -> Vector<D> {
        let mut place = points.position[point];
        // An oedometer strains vertically only: its stretch is the volume ratio.
        let stretch = if self.stretches { points.volume_ratio[point] } else { 1.0 };
        place[D - 1] += stretch * points.half_length[point][D - 1];
        place
    }

    /// Height of the surface now, mean over its width, m.
    pub fn height<const D: usize>(&self, points: &Points<D>) -> f64 {
        let sum: f64 = self.top_points.iter().map(|point| self.edge(points, *point)[D - 1]).sum();
        sum / self.top_points.len() as f64
    }

    /// Puts the load on the nodes as the external force of the mixture.
    pub fn apply<const D: usize>(&self, grid: &Grid<D>, points: &Points<D>, nodes: &mut Nodes<D>) {
        nodes.external_force.fill([0.0; D]);
        for point in &self.top_points {
            let width: f64 = points.half_length[*point][..D - 1].iter().map(|half| 2.0 * half).product();
            let force = -self.load * width;
            visit_hat(grid, &self.edge(points, *point), |node, weight| {
                nodes.external_force[node][D - 1] += weight * force;
            });
        }
    }

    /// Nodes that span the surface, with the weights of a mean over it.
    pub fn weights<const D: usize>(&self, grid: &Grid<D>, points: &Points<D>) -> Vec<(usize, f64)> {
        let mut weights = Vec::new();
        let share = 1.0 / self.top_points.len() as f64;
        for point in &self.top_points {
            visit_hat(grid, &self.edge(points, *point), |node, weight| weights.push((node, share * weight)));
        }
        weights
    }

    /// Mean over the surface of a nodal vector field's vertical component.
    pub fn mean_of<const D: usize>(&self, grid: &Grid<D>, points: &Points<D>, field: &[Vector<D>]) -> f64 {
        let mut sum = 0.0;
        for point in &self.top_points {
            visit_hat(grid, &self.edge(points, *point), |node, weight| sum += weight * field[node][D - 1]);
        }
        sum / self.top_points.len() as f64
    }
}

/// Visits the corner nodes of the cell that holds a place, with the hat weights there.
#[inline]
fn visit_hat<const D: usize>(grid: &Grid<D>, place: &Vector<D>, mut node_visitor: impl FnMut(usize, f64)) {
    let cell = grid.cell_of(place);
    let rows: [shape::Row<2>; D] = std::array::from_fn(|d| shape::hat(grid.in_cells(place[d]), cell[d]));
    for corner in 0..1_usize << D {
        let mut node = 0;
        let mut weight = 1.0;
        for direction in 0..D {
            let upper = corner >> direction & 1;
            node += (rows[direction].first + upper) * grid.node_stride()[direction];
            weight *= rows[direction].weights[upper];
        }
        node_visitor(node, weight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::nodes::Support;

    #[test]
    fn the_load_is_whole_and_acts_where_the_surface_is() {
        let grid = Grid::new(0.1, [12]);
        let mut points = Points::lattice(0.1, [10], 2);
        let surface = LoadedSurface::of(&points, 5.0);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let top = grid.flat_node(&[12]);
        assert!(
            (nodes.external_force[top][0] + 5.0).abs() < 1e-9,
            "all on the node that lies in the surface"
        );
        // The surface sinks by a quarter of a cell: the node below takes a quarter.
        for place in &mut points.position {
            place[0] -= 0.025;
        }
        surface.apply(&grid, &points, &mut nodes);
        assert!((nodes.external_force[top][0] + 3.75).abs() < 1e-9);
        assert!((nodes.external_force[top - 1][0] + 1.25).abs() < 1e-9);
        assert!((surface.height(&points) - 0.975).abs() < 1e-12);
    }

    #[test]
    fn a_plane_surface_carries_load_times_width() {
        let grid = Grid::new(0.5, [2, 3]);
        let points = Points::<2>::lattice(0.5, [2, 2], 2);
        let surface = LoadedSurface::of(&points, 3.0);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let total: f64 = nodes.external_force.iter().map(|force| force[1]).sum();
        assert!((total + 3.0).abs() < 1e-12);
    }
}
