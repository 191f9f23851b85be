//! Cell centres: occupancy, porosity and the divergence of selective reduced integration.

use super::grid::{Grid, Vector};
use super::points::Points;

/// What a cell knows of its points, flat index = cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// Cell of each point.
    pub of_point: Vec<usize>,
    /// Lowest node of each cell.
    first_node: Vec<usize>,
    /// Points in each cell.
    point_count: Vec<u32>,
    /// Current volume of each cell's points, m^D.
    volume: Vec<f64>,
    /// Volume-weighted mean porosity of each occupied cell's points.
    pub porosity: Vec<f64>,
    /// Increment of the pore pressure over the step, Pa.
    pub pressure_increment: Vec<f64>,
}

impl Cells {
    /// Room for the cells of a grid and for `points` points.
    pub fn new<const D: usize>(grid: &Grid<D>, points: usize) -> Self {
        let count = grid.cell_count();
        let mut first_node = vec![0; count];
        for (cell, node) in first_node.iter_mut().enumerate() {
            let mut rest = cell;
            for direction in (0..D).rev() {
                *node += rest / grid.cell_stride()[direction] * grid.node_stride()[direction];
                rest %= grid.cell_stride()[direction];
            }
        }
        Self {
            of_point: vec![0; points],
            first_node,
            point_count: vec![0; count],
            volume: vec![0.0; count],
            porosity: vec![0.0; count],
            pressure_increment: vec![0.0; count],
        }
    }

    /// Finds the cell of every point and sums volumes over each cell's points.
    pub fn locate<const D: usize>(&mut self, grid: &Grid<D>, points: &Points<D>, initial_porosity: f64) {
        self.point_count.fill(0);
        self.volume.fill(0.0);
        self.porosity.fill(0.0);
        self.pressure_increment.fill(0.0);
        for point in 0..points.len() {
            let cell = grid.flat_cell(&grid.cell_of(&points.position[point]));
            self.of_point[point] = cell;
            self.point_count[cell] += 1;
            let (initial, ratio) = (points.initial_volume[point], points.volume_ratio[point]);
            self.volume[cell] += initial * ratio;
            // n V = (J − (1 − n_0)) V_0
            self.porosity[cell] += initial * (ratio - (1.0 - initial_porosity));
        }
        for cell in 0..self.porosity.len() {
            if self.is_occupied(cell) {
                self.porosity[cell] /= self.volume[cell];
            }
        }
    }

    /// Whether a cell holds a point.
    #[inline]
    pub fn is_occupied(&self, cell: usize) -> bool {
        self.point_count[cell] > 0
    }

    /// Occupied cells in index order.
    pub fn occupied(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.point_count.len()).filter(|cell| self.is_occupied(*cell))
    }

    /// Divergence of a nodal field at the centre of a cell, by the linear shape functions, 1/m of
    /// the field.
    #[inline]
    pub fn centre_divergence<const D: usize>(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> f64 {
        let corners = 1_usize << D;
        let mut divergence = 0.0;
        for corner in 0..corners {
            let mut node = self.first_node[cell];
            for direction in 0..D {
                node += (corner >> direction & 1) * grid.node_stride()[direction];
            }
            for direction in 0..D {
                let sign = if corner >> direction & 1 == 1 { 1.0 } else { -1.0 };
                divergence += sign * field[node][direction];
            }
        }
        // Each direction averages over the 2^(D−1) edges along it.
        divergence * grid.inverse_cell_size() * 2.0 / corners as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_divergence_of_a_linear_field_is_exact_at_the_centre() {
        let grid = Grid::new(0.5, [3, 2]);
        let cells = Cells::new(&grid, 0);
        let field: Vec<Vector<2>> = (0..grid.node_count())
            .map(|node| {
                let [x, y] = grid.node_position(node);
                [2.0 * x + 7.0 * y, 5.0 * x - 0.5 * y]
            })
            .collect();
        let cell = grid.flat_cell(&grid.cell_of(&[0.7, 0.2]));
        assert!((cells.centre_divergence(&grid, cell, &field) - 1.5).abs() < 1e-13);
    }

    #[test]
    fn cells_know_their_points_and_porosity() {
        let grid = Grid::new(0.5, [4]);
        let mut points = Points::lattice(0.5, [2], 2);
        points.volume_ratio[0] = 0.9;
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, 0.3);
        let occupied: Vec<usize> = cells.occupied().collect();
        assert_eq!(occupied, [2, 3], "two ghosts below, the other cells empty");
        assert!((cells.porosity[3] - 0.3).abs() < 1e-15);
        assert!((cells.porosity[2] - (0.2 + 0.3) / 1.9).abs() < 1e-15);
    }
}
