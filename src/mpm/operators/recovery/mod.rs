//! From the sites of the divergence to the points: every way of `R` beside the paper's two.
//!
//! Nodal averaging, the null-space filter and the volumetric strain of B-bar need values kept
//! between sites and points; what a method does not need has no room here.

pub mod patch;

use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::method::{Method, PressureIntegration, Recovery};
use crate::mpm::operators::shape;
use crate::mpm::state::cells::Cells;
use crate::mpm::state::grid::Grid;
use crate::mpm::state::nodes::Nodes;
use crate::mpm::state::points::Points;
use crate::soil::tensor::{Tensor, Vector};

/// Values between sites and points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recovered<const D: usize> {
    /// Value at each point.
    pub at_points: Vec<f64>,
    /// Weighted sums, then means, at the nodes, and the sums of their weights.
    nodal: Vec<f64>,
    nodal_weight: Vec<f64>,
    /// What the null-space filter knows of each cell.
    planes: Vec<CellPlane<D>>,
}

/// Moments of the points of a cell and of their values: the plane through them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellPlane<const D: usize> {
    count: f64,
    place: Vector<D>,
    value: f64,
    spread: Tensor<D>,
    tilt: Vector<D>,
}

impl<const D: usize> CellPlane<D> {
    const EMPTY: Self =
        Self { count: 0.0, place: [0.0; D], value: 0.0, spread: [[0.0; D]; D], tilt: [0.0; D] };
}

impl<const D: usize> Recovered<D> {
    /// Room for what a method needs.
    pub fn of(grid: &Grid<D>, points: usize, method: &Method) -> Self {
        let room = |wanted: bool, count: usize| vec![0.0; if wanted { count } else { 0 }];
        let is_nodal = method.recovery == Recovery::Nodal;
        let is_filtered = method.recovery == Recovery::NullSpace;
        Self {
            at_points: room(method.keeps_recovered(), points),
            nodal: room(is_nodal, grid.node_count()),
            nodal_weight: room(is_nodal, grid.node_count()),
            planes: vec![CellPlane::EMPTY; if is_filtered { grid.cell_count() } else { 0 }],
        }
    }

    /// Means at the nodes of the values of their cells, weighted with volume, interpolated to the
    /// points by the hats.
    fn interpolate_nodal_means(
        &mut self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        points: &Points<D>,
        values: &[f64],
    ) {
        self.nodal.fill(0.0);
        self.nodal_weight.fill(0.0);
        for cell in cells.occupied() {
            for corner in grid.corners(cells.first_node(cell)) {
                self.nodal[corner] += cells.volume(cell) * values[cell];
                self.nodal_weight[corner] += cells.volume(cell);
            }
        }
        for (value, weight) in self.nodal.iter_mut().zip(&self.nodal_weight) {
            if *weight > 0.0 {
                *value /= weight;
            }
        }
        for (point, place) in points.position.iter().enumerate() {
            let weights = hat_weights(grid, place);
            let nodes = grid.corners(cells.first_node(cells.of_point[point]));
            self.at_points[point] = nodes.zip(weights).map(|(node, weight)| weight * self.nodal[node]).sum();
        }
    }

    /// Takes from the points' values the part that no force on the nodes of their cell feels.
    ///
    /// The forces of pressures `p` on the corners of a cell are `Σ V p ∇N`, and the gradients of the
    /// (bi)linear hats span the constants and the lines along the [felt slopes](felt_slopes): what is
    /// felt is the plane through the values (in one dimension their mean), by least squares; the rest
    /// is the null space.
    fn filter_null_space(&mut self, grid: &Grid<D>, cells: &Cells<D>, nodes: &Nodes<D>, points: &Points<D>) {
        self.planes.fill(CellPlane::EMPTY);
        for (point, place) in points.position.iter().enumerate() {
            let plane = &mut self.planes[cells.of_point[point]];
            plane.count += 1.0;
            plane.value += self.at_points[point];
            for d in 0..D {
                plane.place[d] += place[d];
            }
        }
        for plane in self.planes.iter_mut().filter(|plane| plane.count > 0.0) {
            plane.value /= plane.count;
            plane.place = plane.place.map(|sum| sum / plane.count);
        }
        for (point, place) in points.position.iter().enumerate() {
            let plane = &mut self.planes[cells.of_point[point]];
            let offset: Vector<D> = std::array::from_fn(|d| place[d] - plane.place[d]);
            let departure = self.at_points[point] - plane.value;
            for d in 0..D {
                plane.tilt[d] += offset[d] * departure;
                for e in 0..D {
                    plane.spread[d][e] += offset[d] * offset[e];
                }
            }
        }
        for (cell, plane) in self.planes.iter_mut().enumerate().filter(|(_, plane)| plane.count > 0.0) {
            let felt = felt_slopes(grid, nodes, cells.first_node(cell));
            plane.tilt = slope(&plane.spread, &plane.tilt, felt);
        }
        for (point, place) in points.position.iter().enumerate() {
            let plane = &self.planes[cells.of_point[point]];
            let rise: f64 = (0..D).map(|d| plane.tilt[d] * (place[d] - plane.place[d])).sum();
            self.at_points[point] = plane.value + rise;
        }
    }
}

/// Directions along which a slope of the pressure changes a force on the corners of a cell: forces
/// along one direction feel the slopes along all others, where a corner is free to follow them. Between
/// two rollers none is, and a cell of a plane is one of a column.
fn felt_slopes<const D: usize>(grid: &Grid<D>, nodes: &Nodes<D>, first_node: usize) -> [bool; D] {
    let follows: [bool; D] = std::array::from_fn(|d| {
        grid.corners(first_node).any(|node| nodes.free[node][d] > 0.0 || nodes.water_free[node][d] > 0.0)
    });
    std::array::from_fn(|d| (0..D).any(|other| other != d && follows[other]))
}

/// Slope of a plane from the spread of its places and the tilt of its values; a direction along
/// which the places do not differ, or that is not felt, has none.
fn slope<const D: usize>(spread: &Tensor<D>, tilt: &Vector<D>, felt: [bool; D]) -> Vector<D> {
    let (mut matrix, mut slope) = (*spread, *tilt);
    let largest = (0..D).map(|d| spread[d][d]).fold(0.0, f64::max);
    for i in 0..D {
        if !felt[i] || matrix[i][i] <= 1e-10 * largest {
            for row in &mut matrix {
                row[i] = 0.0;
            }
            matrix[i] = [0.0; D];
            matrix[i][i] = 1.0;
            slope[i] = 0.0;
        }
        for j in i + 1..D {
            let factor = matrix[j][i] / matrix[i][i];
            for k in i..D {
                matrix[j][k] -= factor * matrix[i][k];
            }
            slope[j] -= factor * slope[i];
        }
    }
    for i in (0..D).rev() {
        for j in i + 1..D {
            slope[i] -= matrix[i][j] * slope[j];
        }
        slope[i] /= matrix[i][i];
    }
    slope
}

/// Weights of the corners of a place's cell, in their order.
fn hat_weights<const D: usize>(grid: &Grid<D>, place: &Vector<D>) -> impl Iterator<Item = f64> + use<D> {
    let cell = grid.cell_of(place);
    let held = grid.held_in_cells(place);
    let rows: [shape::Row<2>; D] = std::array::from_fn(|d| shape::hat(held[d], cell[d]));
    (0..1_usize << D).map(move |corner| (0..D).map(|d| rows[d].weights[corner >> d & 1]).product())
}

impl Method {
    /// Whether values are kept between the sites and the points.
    pub fn keeps_recovered(&self) -> bool {
        self.strain.is_bbar() || matches!(self.recovery, Recovery::Nodal | Recovery::NullSpace)
    }
}

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Body<D, W, S> {
    /// Recovers the cells' values, or filters the points' own, into `recovered.at_points`.
    pub fn recover(&mut self) {
        let values = &self.cells.pressure_increment;
        match self.method.recovery {
            Recovery::Nodal => {
                self.recovered.interpolate_nodal_means(&self.grid, &self.cells, &self.points, values);
            }
            Recovery::NullSpace => {
                self.recovered.filter_null_space(&self.grid, &self.cells, &self.nodes, &self.points);
            }
            Recovery::Constant | Recovery::Patch => {
                for point in 0..self.points.len() {
                    self.recovered.at_points[point] = match self.method.recovery {
                        Recovery::Patch => self.patch.value(&self.grid, point, values),
                        _ => values[self.cells.of_point[point]],
                    };
                }
            }
        }
    }

    /// The skeleton's volumetric rate at the points by the method's own `D` and `R`, into
    /// `recovered.at_points`, 1/s: the trace that B-bar takes.
    pub fn recover_dilation_rates(&mut self) {
        match self.method.pressure {
            PressureIntegration::Points => {
                for point in 0..self.points.len() {
                    self.recovered.at_points[point] =
                        self.divergence_at_point(point, &self.nodes.solid_velocity);
                }
                if self.method.recovery != Recovery::NullSpace {
                    return;
                }
            }
            PressureIntegration::Sri => {
                for cell in 0..self.cells.pressure_increment.len() {
                    if self.cells.is_occupied(cell) {
                        self.cells.pressure_increment[cell] =
                            self.divergence_at_centre(cell, &self.nodes.solid_velocity);
                    }
                }
            }
            PressureIntegration::Mean => {
                self.average_over_cells(|body, point| {
                    body.divergence_at_point(point, &body.nodes.solid_velocity)
                });
            }
        }
        self.recover();
    }

    /// Means over the points of each cell, weighted with volume, into the cells' values.
    pub fn average_over_cells(&mut self, value: impl Fn(&Self, usize) -> f64) {
        self.cells.pressure_increment.fill(0.0);
        for point in 0..self.points.len() {
            let cell = self.cells.of_point[point];
            let share = self.points.volume(point) / self.cells.volume(cell);
            self.cells.pressure_increment[cell] += share * value(self, point);
        }
    }
}

/// Rows of nodal averaging: cells that a point recovers its value from, with their weights.
pub fn nodal_row<const D: usize>(
    grid: &Grid<D>,
    cells: &Cells<D>,
    points: &Points<D>,
    point: usize,
) -> Vec<(usize, f64)> {
    let place = &points.position[point];
    let home = grid.cell_of(place);
    let mut row: Vec<(usize, f64)> = Vec::new();
    for (corner, weight) in hat_weights(grid, place).enumerate() {
        // The cells around this corner of the point's own.
        let around = (0..1_usize << D).map(|side| {
            let cell: [usize; D] = std::array::from_fn(|d| home[d] + (corner >> d & 1) + (side >> d & 1) - 1);
            grid.flat_cell(&cell)
        });
        let occupied: Vec<usize> = around.filter(|cell| cells.is_occupied(*cell)).collect();
        let total: f64 = occupied.iter().map(|cell| cells.volume(*cell)).sum();
        for cell in occupied {
            let share = weight * cells.volume(cell) / total;
            match row.iter_mut().find(|entry| entry.0 == cell) {
                Some(entry) => entry.1 += share,
                None => row.push((cell, share)),
            }
        }
    }
    row
}

/// Rows of the null-space filter: what the points of a cell keep of each other's values.
pub fn filtered_rows<const D: usize>(
    grid: &Grid<D>,
    cells: &Cells<D>,
    nodes: &Nodes<D>,
    points: &Points<D>,
) -> Vec<Vec<(usize, f64)>> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); cells.pressure_increment.len()];
    for (point, cell) in cells.of_point.iter().enumerate() {
        members[*cell].push(point);
    }
    (0..points.len())
        .map(|point| {
            let own = &members[cells.of_point[point]];
            let count = own.len() as f64;
            let mean: Vector<D> = std::array::from_fn(|d| {
                own.iter().map(|other| points.position[*other][d]).sum::<f64>() / count
            });
            let offset =
                |other: usize| -> Vector<D> { std::array::from_fn(|d| points.position[other][d] - mean[d]) };
            let mut spread = [[0.0; D]; D];
            for other in own {
                let offset = offset(*other);
                for d in 0..D {
                    for e in 0..D {
                        spread[d][e] += offset[d] * offset[e];
                    }
                }
            }
            let felt = felt_slopes(grid, nodes, cells.first_node(cells.of_point[point]));
            let reach = slope(&spread, &offset(point), felt);
            let share = |other: &usize| {
                let along = offset(*other);
                (*other, 1.0 / count + (0..D).map(|d| reach[d] * along[d]).sum::<f64>())
            };
            own.iter().map(share).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::state::nodes::Support;

    /// A row applied to values.
    fn applied(row: &[(usize, f64)], values: &[f64]) -> f64 {
        row.iter().map(|(place, weight)| weight * values[*place]).sum()
    }

    #[test]
    fn the_filter_keeps_what_forces_feel_and_nothing_else() {
        let grid = Grid::new(0.5, [2, 2]);
        let points = Points::<2>::lattice(0.5, [2, 2], 3);
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, 0.3);
        let mut nodes = Nodes::new(&grid, &Support::free(), 1.0);
        nodes.solid_mass.fill(1.0);
        nodes.finish_masses();
        let rows = filtered_rows(&grid, &cells, &nodes, &points);
        let values: Vec<f64> = (0..points.len()).map(|point| (1.7 * point as f64).sin()).collect();
        let filtered: Vec<f64> = rows.iter().map(|row| applied(row, &values)).collect();
        // Forces Σ V p ∇N of the corners of each cell.
        let force = |values: &[f64], cell: usize, corner: usize| -> Vector<2> {
            let mut force = [0.0; 2];
            for (point, place) in points.position.iter().enumerate() {
                if cells.of_point[point] != cell {
                    continue;
                }
                let home = grid.cell_of(place);
                let rows: [shape::Row<2>; 2] =
                    std::array::from_fn(|d| shape::hat(grid.in_cells(place[d]), home[d]));
                let (i, j) = (corner & 1, corner >> 1);
                force[0] += values[point] * rows[0].gradients[i] * rows[1].weights[j];
                force[1] += values[point] * rows[0].weights[i] * rows[1].gradients[j];
            }
            force
        };
        for cell in cells.occupied() {
            for corner in 0..4 {
                let (before, after) = (force(&values, cell, corner), force(&filtered, cell, corner));
                assert!((before[0] - after[0]).abs() < 1e-12 && (before[1] - after[1]).abs() < 1e-12);
            }
        }
        // A projection: a second time takes nothing; and what it took was not nothing.
        let again: Vec<f64> = rows.iter().map(|row| applied(row, &filtered)).collect();
        let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(change(&again, &filtered) < 1e-12 && change(&filtered, &values) > 0.1);
        let mut recovered = Recovered { at_points: values, ..Recovered::default() };
        recovered.planes = vec![CellPlane::EMPTY; grid.cell_count()];
        recovered.filter_null_space(&grid, &cells, &nodes, &points);
        assert!(change(&recovered.at_points, &filtered) < 1e-12, "rows and filter are one");
        // Between rollers no force along x is felt, nor what it would feel: slopes along y.
        let mut narrow = nodes;
        for free in [&mut narrow.free, &mut narrow.water_free] {
            free.fill([0.0, 1.0]);
        }
        assert_eq!(felt_slopes(&grid, &narrow, cells.first_node(cells.of_point[0])), [true, false]);
    }

    #[test]
    fn nodal_means_reproduce_a_plane_inside_and_constants_everywhere() {
        let grid = Grid::new(0.25, [4, 4]);
        let points = Points::<2>::lattice(0.25, [4, 4], 2);
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, 0.3);
        let field = |x: &Vector<2>| 2.0 + 3.0 * x[0] - x[1];
        let values: Vec<f64> = (0..grid.cell_count()).map(|cell| field(&grid.cell_centre(cell))).collect();
        let method = Method::named("GIMP-SRI-nodal").expect("a known method");
        let mut recovered = Recovered::of(&grid, points.len(), &method);
        recovered.interpolate_nodal_means(&grid, &cells, &points, &values);
        for (point, place) in points.position.iter().enumerate() {
            let row = nodal_row(&grid, &cells, &points, point);
            assert!((row.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-14);
            assert!((applied(&row, &values) - recovered.at_points[point]).abs() < 1e-13);
            if place.iter().all(|x| (0.25..0.75).contains(x)) {
                assert!((recovered.at_points[point] - field(place)).abs() < 1e-13);
            }
        }
    }
}
