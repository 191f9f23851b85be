//! Cell centres: occupancy, porosity and the divergence of selective reduced integration.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::state::grid::{GHOST_LAYERS, Grid, integer_part};
use crate::state::points::Points;
use crate::wide::{some_mut, wide};
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector};

/// Share of a cell that a domain must reach into it to count.
const LEAST_REACH: f64 = 1e-6;

/// Quantities of a cell from its points, by flat index.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells<const D: usize> {
    /// Cell of each point.
    pub of_point: Vec<usize>,
    /// Place of each point in cells, held inside the grid.
    pub place: Vec<Vector<D>>,
    /// Place of each point in its cell, from the lowest corner, in cells.
    pub within: Vec<Vector<D>>,
    /// Lowest node of each cell.
    first_node: Vec<usize>,
    /// Lowest node of the cell whose divergence each cell takes: its own, but for those beyond the end of
    /// splines at a free surface, where the field goes on as a line.
    divergence_node: Vec<usize>,
    /// Whether each cell holds a point.
    holds: Vec<bool>,
    /// Whether a point's domain reaches into each cell, and whether one did when the sides below were listed.
    reached: Vec<bool>,
    reached_before: Vec<bool>,
    /// Whether a point's domain reaches into the lower and the upper neighbour of each occupied cell along each direction.
    reached_sides: Vec<[[bool; 2]; D]>,
    /// Whether a neighbour of each occupied cell holds no point, where there is more than one cell in that direction.
    is_at_edge: Vec<bool>,
    /// Occupied cells in index order, and how many times they have changed.
    occupied: Vec<usize>,
    changes: usize,
    /// The change of the occupied cells that the sides and edges above belong to.
    listed_change: usize,
    /// Current volume of each cell's points, m^D.
    volume: Vec<f64>,
    /// Volume-weighted mean porosity of each occupied cell's points.
    pub porosity: Vec<f64>,
    /// Volume-weighted mean of the water's storage `n/K_w`, 1/Pa, of each occupied cell's points, where the body has soils
    /// of several kinds; none elsewhere.
    pub storage: Vec<f64>,
    /// Volume-weighted mean of the inverse deformation gradients of each occupied cell's points,
    /// where shape functions stay on the initial configuration.
    inverse_deformation: Vec<Tensor<D>>,
}

impl<const D: usize> Cells<D> {
    /// Room for the cells of a grid and for `points` points.
    pub fn new(grid: &Grid<D>, points: usize) -> Self {
        let count = grid.cell_count();
        let first_node: Vec<usize> = (0..count).map(|cell| grid.flat_node(&grid.cell_index(cell))).collect();
        Self {
            of_point: vec![0; points],
            place: vec![[0.0; D]; points],
            within: vec![[0.0; D]; points],
            divergence_node: first_node.clone(),
            first_node,
            holds: vec![false; count],
            reached: vec![false; count],
            reached_before: vec![false; count],
            reached_sides: vec![[[false; 2]; D]; count],
            is_at_edge: vec![false; count],
            occupied: Vec::with_capacity(count),
            changes: 0,
            listed_change: 0,
            volume: vec![0.0; count],
            porosity: vec![0.0; count],
            storage: Vec::new(),
            inverse_deformation: vec![[[0.0; D]; D]; count],
        }
    }

    /// Finds the cell of every point and sums volumes over each cell's points.
    pub fn locate(&mut self, grid: &Grid<D>, points: &Points<D>, soils: &[Material]) {
        let mut locating = self.begin_locating(points.len());
        wide!(for point in 0..points.len() {
            let [grains, pores] = points.volumes_of_phases(point);
            locating.locate(grid, point, &[points.position[point]], [&[grains], &[pores]]);
        });
        self.end_locating(points, soils);
    }

    /// Forgets where the points were, to find each of so many in turn.
    #[inline(always)]
    pub(crate) fn begin_locating(&mut self, points: usize) -> Locating<'_, D> {
        self.holds.fill(false);
        self.volume.fill(0.0);
        self.porosity.fill(0.0);
        let count = self.holds.len();
        Locating {
            cells: &mut self.of_point[..points],
            place: &mut self.place[..points],
            within: &mut self.within[..points],
            // Of one length, whose bounds are checked once.
            holds: &mut self.holds[..count],
            volume: &mut self.volume[..count],
            pore_volume: &mut self.porosity[..count],
        }
    }

    /// Lists the cells that the points were found in, and makes means of sums over them.
    pub(crate) fn end_locating(&mut self, points: &Points<D>, soils: &[Material]) {
        self.list_occupied();
        self.take_means(points, soils);
    }

    /// Lists the cells that hold points, which most steps leave as they were.
    fn list_occupied(&mut self) {
        let count = self.holds.iter().filter(|holds| **holds).count();
        if count == self.occupied.len() && self.occupied.iter().all(|cell| self.holds[*cell]) {
            return;
        }
        let holding = self.holds.iter().enumerate();
        self.occupied.clear();
        self.occupied.extend(holding.filter(|(_, holds)| **holds).map(|(cell, _)| cell));
        self.changes += 1;
    }

    /// How many times the occupied cells have changed: a list that depends on them alone is valid until the next change.
    #[inline]
    pub fn changes(&self) -> usize {
        self.changes
    }

    /// Finds the cells of other points among those that `holders` knows to hold the material, but for some that are
    /// closed: a point in none of them belongs to the next below that is one.
    pub fn locate_among(
        &mut self,
        grid: &Grid<D>,
        positions: &[Vector<D>],
        holders: &Self,
        is_closed: impl Fn(usize) -> bool,
    ) {
        self.holds.clone_from(&holders.holds);
        self.volume.clone_from(&holders.volume);
        self.porosity.clone_from(&holders.porosity);
        for cell in &holders.occupied {
            if is_closed(*cell) {
                self.holds[*cell] = false;
            }
        }
        self.of_point.truncate(positions.len());
        self.place.truncate(positions.len());
        self.within.truncate(positions.len());
        let down = grid.cell_stride()[D - 1];
        for (point, position) in positions.iter().enumerate() {
            let place = grid.held_in_cells(position);
            let home = grid.flat_cell(&grid.cell_at(&place));
            let mut cell = home;
            while !self.is_occupied(cell) && cell >= down {
                cell -= down;
            }
            let cell = if self.is_occupied(cell) { cell } else { home };
            self.place[point] = place;
            self.of_point[point] = cell;
            self.within[point] = grid.within_cell(&grid.whole_cell_at(&place), &place);
            self.within[point][D - 1] += ((home - cell) / down) as f64;
        }
        self.list_occupied();
    }

    /// Keeps of the cells those in which points were located, with the volumes of these, m^D: `volumes` times
    /// `shares`.
    pub fn keep_located(&mut self, volumes: &[f64], shares: &[f64]) {
        self.holds.fill(false);
        self.volume.fill(0.0);
        for (cell, (volume, share)) in self.of_point.iter().zip(volumes.iter().zip(shares)) {
            self.holds[*cell] = true;
            self.volume[*cell] += volume * share;
        }
        self.list_occupied();
    }

    /// Sums volumes over each cell's points, of cells that were [located](Self::locate).
    pub fn sum_volumes(&mut self, points: &Points<D>, soils: &[Material]) {
        self.volume.fill(0.0);
        self.porosity.fill(0.0);
        let count = points.len();
        let [initial, ratio, grains] =
            [&points.initial_volume, &points.volume_ratio, &points.grain_volume].map(|field| &field[..count]);
        let of_point = &self.of_point[..count];
        for point in 0..count {
            let (cell, volume) = (of_point[point], initial[point] * ratio[point]);
            self.volume[cell] += volume;
            // n V = V − (1 − n_0) V_0
            self.porosity[cell] += volume - grains[point];
        }
        self.take_means(points, soils);
    }

    /// Porosities of the cells from the sums of their pores, and in layers their storage.
    fn take_means(&mut self, points: &Points<D>, soils: &[Material]) {
        for cell in &self.occupied {
            self.porosity[*cell] /= self.volume[*cell];
        }
        if soils.len() > 1 {
            self.storage.resize(self.volume.len(), 0.0);
            self.storage.fill(0.0);
            for (point, cell) in self.of_point.iter().enumerate() {
                let soil = points.soil_among(soils, point);
                let share = points.volume(point) / self.volume[*cell];
                let porosity = soil.porosity_at(points.volume_ratio[point]);
                self.storage[*cell] += share * porosity / soil.water_bulk_modulus;
            }
        }
    }

    /// Finds the cells that the points' domains reach into: a cell may have lost its last point and
    /// still carry the edge of the material.
    pub fn find_reached(&mut self, grid: &Grid<D>, points: &Points<D>) {
        let has_changed = self.listed_change != self.changes;
        if has_changed {
            self.find_edges(grid);
            self.listed_change = self.changes;
        }
        std::mem::swap(&mut self.reached, &mut self.reached_before);
        self.reached.clone_from(&self.holds);
        let per_cell = grid.inverse_cell_size();
        for (point, home) in self.of_point.iter().enumerate() {
            if !self.is_at_edge[*home] {
                continue;
            }
            for d in 0..D {
                let stride = grid.cell_stride()[d];
                if grid.cells[d] == 1 || self.reached[home - stride] && self.reached[home + stride] {
                    continue;
                }
                // No domain is wider than a cell, so its ends are in this one or the next.
                let cell = grid.cell_at(&self.place[point])[d];
                let reach = points.half_length[point][d] * per_cell - LEAST_REACH;
                let inside = self.place[point][d] - cell as f64;
                if inside < reach && cell > GHOST_LAYERS {
                    self.reached[home - stride] = true;
                }
                if inside + reach >= 1.0 && cell + 1 < grid.cells[d] + GHOST_LAYERS {
                    self.reached[home + stride] = true;
                }
            }
        }
        if has_changed || self.reached != self.reached_before {
            for &cell in &self.occupied {
                let sides = |stride| [self.reached[cell - stride], self.reached[cell + stride]];
                self.reached_sides[cell] = grid.cell_stride().map(sides);
            }
        }
    }

    /// Finds which of the occupied cells are at an edge.
    fn find_edges(&mut self, grid: &Grid<D>) {
        for &cell in &self.occupied {
            self.is_at_edge[cell] = (0..D).any(|d| {
                let stride = grid.cell_stride()[d];
                grid.cells[d] > 1 && !(self.holds[cell - stride] && self.holds[cell + stride])
            });
        }
    }

    /// Which neighbours of each occupied cell are reached, `[cell][direction][lower and upper]`.
    #[inline]
    pub fn reached_sides(&self) -> &[[[bool; 2]; D]] {
        &self.reached_sides
    }

    /// Lowest node of each cell.
    #[inline]
    pub fn first_nodes(&self) -> &[usize] {
        &self.first_node
    }

    /// Whether a cell holds a point, or the edge of one's domain.
    #[inline]
    pub fn is_reached(&self, cell: usize) -> bool {
        self.reached[cell]
    }

    /// Means of the inverse deformation gradients over each cell's points.
    pub fn average_deformation(&mut self, points: &Points<D>) {
        self.inverse_deformation.fill([[0.0; D]; D]);
        let count = points.len();
        let [initial, ratio] = [&points.initial_volume, &points.volume_ratio].map(|field| &field[..count]);
        let (of_point, inverse) = (&self.of_point[..count], &points.inverse_deformation[..count]);
        for point in 0..count {
            let (cell, back) = (of_point[point], &inverse[point]);
            let share = initial[point] * ratio[point] / self.volume[cell];
            let sum = &mut self.inverse_deformation[cell];
            for i in 0..D {
                for j in 0..D {
                    sum[i][j] += share * back[i][j];
                }
            }
        }
    }

    /// Whether a cell holds a point.
    #[inline]
    pub fn is_occupied(&self, cell: usize) -> bool {
        self.holds[cell]
    }

    /// Current volume of a cell's points, m^D.
    #[inline]
    pub fn volume(&self, cell: usize) -> f64 {
        self.volume[cell]
    }

    /// Lowest node of a cell.
    #[inline]
    pub fn first_node(&self, cell: usize) -> usize {
        self.first_node[cell]
    }

    /// Occupied cells in index order.
    pub fn occupied(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        self.occupied.iter().copied()
    }

    /// Lets cells above a last node take the divergence of the cell below it.
    pub fn end_at(&mut self, grid: &Grid<D>, outermost: usize) {
        let (cell_stride, node_stride) = (grid.cell_stride()[D - 1], grid.node_stride()[D - 1]);
        for (cell, first_node) in self.first_node.iter().enumerate() {
            let above = (cell / cell_stride + 1).saturating_sub(outermost);
            self.divergence_node[cell] = first_node - above * node_stride;
        }
    }

    /// Visits the nodes of a cell with the gradients of their linear shape functions at its centre, 1/m: each direction
    /// averages over the 2^(D−1) edges along it.
    #[inline]
    pub fn visit_centre(&self, grid: &Grid<D>, cell: usize, mut visitor: impl FnMut(usize, Vector<D>)) {
        let slope = grid.inverse_cell_size() * 2.0 / (1_usize << D) as f64;
        for (corner, node) in grid.corners(self.divergence_node[cell]).enumerate() {
            visitor(node, std::array::from_fn(|d| if corner >> d & 1 == 1 { slope } else { -slope }));
        }
    }

    /// Divergence of a nodal field at the centre of a cell, by the linear shape functions, 1/m of
    /// the field.
    #[inline]
    pub fn centre_divergence(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> f64 {
        let mut divergence = 0.0;
        self.visit_centre(grid, cell, |node, gradient| {
            for d in 0..D {
                divergence += gradient[d] * field[node][d];
            }
        });
        divergence
    }

    /// Gradient of a nodal field there, `[component][direction]`, 1/m of the field.
    pub fn centre_gradient(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> Tensor<D> {
        let mut gradient = [[0.0; D]; D];
        self.visit_centre(grid, cell, |node, slopes| {
            for direction in 0..D {
                for component in 0..D {
                    gradient[component][direction] += slopes[direction] * field[node][component];
                }
            }
        });
        gradient
    }

    /// The nodes of that divergence with their coefficients, 1/m.
    pub fn centre_divergence_row(&self, grid: &Grid<D>, cell: usize) -> Vec<(usize, Vector<D>)> {
        let mut row = Vec::with_capacity(1 << D);
        self.visit_centre(grid, cell, |node, gradient| row.push((node, gradient)));
        row
    }

    /// Divergence at the centre of a cell on the deformed configuration, of a field on the initial one: its gradient
    /// there times the cell's inverse deformation gradient.
    pub fn deformed_centre_divergence(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> f64 {
        let gradient = self.centre_gradient(grid, cell, field);
        let inverse = &self.inverse_deformation[cell];
        (0..D).map(|d| (0..D).map(|e| gradient[d][e] * inverse[e][d]).sum::<f64>()).sum()
    }
}

/// Points on their way into cells.
pub(crate) struct Locating<'a, const D: usize> {
    cells: &'a mut [usize],
    place: &'a mut [Vector<D>],
    within: &'a mut [Vector<D>],
    holds: &'a mut [bool],
    volume: &'a mut [f64],
    pore_volume: &'a mut [f64],
}

impl<const D: usize> Locating<'_, D> {
    /// Finds the cells of `N` neighbours from one on at their positions, m, and adds their volumes of grains and pores,
    /// m^D. The indices of the cells, whole numbers, and the places in cells.
    #[inline(always)]
    pub fn locate<const N: usize>(
        &mut self,
        grid: &Grid<D>,
        first: usize,
        positions: &[Vector<D>; N],
        [grains, pores]: [&[f64; N]; 2],
    ) -> ([Vector<D>; N], [Vector<D>; N]) {
        let stride = grid.cell_stride().map(|stride| stride as f64);
        let ([mut indices, mut places, mut within], mut numbers) = ([*positions; 3], [0.0; N]);
        for p in 0..N {
            places[p] = grid.held_in_cells(&positions[p]);
            indices[p] = grid.whole_cell_at(&places[p]);
            within[p] = grid.within_cell(&indices[p], &places[p]);
            for d in 0..D {
                numbers[p] += indices[p][d] * stride[d];
            }
        }
        *some_mut(self.place, first) = places;
        *some_mut(self.within, first) = within;
        let cells = some_mut::<_, N>(self.cells, first);
        for p in 0..N {
            cells[p] = integer_part(numbers[p]);
        }
        // Neighbours are in one cell, or in few: its sums stay in registers from one to the next.
        let mut p = 0;
        while p < N {
            let cell = cells[p];
            let (mut volume, mut pore_volume) = (self.volume[cell], self.pore_volume[cell]);
            while p < N && cells[p] == cell {
                volume += grains[p] + pores[p];
                pore_volume += pores[p];
                p += 1;
            }
            self.holds[cell] = true;
            (self.volume[cell], self.pore_volume[cell]) = (volume, pore_volume);
        }
        (indices, places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_divergence_of_a_linear_field_is_exact_at_the_centre() {
        let grid = Grid::new(0.5, [3, 2]);
        let mut cells = Cells::new(&grid, 0);
        let field: Vec<Vector<2>> = (0..grid.node_count())
            .map(|node| {
                let [x, y] = grid.node_position(node);
                [2.0 * x + 7.0 * y, 5.0 * x - 0.5 * y]
            })
            .collect();
        let cell = grid.flat_cell(&grid.cell_of(&[0.7, 0.2]));
        assert!((cells.centre_divergence(&grid, cell, &field) - 1.5).abs() < 1e-13);
        let gradient = cells.centre_gradient(&grid, cell, &field);
        for (got, exact) in gradient.iter().flatten().zip([2.0, 7.0, 5.0, -0.5]) {
            assert!((got - exact).abs() < 1e-13, "{got} for {exact}");
        }
        // tr(∇v F⁻¹) with ∇v = [[2, 7], [5, −0.5]].
        cells.inverse_deformation[cell] = [[0.5, 0.25], [0.125, 2.0]];
        let expected = 2.0 * 0.5 + 7.0 * 0.125 + 5.0 * 0.25 - 0.5 * 2.0;
        assert!((cells.deformed_centre_divergence(&grid, cell, &field) - expected).abs() < 1e-13);
    }

    #[test]
    fn cells_found_again_are_those_found_at_first() {
        let grid = Grid::new(0.5, [4, 6]);
        let mut points = Points::lattice(0.5, [4, 4], 2);
        let mut again = Cells::new(&grid, points.len());
        // Points sink and rise by halves of their domains, row by row; some are left out of the lowest cells' rows.
        for step in 0..40 {
            for (point, place) in points.position.iter_mut().enumerate() {
                let along = 0.9 * (1.0 + (0.3 * f64::from(step) + 0.1 * (point / 8) as f64).sin());
                place[1] = points.initial_position[point][1] * 0.8 + 0.5 * along;
                place[0] = points.initial_position[point][0] * (1.0 - 0.004 * f64::from(step));
                points.volume_ratio[point] = 1.0 - 0.01 * along;
                points.half_length[point] = [0.125 * (1.0 - 0.004 * f64::from(step)), 0.1];
            }
            let mut first = Cells::new(&grid, points.len());
            for cells in [&mut again, &mut first] {
                points.take_soils(&[Material::default()]);
                cells.locate(&grid, &points, &[Material::default()]);
                cells.find_reached(&grid, &points);
            }
            assert_eq!(again.of_point, first.of_point, "step {step}");
            assert_eq!((&again.holds, &again.occupied), (&first.holds, &first.occupied));
            assert_eq!((&again.volume, &again.porosity), (&first.volume, &first.porosity), "step {step}");
            assert_eq!(again.reached, first.reached, "step {step}");
            for cell in first.occupied() {
                assert_eq!(again.reached_sides[cell], first.reached_sides[cell], "step {step}, cell {cell}");
                let of_cell = (0..points.len()).filter(|point| first.of_point[*point] == cell);
                let volume: f64 = of_cell.map(|point| points.volume(point)).sum();
                assert!((again.volume(cell) / volume - 1.0).abs() < 1e-14, "step {step}");
            }
        }
    }

    #[test]
    fn a_domain_reaches_into_the_empty_cell_beside_it() {
        let grid = Grid::new(0.5, [4]);
        for (shift, beyond) in [(0.5, None), (0.45, Some(2)), (0.55, Some(5))] {
            let mut points = Points::lattice(0.5, [2], 2);
            points.take_soils(&[Material::default()]);
            points.position.iter_mut().for_each(|place| place[0] += shift);
            let mut cells = Cells::new(&grid, points.len());
            cells.locate(&grid, &points, &[Material::default()]);
            cells.find_reached(&grid, &points);
            let reached = (0..grid.cell_count()).filter(|cell| cells.is_reached(*cell));
            assert!(reached.filter(|cell| ![3, 4].contains(cell)).eq(beyond), "moved by {shift} m");
        }
    }

    #[test]
    fn cells_know_their_points_and_porosity() {
        let grid = Grid::new(0.5, [4]);
        let mut points = Points::lattice(0.5, [2], 2);
        points.volume_ratio[0] = 0.9;
        let mut cells = Cells::new(&grid, points.len());
        points.take_soils(&[Material::default()]);
        cells.locate(&grid, &points, &[Material::default()]);
        assert!(cells.occupied().eq([2, 3]), "two ghosts below, the other cells empty");
        assert!((cells.porosity[3] - 0.3).abs() < 1e-15);
        assert!((cells.porosity[2] - (0.2 + 0.3) / 1.9).abs() < 1e-15);
        points.position.iter_mut().for_each(|place| place[0] += 0.5);
        cells.locate(&grid, &points, &[Material::default()]);
        assert!(cells.occupied().eq([3, 4]), "as many cells as before, but others");
    }
}
