//! Points of a body that strains along its height alone, as in an oedometer: those of a cell share its length by the
//! volumes that they fill.
//!
//! ```text
//! l_p = J_p V_p0 Σ l/Σ J V_0 over the points of a cell
//! ```
//!
//! Part of the cell-averaged projection, own invention: the volume ratios of the points are spread anew at every step, and
//! domains and places that did not follow would keep for ever what a first front that no cell resolves left in them, which no
//! balance sees. At 50 % strain that costs an order (docs/large-strain.md).

use crate::state::grid::Grid;
use crate::state::points::Points;

/// Share of its room in a cell that a point may be moved by: on a face it would be in another.
const ROOM_KEPT: f64 = 0.999;

/// Points one above another, in the order of a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackedPoints {
    /// Points side by side: each lies that many after the one below it.
    across: usize,
    /// Whether domains follow the volumes.
    domains_follow: bool,
}

impl StackedPoints {
    /// The points of a lattice, row by row from the base.
    pub fn new<const D: usize>(points: &Points<D>, domains_follow: bool) -> Self {
        let height = |point: usize| points.initial_position[point][D - 1];
        let is_lowest =
            |point: &usize| (height(*point) - height(0)).abs() < 1e-6 * points.half_length[0][D - 1];
        let across = (0..points.len()).take_while(is_lowest).count();
        Self { across: if D == 1 { 1 } else { across }, domains_follow }
    }

    /// Shares out the length of the points of each cell by the volumes that they fill, and moves them with their
    /// domains: domains that tiled the material still do, and the edges of what a cell holds stay where they are.
    ///
    /// No point is moved to another cell: it would fall back at the next step, and take volume along each time. Where
    /// one would be, all of its cell go that share of their way which takes it to the face.
    pub fn share_out<const D: usize>(&self, grid: &Grid<D>, cell_of_point: &[usize], points: &mut Points<D>) {
        let rows = points.len() / self.across;
        for column in 0..self.across {
            let mut first = 0;
            while first < rows {
                let point = |row: usize| row * self.across + column;
                let cell = cell_of_point[point(first)];
                let end = (first..rows).find(|row| cell_of_point[point(*row)] != cell).unwrap_or(rows);
                self.share_out_run(grid, points, (first..end).map(point));
                first = end;
            }
        }
    }

    /// The same for points of one cell, one above another.
    fn share_out_run<const D: usize>(
        &self,
        grid: &Grid<D>,
        points: &mut Points<D>,
        run: impl Iterator<Item = usize> + Clone,
    ) {
        let up = D - 1;
        let filled = |points: &Points<D>, point: usize| points.volume(point) * points.stressed_share[point];
        let (mut length, mut volume) = (0.0, 0.0);
        for point in run.clone() {
            length += filled(points, point);
            volume += points.volume(point);
        }
        let share = length / volume;
        // Of all that the run goes, as much as keeps every point in its cell.
        let (mut way, mut edge): (f64, f64) = (1.0, 0.0);
        for point in run.clone() {
            let change = (points.volume(point) * share - filled(points, point)) / width_of(points, point);
            let moved = (edge + 0.5 * change) * grid.inverse_cell_size();
            edge += change;
            let height = points.position[point][up] * grid.inverse_cell_size();
            let above = height - height.floor();
            let room = ROOM_KEPT * if moved > 0.0 { 1.0 - above } else { above };
            if moved.abs() > room {
                way = way.min(room / moved.abs());
            }
        }
        edge = 0.0;
        for point in run {
            let before = filled(points, point);
            let now = before + way * (points.volume(point) * share - before);
            let width = width_of(points, point);
            let change = (now - before) / width;
            let moved = edge + 0.5 * change;
            edge += change;
            points.position[point][up] += moved;
            points.displacement[point][up] += moved;
            points.stressed_share[point] = now / points.volume(point);
            if self.domains_follow {
                points.half_length[point][up] = 0.5 * now / width;
            }
        }
    }
}

/// Width of a point's column, m; one in one dimension.
#[inline]
fn width_of<const D: usize>(points: &Points<D>, point: usize) -> f64 {
    points.half_length[point][..D - 1].iter().map(|half| 2.0 * half).product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::tensor::Vector;

    /// A lattice whose volume ratios fall with the height.
    fn squeezed<const D: usize>(cells: [usize; D]) -> (Points<D>, StackedPoints) {
        let mut points = Points::lattice(0.25, cells, 2);
        let stacked = StackedPoints::new(&points, true);
        for (ratio, place) in points.volume_ratio.iter_mut().zip(&points.initial_position) {
            *ratio = 1.0 - 0.4 * place[D - 1];
        }
        (points, stacked)
    }

    /// Cells of the initial lattice, one for all points of a row.
    fn cells_of<const D: usize>(grid: &Grid<D>, points: &Points<D>) -> Vec<usize> {
        let cell = |place: &Vector<D>| grid.flat_cell(&grid.cell_of(place));
        points.initial_position.iter().map(cell).collect()
    }

    #[test]
    fn domains_divide_their_cell_by_filled_volume_and_still_tile_it() {
        let (mut points, stacked) = squeezed([4]);
        let grid = Grid::new(0.25, [5]);
        let cells = cells_of(&grid, &points);
        // Domains of the initial lattice, whatever the volumes: what they fill is not what they hold.
        for (share, ratio) in points.stressed_share.iter_mut().zip(&points.volume_ratio) {
            *share = 1.0 / ratio;
        }
        stacked.share_out(&grid, &cells, &mut points);
        let mut base = 0.0;
        for (point, (place, half)) in points.position.iter().zip(&points.half_length).enumerate() {
            assert!((place[0] - half[0] - base).abs() < 1e-15);
            base = place[0] + half[0];
            assert!(
                (points.displacement[point][0] - place[0] + points.initial_position[point][0]).abs() < 1e-15
            );
            let other = point ^ 1;
            assert!((points.stressed_share[point] / points.stressed_share[other] - 1.0).abs() < 1e-14);
        }
        assert!((base - 1.0).abs() < 1e-15, "{base}");
        assert!((points.position[7][0] - 0.9375).abs() > 1e-3, "the upper ones hold less");
        let once = points.clone();
        stacked.share_out(&grid, &cells, &mut points);
        for (twice, once) in points.position.iter().zip(&once.position) {
            assert!((twice[0] - once[0]).abs() < 1e-15);
        }
    }

    #[test]
    fn no_point_is_moved_to_another_cell() {
        let (mut points, stacked) = squeezed([4]);
        let grid = Grid::new(0.25, [5]);
        let cells = cells_of(&grid, &points);
        points.volume_ratio[2] = 20.0;
        points.stressed_share[2] = 1.0 / 20.0;
        // Just below a face, where the whole way would lead across it.
        points.position[3][0] = 0.49;
        stacked.share_out(&grid, &cells, &mut points);
        for (place, cell) in points.position.iter().zip(cells) {
            assert_eq!(grid.flat_cell(&grid.cell_of(place)), cell, "{place:?}");
        }
    }

    #[test]
    fn each_row_of_a_plane_is_stacked_like_a_column() {
        let (mut line, stacked) = squeezed([4]);
        let grid = Grid::new(0.25, [5]);
        let cells = cells_of(&grid, &line);
        line.stressed_share
            .iter_mut()
            .zip(&line.volume_ratio)
            .for_each(|(share, ratio)| *share = 1.0 / ratio);
        stacked.share_out(&grid, &cells, &mut line);
        let (mut plane, stacked) = squeezed([3, 4]);
        let grid = Grid::new(0.25, [3, 5]);
        let cells = cells_of(&grid, &plane);
        plane
            .stressed_share
            .iter_mut()
            .zip(&plane.volume_ratio)
            .for_each(|(share, ratio)| *share = 1.0 / ratio);
        stacked.share_out(&grid, &cells, &mut plane);
        for (point, place) in plane.position.iter().enumerate() {
            assert!((place[1] - line.position[point / 6][0]).abs() < 1e-15);
            assert_eq!(place[0], plane.initial_position[point][0]);
            assert!((plane.half_length[point][1] - line.half_length[point / 6][0]).abs() < 1e-15);
            assert_eq!(plane.half_length[point][0], 0.0625);
        }
    }
}
