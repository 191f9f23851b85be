//! Cell centres: occupancy, porosity and the divergence of selective reduced integration.

use crate::state::grid::{GHOST_LAYERS, Grid, Line, index_of};
use crate::state::points::Points;
use crate::wide::wide;
use oedometer_soil::tensor::{Tensor, Vector};
use std::ops::Range;

/// Share of a cell that a domain must reach into it to count.
const LEAST_REACH: f64 = 1e-6;

/// What a cell knows of its points, flat index = cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells<const D: usize> {
    /// Cell of each point.
    pub of_point: Vec<usize>,
    /// Place of each point in cells, held inside the grid.
    pub place: Vec<Vector<D>>,
    /// Lowest node of each cell.
    first_node: Vec<usize>,
    /// Lowest node of the cell whose divergence each cell takes: its own, but for those beyond the end of
    /// splines at a free surface, where the field goes on as a line.
    divergence_node: Vec<usize>,
    /// Points in each cell.
    point_count: Vec<usize>,
    /// Runs of neighbouring points that share a cell, with it.
    runs: Vec<(usize, Range<usize>)>,
    /// Initial volume of the points of each run, m^D.
    initial_volume: Vec<f64>,
    /// Whether the runs and the counts are those of the points' cells as they stand.
    are_counted: bool,
    /// Whether points may belong to another cell than the one that they lie in.
    has_strays: bool,
    /// Whether a point's domain reaches into each cell.
    reached: Vec<bool>,
    /// Whether a domain reaches into both neighbours of each cell in every direction.
    reached_around: Vec<bool>,
    /// Whether each cell is occupied, and whether it has an empty neighbour in the grid besides.
    holds: Vec<bool>,
    at_edge: Vec<bool>,
    /// The cells that domains reach into while they are looked for, and which of the occupations they were found of.
    reached_now: Vec<bool>,
    reached_of: Option<u64>,
    /// Occupied cells in index order, and how often they have changed.
    occupied: Vec<usize>,
    occupations: u64,
    /// Which of the occupations the volumes of empty cells are zero of.
    volumes_of: Option<u64>,
    /// Current volume of each cell's points, m^D.
    volume: Vec<f64>,
    /// Volume-weighted mean porosity of each occupied cell's points.
    pub porosity: Vec<f64>,
    /// Volume-weighted mean of the inverse deformation gradients of each occupied cell's points,
    /// where weights stay on the initial configuration.
    inverse_deformation: Vec<Tensor<D>>,
}

impl<const D: usize> Cells<D> {
    /// Room for the cells of a grid and for `points` points.
    pub fn new(grid: &Grid<D>, points: usize) -> Self {
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
            place: vec![[0.0; D]; points],
            divergence_node: first_node.clone(),
            first_node,
            point_count: vec![0; count],
            runs: Vec::with_capacity(points),
            initial_volume: Vec::with_capacity(points),
            are_counted: false,
            has_strays: false,
            reached: vec![false; count],
            reached_around: vec![false; count],
            holds: vec![false; count],
            at_edge: vec![false; count],
            reached_now: vec![false; count],
            reached_of: None,
            occupied: Vec::with_capacity(count),
            occupations: 0,
            volumes_of: None,
            volume: vec![0.0; count],
            porosity: vec![0.0; count],
            inverse_deformation: vec![[[0.0; D]; D]; count],
        }
    }

    /// Finds the cell of every point and sums volumes over each cell's points.
    pub fn locate(&mut self, grid: &Grid<D>, points: &Points<D>, initial_porosity: f64) {
        let have_crossed = wide!(self.find_places(grid, &points.position));
        if have_crossed || !self.are_counted {
            self.find_runs();
            self.point_count.fill(0);
            for (cell, run) in &self.runs {
                self.point_count[*cell] += run.len();
            }
            let of_run =
                |(_, run): &(usize, Range<usize>)| points.initial_volume[run.clone()].iter().sum::<f64>();
            self.initial_volume.extend(self.runs.iter().map(of_run));
            self.list_occupied();
            self.are_counted = true;
        }
        self.sum_volumes(points, initial_porosity);
    }

    /// Place and cell of every point; whether one has another cell than before.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn find_places(&mut self, grid: &Grid<D>, positions: &[Vector<D>]) -> bool {
        let lines: [Line; D] = std::array::from_fn(|direction| grid.line(direction));
        let strides = grid.cell_stride().map(|stride| stride as f64);
        let found = self.of_point.iter_mut().zip(&mut self.place);
        let mut have_crossed = false;
        for (position, (of_point, place)) in positions.iter().zip(found) {
            let mut cell = 0.0;
            for d in 0..D {
                place[d] = lines[d].held_in_cells(position[d]);
                cell += strides[d] * lines[d].cell_at(place[d]);
            }
            let cell = index_of(cell);
            have_crossed |= cell != *of_point;
            *of_point = cell;
        }
        have_crossed
    }

    /// Finds the runs of neighbouring points that share a cell: the points of a cell follow each other, but where rows
    /// of points cross several cells.
    fn find_runs(&mut self) {
        self.runs.clear();
        self.initial_volume.clear();
        let mut start = 0;
        while let Some(cell) = self.of_point.get(start) {
            let rest = self.of_point[start..].iter();
            let end = start + rest.take_while(|other| *other == cell).count();
            self.runs.push((*cell, start..end));
            start = end;
        }
    }

    /// Lists the cells that hold points.
    fn list_occupied(&mut self) {
        let counts = self.point_count.iter().enumerate();
        let found = counts.filter(|(_, count)| **count > 0).map(|(cell, _)| cell);
        if !found.clone().eq(self.occupied.iter().copied()) {
            self.occupied.clear();
            self.occupied.extend(found);
            self.occupations += 1;
        }
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
        self.point_count.clone_from(&holders.point_count);
        self.volume.clone_from(&holders.volume);
        self.porosity.clone_from(&holders.porosity);
        for cell in 0..self.point_count.len() {
            if self.is_occupied(cell) && is_closed(cell) {
                self.point_count[cell] = 0;
            }
        }
        self.of_point.truncate(positions.len());
        self.place.truncate(positions.len());
        let down = grid.cell_stride()[D - 1];
        for (point, position) in positions.iter().enumerate() {
            let place = grid.held_in_cells(position);
            let home = grid.flat_cell(&grid.cell_at(&place));
            let mut cell = home;
            while !self.is_occupied(cell) && cell >= down {
                cell -= down;
            }
            self.place[point] = place;
            self.of_point[point] = if self.is_occupied(cell) { cell } else { home };
        }
        self.find_runs();
        self.has_strays = true;
        (self.are_counted, self.volumes_of) = (false, None);
        self.list_occupied();
    }

    /// Keeps of the cells those in which points were located, with the volumes of these, m^D: `volumes` times
    /// `shares`.
    pub fn keep_located(&mut self, volumes: &[f64], shares: &[f64]) {
        (self.are_counted, self.volumes_of) = (false, None);
        self.point_count.fill(0);
        self.volume.fill(0.0);
        for (cell, (volume, share)) in self.of_point.iter().zip(volumes.iter().zip(shares)) {
            self.point_count[*cell] += 1;
            self.volume[*cell] += volume * share;
        }
        self.list_occupied();
    }

    /// Sums volumes over each cell's points.
    ///
    /// # Panics
    ///
    /// Where the points were not [located](Self::locate) last, but in some other way.
    pub fn sum_volumes(&mut self, points: &Points<D>, initial_porosity: f64) {
        let solid_fraction = 1.0 - initial_porosity;
        let (initial_volume, ratios) = (&points.initial_volume[..], &points.volume_ratio[..points.len()]);
        // Where each cell has one run, its sums begin with it.
        let is_at_once = self.runs.len() == self.occupied.len();
        if !is_at_once || self.volumes_of != Some(self.occupations) {
            self.volume.fill(0.0);
            self.porosity.fill(0.0);
            self.volumes_of = Some(self.occupations);
        }
        assert_eq!(self.runs.len(), self.initial_volume.len(), "an initial volume per run");
        for ((cell, run), initial) in self.runs.iter().zip(&self.initial_volume) {
            let of_points = initial_volume[run.clone()].iter().zip(&ratios[run.clone()]);
            let volume: f64 = of_points.map(|(initial, ratio)| initial * ratio).sum();
            // n V = V − (1 − n_0) V_0
            let pores = volume - solid_fraction * initial;
            if is_at_once {
                (self.volume[*cell], self.porosity[*cell]) = (volume, pores / volume);
            } else {
                self.volume[*cell] += volume;
                self.porosity[*cell] += pores;
            }
        }
        if !is_at_once {
            for cell in &self.occupied {
                self.porosity[*cell] /= self.volume[*cell];
            }
        }
    }

    /// Finds the cells that the points' domains reach into: a cell may have lost its last point and
    /// still carry the edge of the material.
    pub fn find_reached(&mut self, grid: &Grid<D>, points: &Points<D>) {
        let have_changed = self.reached_of.replace(self.occupations) != Some(self.occupations);
        if have_changed {
            self.find_edges(grid);
        }
        self.reached_now.copy_from_slice(&self.holds);
        let per_cell = grid.inverse_cell_size();
        let (reached, at_edge, places) = (&mut self.reached_now, &self.at_edge, &self.place);
        for (home, run) in self.runs.iter().filter(|(home, _)| at_edge[*home]) {
            for (place, half_length) in places[run.clone()].iter().zip(&points.half_length[run.clone()]) {
                let cell = grid.cell_at(place);
                for direction in 0..D {
                    // No domain is wider than a cell, so its ends are in this one or the next.
                    let reach = half_length[direction] * per_cell - LEAST_REACH;
                    let inside = place[direction] - cell[direction] as f64;
                    let stride = grid.cell_stride()[direction];
                    if inside < reach && cell[direction] > GHOST_LAYERS {
                        reached[home - stride] = true;
                    }
                    if inside + reach >= 1.0 && cell[direction] + 1 < grid.cells[direction] + GHOST_LAYERS {
                        reached[home + stride] = true;
                    }
                }
            }
        }
        if !have_changed && self.reached_now == self.reached {
            return;
        }
        std::mem::swap(&mut self.reached, &mut self.reached_now);
        for cell in &self.occupied {
            let is_between = |stride: &usize| self.reached[cell - stride] && self.reached[cell + stride];
            self.reached_around[*cell] = grid.cell_stride().iter().all(is_between);
        }
    }

    /// Finds the occupied cells that have an empty neighbour in the grid.
    fn find_edges(&mut self, grid: &Grid<D>) {
        for (holds, count) in self.holds.iter_mut().zip(&self.point_count) {
            *holds = *count > 0;
        }
        for cell in &self.occupied {
            let index = grid.cell_index(*cell);
            self.at_edge[*cell] = (0..D).any(|d| {
                let stride = grid.cell_stride()[d];
                let is_alone_below = index[d] > GHOST_LAYERS && !self.holds[cell - stride];
                let is_alone_above =
                    index[d] + 1 < grid.cells[d] + GHOST_LAYERS && !self.holds[cell + stride];
                is_alone_below || is_alone_above
            });
        }
    }

    /// Runs of neighbouring points that share a cell, with it.
    #[inline]
    pub fn runs(&self) -> &[(usize, Range<usize>)] {
        &self.runs
    }

    /// Whether points may belong to another cell than the one that they lie in.
    #[inline]
    pub fn has_strays(&self) -> bool {
        self.has_strays
    }

    /// Whether domains reach into all neighbours of an occupied cell.
    #[inline]
    pub fn is_reached_around(&self, cell: usize) -> bool {
        self.reached_around[cell]
    }

    /// Whether a cell holds a point, or the edge of one's domain.
    #[inline]
    pub fn is_reached(&self, cell: usize) -> bool {
        self.reached[cell]
    }

    /// Means of the inverse deformation gradients over each cell's points.
    pub fn average_deformation(&mut self, points: &Points<D>) {
        self.inverse_deformation.fill([[0.0; D]; D]);
        for point in 0..points.len() {
            let cell = self.of_point[point];
            let share = points.volume(point) / self.volume[cell];
            for i in 0..D {
                for j in 0..D {
                    self.inverse_deformation[cell][i][j] += share * points.inverse_deformation[point][i][j];
                }
            }
        }
    }

    /// Whether a cell holds a point.
    #[inline]
    pub fn is_occupied(&self, cell: usize) -> bool {
        self.point_count[cell] > 0
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

    /// How often the occupied cells have changed: what hangs on them alone stands while this does.
    #[inline]
    pub fn occupations(&self) -> u64 {
        self.occupations
    }

    /// Lets cells above a last node take the divergence of the cell below it.
    pub fn end_at(&mut self, grid: &Grid<D>, outermost: usize) {
        let (cell_stride, node_stride) = (grid.cell_stride()[D - 1], grid.node_stride()[D - 1]);
        for (cell, first_node) in self.first_node.iter().enumerate() {
            let above = (cell / cell_stride + 1).saturating_sub(outermost);
            self.divergence_node[cell] = first_node - above * node_stride;
        }
    }

    /// Divergence of a nodal field at the centre of a cell, by the linear shape functions, 1/m of
    /// the field.
    #[inline]
    pub fn centre_divergence(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> f64 {
        if D == 1 {
            let ends = &field[self.divergence_node[cell]..][..2];
            return (ends[1][0] - ends[0][0]) * share_of_corner(grid);
        }
        let mut divergence = 0.0;
        for (corner, node) in grid.corners(self.divergence_node[cell]).enumerate() {
            for direction in 0..D {
                divergence += side(corner, direction) * field[node][direction];
            }
        }
        divergence * share_of_corner(grid)
    }

    /// Visits the nodes of a cell with the gradients of their linear shape functions at its centre, 1/m.
    #[inline]
    pub fn visit_centre(&self, grid: &Grid<D>, cell: usize, mut visitor: impl FnMut(usize, Vector<D>)) {
        let share = share_of_corner(grid);
        for (corner, node) in grid.corners(self.divergence_node[cell]).enumerate() {
            visitor(node, std::array::from_fn(|d| side(corner, d) * share));
        }
    }

    /// Gradient of a nodal field at the centre of a cell, by the linear shape functions, `[component][direction]`,
    /// 1/m of the field.
    #[inline]
    pub fn centre_gradient(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> Tensor<D> {
        let mut gradient = [[0.0; D]; D];
        for (corner, node) in grid.corners(self.divergence_node[cell]).enumerate() {
            for direction in 0..D {
                for component in 0..D {
                    gradient[component][direction] += side(corner, direction) * field[node][component];
                }
            }
        }
        gradient.map(|row| row.map(|slope| slope * share_of_corner(grid)))
    }

    /// The nodes of that divergence with their coefficients, 1/m.
    pub fn centre_divergence_row(&self, grid: &Grid<D>, cell: usize) -> Vec<(usize, Vector<D>)> {
        let coefficients = |corner| std::array::from_fn(|d| side(corner, d) * share_of_corner(grid));
        let corners = grid.corners(self.divergence_node[cell]).enumerate();
        corners.map(|(corner, node)| (node, coefficients(corner))).collect()
    }

    /// The same on the deformed configuration, for a field on the initial one: its gradient there
    /// times the cell's inverse deformation gradient.
    #[inline]
    pub fn deformed_centre_divergence(&self, grid: &Grid<D>, cell: usize, field: &[Vector<D>]) -> f64 {
        let inverse = &self.inverse_deformation[cell];
        let mut divergence = 0.0;
        for (corner, node) in grid.corners(self.divergence_node[cell]).enumerate() {
            for direction in 0..D {
                for component in 0..D {
                    divergence +=
                        side(corner, direction) * field[node][component] * inverse[direction][component];
                }
            }
        }
        divergence * share_of_corner(grid)
    }
}

/// The side of a cell, in a direction, that a corner lies on: −1 or 1.
#[inline]
fn side(corner: usize, direction: usize) -> f64 {
    if corner >> direction & 1 == 1 { 1.0 } else { -1.0 }
}

/// Slope at the centre that a unit value at a corner makes, 1/m: each direction averages over the
/// 2^(D−1) edges along it.
#[inline]
fn share_of_corner<const D: usize>(grid: &Grid<D>) -> f64 {
    grid.inverse_cell_size() * 2.0 / (1_usize << D) as f64
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
    #[should_panic(expected = "an initial volume per run")]
    fn volumes_of_runs_that_are_not_known_are_not_summed() {
        let (grid, points) = (Grid::new(0.5, [3]), Points::lattice(0.5, [3], 2));
        let mut cells = Cells::new(&grid, points.len());
        cells.locate(&grid, &points, 0.3);
        let holders = cells.clone();
        cells.locate_among(&grid, &points.position, &holders, |_| false);
        cells.sum_volumes(&points, 0.3);
    }

    #[test]
    fn runs_hold_every_point_once_and_a_cell_may_have_several() {
        let of_point = vec![3, 3, 5, 3, 7, 7, 7];
        let mut cells = Cells::<1> { of_point, ..Cells::default() };
        cells.find_runs();
        assert_eq!(cells.runs(), [(3, 0..2), (5, 2..3), (3, 3..4), (7, 4..7)]);
        cells.of_point.clear();
        cells.find_runs();
        assert_eq!(cells.runs(), []);
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
                cells.locate(&grid, &points, 0.3);
                cells.find_reached(&grid, &points);
            }
            assert_eq!((&again.of_point, &again.runs), (&first.of_point, &first.runs), "step {step}");
            assert_eq!((&again.point_count, &again.occupied), (&first.point_count, &first.occupied));
            assert_eq!((&again.volume, &again.porosity), (&first.volume, &first.porosity), "step {step}");
            assert_eq!(again.reached, first.reached, "step {step}");
            for cell in first.occupied() {
                assert_eq!(again.is_reached_around(cell), first.is_reached_around(cell), "step {step}");
                let of_cell = (0..points.len()).filter(|point| first.of_point[*point] == cell);
                let volume: f64 = of_cell.map(|point| points.volume(point)).sum();
                assert!((again.volume(cell) / volume - 1.0).abs() < 1e-14, "step {step}");
            }
        }
        assert!(again.occupations() > 3 && again.runs().len() > again.occupied().count(), "they crossed");
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
