//! The load on the material's surface, wherever the points have carried it.

use super::grid::{Grid, Vector};
use super::nodes::Nodes;
use super::points::Points;
use super::shape;

/// How a load varies along the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LoadShape {
    /// The same everywhere.
    #[default]
    Uniform,
    /// `cos(πx/L)` of the initial place `x` along the first direction.
    Cosine {
        /// Half a wave's length `L`, m.
        length: f64,
    },
}

impl LoadShape {
    /// Mean of the shape over an edge about `middle` of half-length `half`, both in m.
    fn mean_over(self, middle: f64, half: f64) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Cosine { length } => {
                let (phase, reach) =
                    (std::f64::consts::PI * middle / length, std::f64::consts::PI * half / length);
                phase.cos() * reach.sin() / reach
            }
        }
    }
}

/// A pressure on the upper outline of the material.
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
    /// Load at each of them over `load`.
    shape: Vec<f64>,
    /// Sum of the squares of `shape`.
    squares: f64,
    /// Whether the edge follows the volume of the points because their domains do not.
    stretches: bool,
}

impl LoadedSurface {
    /// The surface of a lattice: the highest points of the initial configuration.
    pub fn of<const D: usize>(points: &Points<D>, load: f64) -> Self {
        let height = |point: usize| points.initial_position[point][D - 1];
        let highest = (0..points.len()).map(height).fold(f64::NEG_INFINITY, f64::max);
        let tolerance = 1e-9 * highest.abs();
        let top_points: Vec<usize> =
            (0..points.len()).filter(|point| height(*point) > highest - tolerance).collect();
        let count = top_points.len();
        Self { load, top_points, shape: vec![1.0; count], squares: count as f64, stretches: false }
    }

    /// The surface under a load that varies along it.
    #[must_use]
    pub fn shaped<const D: usize>(mut self, shape: LoadShape, points: &Points<D>) -> Self {
        let mean = |point: &usize| {
            shape.mean_over(points.initial_position[*point][0], points.half_length[*point][0])
        };
        self.shape = self.top_points.iter().map(mean).collect();
        self.squares = self.shape.iter().map(|factor| factor * factor).sum();
        self
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

    /// Height of the surface now, m, as much of it as has the load's shape: the mean over the
    /// width under a uniform load.
    pub fn height<const D: usize>(&self, points: &Points<D>) -> f64 {
        let heights = self.top_points.iter().map(|point| self.edge(points, *point)[D - 1]);
        let sum: f64 = heights.zip(&self.shape).map(|(height, factor)| factor * height).sum();
        sum / self.squares
    }

    /// Puts the load on the nodes as the external force of the mixture.
    pub fn apply<const D: usize>(&self, grid: &Grid<D>, points: &Points<D>, nodes: &mut Nodes<D>) {
        nodes.external_force.fill([0.0; D]);
        for (point, factor) in self.top_points.iter().zip(&self.shape) {
            let width: f64 = points.half_length[*point][..D - 1].iter().map(|half| 2.0 * half).product();
            let force = -self.load * factor * width;
            visit_hat(grid, &self.edge(points, *point), |node, weight| {
                nodes.external_force[node][D - 1] += weight * force;
            });
        }
    }

    /// Nodes that span the surface, with the weights of [`amplitude_of`](Self::amplitude_of).
    pub fn weights<const D: usize>(&self, grid: &Grid<D>, points: &Points<D>) -> Vec<(usize, f64)> {
        let mut weights = Vec::new();
        for (point, factor) in self.top_points.iter().zip(&self.shape) {
            let share = factor / self.squares;
            visit_hat(grid, &self.edge(points, *point), |node, weight| weights.push((node, share * weight)));
        }
        weights
    }

    /// Vertical component of a nodal vector field on the surface, as much of it as has the load's
    /// shape: the mean under a uniform load, the amplitude of the cosine under a cosine.
    pub fn amplitude_of<const D: usize>(
        &self,
        grid: &Grid<D>,
        points: &Points<D>,
        field: &[Vector<D>],
    ) -> f64 {
        let mut sum = 0.0;
        for (point, factor) in self.top_points.iter().zip(&self.shape) {
            visit_hat(grid, &self.edge(points, *point), |node, weight| {
                sum += factor * weight * field[node][D - 1];
            });
        }
        sum / self.squares
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
    fn a_cosine_load_has_no_resultant_and_its_own_amplitude() {
        let grid = Grid::new(0.25, [4, 5]);
        let points = Points::<2>::lattice(0.25, [4, 4], 2);
        let surface = LoadedSurface::of(&points, 3.0).shaped(LoadShape::Cosine { length: 1.0 }, &points);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let force = |node: usize| nodes.external_force[node][1];
        let total: f64 = (0..nodes.len()).map(force).sum();
        assert!(total.abs() < 1e-12);
        // ∫ q cos(πx) · cos(πx) dx = q/2, up to the hats' interpolation of the second cosine.
        let moment: f64 = (0..nodes.len())
            .map(|node| force(node) * (std::f64::consts::PI * grid.node_position(node)[0]).cos())
            .sum();
        assert!((moment / 1.5 + 1.0).abs() < 0.06, "{moment}");
        let field: Vec<Vector<2>> = (0..nodes.len())
            .map(|node| [0.0, 7.0 * (std::f64::consts::PI * grid.node_position(node)[0]).cos() + 2.0])
            .collect();
        assert!((surface.amplitude_of(&grid, &points, &field) / 7.0 - 1.0).abs() < 0.06);
        assert!((surface.mean_of(&grid, &points, &field) - 2.0).abs() < 1e-12);
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
