//! Null-space filter: takes from values at the points the part that no nodal force of their cell feels (Gritton
//! & Berzins 2017; Tran & Sołowski 2019).
//!
//! The forces of pressures `p` on the corners of a cell are `Σ V p ∇N`, and the gradients of the (bi)linear hats
//! span the constants and the lines along the [felt slopes](felt_slopes). What is felt is the plane
//! `p̄ + s·(x − x̄)` through the values by least squares, in one dimension their mean; the rest is the null space.

use crate::operators::recovery::points_in_cells::PointsInCells;
use oedometer_soil::tensor::{Tensor, Vector, solve_symmetric};

/// The plane through the values of each cell's points, `[cell]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellPlanes<const D: usize> {
    planes: Vec<Plane<D>>,
}

/// Moments of the points of a cell and of their values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane<const D: usize> {
    count: f64,
    /// Mean place `x̄`, m.
    place: Vector<D>,
    /// Mean value `p̄`.
    value: f64,
    /// `Σ (x − x̄) ⊗ (x − x̄)`, m².
    spread: Tensor<D>,
    /// `Σ (x − x̄)(p − p̄)`, then the slope `s`.
    tilt: Vector<D>,
}

impl<const D: usize> Plane<D> {
    const EMPTY: Self =
        Self { count: 0.0, place: [0.0; D], value: 0.0, spread: [[0.0; D]; D], tilt: [0.0; D] };

    #[inline]
    fn offset(&self, place: &Vector<D>) -> Vector<D> {
        std::array::from_fn(|d| place[d] - self.place[d])
    }

    /// Slope of a tilt along the directions that are felt and in which the places differ.
    #[inline]
    fn slope(&self, tilt: &Vector<D>, felt: [bool; D]) -> Vector<D> {
        let largest = (0..D).map(|d| self.spread[d][d]).fold(0.0, f64::max);
        solve_symmetric(&self.spread, tilt, |d, pivot| !felt[d] || pivot <= 1e-10 * largest)
    }
}

impl<const D: usize> CellPlanes<D> {
    /// Room for so many cells.
    pub fn with_cells(count: usize) -> Self {
        Self { planes: vec![Plane::EMPTY; count] }
    }

    /// Fits the planes to the values of the points.
    pub fn fit(&mut self, at: &PointsInCells<'_, D>, value: impl Fn(usize) -> f64) {
        self.planes.fill(Plane::EMPTY);
        for (point, place) in at.positions.iter().enumerate() {
            let plane = &mut self.planes[at.cells.of_point[point]];
            plane.count += 1.0;
            plane.value += value(point);
            for d in 0..D {
                plane.place[d] += place[d];
            }
        }
        for plane in self.planes.iter_mut().filter(|plane| plane.count > 0.0) {
            plane.value /= plane.count;
            plane.place = plane.place.map(|sum| sum / plane.count);
        }
        for (point, place) in at.positions.iter().enumerate() {
            let plane = &mut self.planes[at.cells.of_point[point]];
            let (offset, departure) = (plane.offset(place), value(point) - plane.value);
            for d in 0..D {
                plane.tilt[d] += offset[d] * departure;
                for e in 0..D {
                    plane.spread[d][e] += offset[d] * offset[e];
                }
            }
        }
        for (cell, plane) in self.planes.iter_mut().enumerate().filter(|(_, plane)| plane.count > 0.0) {
            plane.tilt = plane.slope(&plane.tilt, felt_slopes(at, cell));
        }
    }

    /// Value of its cell's plane at a point.
    #[inline]
    pub fn value(&self, at: &PointsInCells<'_, D>, point: usize) -> f64 {
        let (plane, place) = (&self.planes[at.cells.of_point[point]], &at.positions[point]);
        let rise: f64 = (0..D).map(|d| plane.tilt[d] * (place[d] - plane.place[d])).sum();
        plane.value + rise
    }
}

/// Rows of the filter: weights of the values of a cell's points in what each of them keeps.
pub fn rows<const D: usize>(at: &PointsInCells<'_, D>) -> Vec<Vec<(usize, f64)>> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); at.grid.cell_count()];
    for (point, cell) in at.cells.of_point.iter().enumerate() {
        members[*cell].push(point);
    }
    let mut moments = CellPlanes::with_cells(at.grid.cell_count());
    moments.fit(at, |_| 0.0);
    let row = |point: usize| {
        let cell = at.cells.of_point[point];
        let plane = &moments.planes[cell];
        let reach = plane.slope(&plane.offset(&at.positions[point]), felt_slopes(at, cell));
        let share = |other: &usize| {
            let along = plane.offset(&at.positions[*other]);
            (*other, 1.0 / plane.count + (0..D).map(|d| reach[d] * along[d]).sum::<f64>())
        };
        members[cell].iter().map(share).collect()
    };
    (0..at.positions.len()).map(row).collect()
}

/// Directions along which a slope of the pressure changes a force on the corners of a cell: forces along one
/// direction feel the slopes along all others, where a corner is free to follow them. Between two rollers none
/// is, and a cell of a plane is one of a column.
#[inline]
fn felt_slopes<const D: usize>(at: &PointsInCells<'_, D>, cell: usize) -> [bool; D] {
    let nodes = at.nodes;
    let follows: [bool; D] = std::array::from_fn(|d| {
        at.grid
            .corners(at.cells.first_node(cell))
            .any(|node| nodes.free[node][d] > 0.0 || nodes.water_free[node][d] > 0.0)
    });
    std::array::from_fn(|d| (0..D).any(|other| other != d && follows[other]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operators::basis::{Hat, ShapeFunction};
    use crate::operators::recovery::tests::{SiteBlock, applied};
    use crate::operators::row::Row;

    /// Forces `Σ V p ∇N` of pressures at the points on a corner of a cell.
    fn force(at: &PointsInCells<'_, 2>, values: &[f64], cell: usize, corner: usize) -> Vector<2> {
        let mut force = [0.0; 2];
        for (point, place) in at.positions.iter().enumerate() {
            if at.cells.of_point[point] == cell {
                let home = at.grid.cell_of(place);
                let rows: [Row<2>; 2] =
                    std::array::from_fn(|d| Hat::row(at.grid.in_cells(place[d]), home[d], 0.0));
                let (i, j) = (corner & 1, corner >> 1);
                force[0] += values[point] * rows[0].gradients[i] * rows[1].values[j];
                force[1] += values[point] * rows[0].values[i] * rows[1].gradients[j];
            }
        }
        force
    }

    #[test]
    fn the_filter_keeps_pressures_that_change_forces_and_nothing_else() {
        let mut block = SiteBlock::new(0.5, [2, 2], 3);
        let at = block.at();
        let rows = rows(&at);
        let values: Vec<f64> = (0..at.positions.len()).map(|point| (1.7 * point as f64).sin()).collect();
        let filtered: Vec<f64> = rows.iter().map(|row| applied(row, &values)).collect();
        for cell in at.cells.occupied() {
            for corner in 0..4 {
                let before = force(&at, &values, cell, corner);
                let after = force(&at, &filtered, cell, corner);
                assert!((before[0] - after[0]).abs() < 1e-12 && (before[1] - after[1]).abs() < 1e-12);
            }
        }
        // A projection: a second time takes nothing; and what it took was not nothing.
        let again: Vec<f64> = rows.iter().map(|row| applied(row, &filtered)).collect();
        let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(change(&again, &filtered) < 1e-12 && change(&filtered, &values) > 0.1);
        let mut planes = CellPlanes::with_cells(at.grid.cell_count());
        planes.fit(&at, |point| values[point]);
        let in_place: Vec<f64> = (0..values.len()).map(|point| planes.value(&at, point)).collect();
        assert!(change(&in_place, &filtered) < 1e-12, "rows and filter are one");
        // Between rollers no force along x is felt, nor what it would feel: slopes along y.
        for free in [&mut block.nodes.free, &mut block.nodes.water_free] {
            free.fill([0.0, 1.0]);
        }
        assert_eq!(felt_slopes(&block.at(), block.cells.of_point[0]), [true, false]);
    }
}
