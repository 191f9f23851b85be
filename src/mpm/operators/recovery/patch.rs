//! Patch recovery (MLSA): the plane `a + b·(x − x_p)` fitted to the values of the `3^D` cells around a point by
//! weighted least squares, evaluated at the point: `p_p = a`.
//!
//! Zienkiewicz & Zhu (1992); Zheng et al. The weight of a cell falls with its
//! distance: with equal weights the recovery's Fourier symbol `(1 + 2 cos θ)/3` turns negative
//! beyond `2π/3`, a negative stiffness that no step survives.

use crate::mpm::state::cells::Cells;
use crate::mpm::state::grid::{Grid, SIXTH, power};
use crate::soil::tensor::{Vector, solve_symmetric};

/// Cells along one direction of a patch.
const BLOCK: usize = 3;
/// Most cells of a patch, over the dimensions there are.
const MOST_CELLS: usize = BLOCK * BLOCK;
/// Points of a column whose rows are worked out side by side.
const LANES: usize = 4;

/// Recovery weights of every point over the `3^D` cells around its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchRows<const D: usize> {
    /// Flat index of the lowest cell of each point's block.
    first: Vec<usize>,
    /// `3^D` weights a point.
    weights: Vec<f64>,
}

impl<const D: usize> PatchRows<D> {
    /// Room for `points` points.
    pub fn with_points(points: usize) -> Self {
        Self { first: vec![0; points], weights: vec![0.0; points * Self::width()] }
    }

    const fn width() -> usize {
        power(BLOCK, D)
    }

    /// Fits the rows to the points' places and to the occupied cells.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        if D == 1 {
            self.build_in_column(cells);
            return;
        }
        for (point, place) in cells.place.iter().enumerate() {
            let row = &mut self.weights[point * Self::width()..(point + 1) * Self::width()];
            let home = grid.cell_at(place);
            let first = grid.flat_cell(&home.map(|index| index - 1));
            self.first[point] = first;
            let mut patch = Patch::<D>::empty();
            for block in 0..Self::width() {
                let (cell, steps) = block_cell(grid, first, block);
                if cells.is_occupied(cell) {
                    let offset = std::array::from_fn(|d| (home[d] + steps[d]) as f64 - 0.5 - place[d]);
                    patch.add(block, offset);
                }
            }
            patch.rows_into(row);
        }
    }

    /// The rows of a column in closed form: some points side by side, as if every patch were whole, and
    /// then those that are not.
    fn build_in_column(&mut self, cells: &Cells<D>) {
        let (rows, _) = self.weights.as_chunks_mut::<BLOCK>();
        let points = cells.of_point.chunks(LANES).zip(cells.place.chunks(LANES));
        let out = self.first.chunks_mut(LANES).zip(rows.chunks_mut(LANES));
        for ((homes, places), (first, rows)) in points.zip(out) {
            let mut offsets = [0.0; LANES];
            for (offset, (home, place)) in offsets.iter_mut().zip(homes.iter().zip(places)) {
                *offset = *home as f64 + 0.5 - place[0];
            }
            let [lower, middle, upper] = whole_column_rows(&offsets);
            for (lane, home) in homes.iter().enumerate() {
                first[lane] = home - 1;
                rows[lane] = match (cells.is_occupied(home - 1), cells.is_occupied(home + 1)) {
                    (true, true) => [lower[lane], middle[lane], upper[lane]],
                    sides => cut_column_row(offsets[lane], sides),
                };
            }
        }
    }

    /// Value at a point of a field given at the cells.
    #[inline]
    pub fn value(&self, grid: &Grid<D>, point: usize, field: &[f64]) -> f64 {
        let row = &self.weights[point * Self::width()..(point + 1) * Self::width()];
        if D == 1 {
            let first = self.first[point];
            return row.iter().zip(&field[first..first + BLOCK]).map(|(weight, value)| weight * value).sum();
        }
        let mut value = 0.0;
        for block in 0..Self::width() {
            let (cell, _) = block_cell(grid, self.first[point], block);
            value += row[block] * field[cell];
        }
        value
    }

    /// The cells of a point's patch with their weights.
    pub fn row(&self, grid: &Grid<D>, point: usize) -> Vec<(usize, f64)> {
        let weights = self.weights[point * Self::width()..].iter();
        let cells = (0..Self::width()).map(|block| block_cell(grid, self.first[point], block).0);
        cells.zip(weights.copied()).collect()
    }
}

/// Flat cell of a place in a block, and its steps from the block's lowest cell.
#[inline]
fn block_cell<const D: usize>(grid: &Grid<D>, first: usize, block: usize) -> (usize, [usize; D]) {
    let mut rest = block;
    let mut cell = first;
    let steps = std::array::from_fn(|direction| {
        let step = rest % BLOCK;
        rest /= BLOCK;
        cell += step * grid.cell_stride()[direction];
        step
    });
    (cell, steps)
}

/// Cubic spline of the distance `d` in cells with radius two cells (Monaghan & Lattanzio 1985,
/// as used in moving least squares): positive inside, smooth to zero.
#[inline]
fn distance_weight(distance: f64) -> f64 {
    let q = 0.5 * distance.abs();
    if q <= 0.5 {
        2.0 / 3.0 - 4.0 * q * q + 4.0 * q * q * q
    } else if q < 1.0 {
        let rest = 1.0 - q;
        4.0 / 3.0 * rest * rest * rest
    } else {
        0.0
    }
}

/// The rows of points in a column, whose cells' centres lie `offsets` cells above them, where all cells of
/// the patch are occupied: the same fit as [`Patch`] in closed form. Moving points pay for it at every
/// step.
///
/// The spline is the cubic B-spline, whose four values around a point have the moments 1, 0 and 1/3.
/// The patch lacks the outermost, `u³/6` at the distance `2 − u` on the near side, `u = |offset|`,
/// which gives its own moments, and the fit's weights from them.
#[inline]
fn whole_column_rows(offsets: &[f64; LANES]) -> [[f64; LANES]; BLOCK] {
    let mut rows = [[0.0; LANES]; BLOCK];
    for (lane, offset) in offsets.iter().enumerate() {
        let u = offset.abs();
        let rest = 1.0 - u;
        let square = u * u;
        let far = SIXTH * rest * rest * rest;
        let home = 2.0 / 3.0 - square + 0.5 * square * u;
        let lacking = SIXTH * square * u;
        let near = 1.0 - home - far - lacking;
        let (lever, tilt) = (2.0 - u, 3.0 * lacking * (2.0 - u));
        let scale = 1.0 / (1.0 - lacking - tilt * lever);
        let near = near * (1.0 - tilt) * scale;
        let far = far * (1.0 - 3.0 * tilt) * scale;
        rows[0][lane] = if *offset > 0.0 { near } else { far };
        rows[1][lane] = 1.0 - near - far;
        rows[2][lane] = if *offset > 0.0 { far } else { near };
    }
    rows
}

/// The row of a point in a column whose patch lacks a cell: the line through two cells, or the value of
/// the only one.
#[inline]
fn cut_column_row(offset: f64, (has_lower, has_upper): (bool, bool)) -> [f64; BLOCK] {
    match (has_lower, has_upper) {
        (false, true) => [0.0, 1.0 + offset, -offset],
        (true, false) => [offset, 1.0 - offset, 0.0],
        _ => [0.0, 1.0, 0.0],
    }
}

/// The occupied cells around one point: weighted moments of `[1, x, y]` about the point.
struct Patch<const D: usize> {
    count: usize,
    block: [usize; MOST_CELLS],
    weight: [f64; MOST_CELLS],
    offset: [Vector<D>; MOST_CELLS],
}

impl<const D: usize> Patch<D> {
    fn empty() -> Self {
        Self { count: 0, block: [0; MOST_CELLS], weight: [0.0; MOST_CELLS], offset: [[0.0; D]; MOST_CELLS] }
    }

    #[inline]
    fn add(&mut self, block: usize, offset: Vector<D>) {
        self.block[self.count] = block;
        // A product over the directions, so that a column one cell wide recovers as in 1D.
        self.weight[self.count] = offset.iter().map(|d| distance_weight(*d)).product();
        self.offset[self.count] = offset;
        self.count += 1;
    }

    /// Writes the weights that evaluate the fit at the point itself.
    ///
    /// A direction without two different cells is left out of the fit; where the cells still lie
    /// on a line, the order drops to constant.
    #[inline]
    fn rows_into(&self, row: &mut [f64]) {
        row.fill(0.0);
        let total: f64 = self.weight[..self.count].iter().sum();
        let mut mean = [0.0; D];
        for k in 0..self.count {
            for d in 0..D {
                mean[d] += self.weight[k] * self.offset[k][d] / total;
            }
        }
        let slope = self.centred_slope(&mean);
        for k in 0..self.count {
            let tilt: f64 = (0..D).map(|d| slope[d] * (self.offset[k][d] - mean[d])).sum();
            row[self.block[k]] = self.weight[k] * (1.0 / total - tilt);
        }
    }

    /// Solves the centred normal equations `C s = mean` for the slope's share of the weights.
    #[inline]
    fn centred_slope(&self, mean: &Vector<D>) -> Vector<D> {
        let mut covariance = [[0.0; D]; D];
        for k in 0..self.count {
            for i in 0..D {
                for j in 0..D {
                    covariance[i][j] +=
                        self.weight[k] * (self.offset[k][i] - mean[i]) * (self.offset[k][j] - mean[j]);
                }
            }
        }
        let offsets = &self.offset[..self.count];
        let is_flat = |d: usize| offsets.iter().all(|offset| (offset[d] - offsets[0][d]).abs() < 0.5);
        let mut is_on_a_line = false;
        let slope = solve_symmetric(&covariance, mean, |d, pivot| {
            let left_out = is_flat(d);
            is_on_a_line |= !left_out && pivot <= 1e-12;
            left_out
        });
        if is_on_a_line { [0.0; D] } else { slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mpm::state::points::Points;
    use proptest::prelude::*;

    fn recovered<const D: usize>(
        grid: &Grid<D>,
        points: &Points<D>,
        field: impl Fn(&Vector<D>) -> f64,
    ) -> Vec<(f64, f64)> {
        let mut cells = Cells::new(grid, points.len());
        cells.locate(grid, points, 0.3);
        let mut rows = PatchRows::with_points(points.len());
        rows.build(grid, &cells);
        let at_cells: Vec<f64> = (0..grid.cell_count()).map(|cell| field(&grid.cell_centre(cell))).collect();
        (0..points.len())
            .map(|point| (rows.value(grid, point, &at_cells), field(&points.position[point])))
            .collect()
    }

    proptest! {
        #[test]
        fn a_plane_is_recovered_exactly_in_every_cell(a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64,
                                                      jitter in proptest::collection::vec(-0.2..0.2f64, 48)) {
            let grid = Grid::new(0.5, [3, 4]);
            let mut points = Points::lattice(0.5, [3, 4], 2);
            for (place, nudge) in points.position.iter_mut().zip(&jitter) {
                place[0] += 0.5 * nudge;
                place[1] -= 0.5 * nudge;
            }
            for (got, exact) in recovered(&grid, &points, |x| a + b * x[0] + c * x[1]) {
                prop_assert!((got - exact).abs() < 1e-13, "{got} for {exact}");
            }
        }
    }

    #[test]
    fn a_line_is_recovered_exactly_in_a_column_and_in_its_boundary_cells() {
        let grid = Grid::new(0.1, [12]);
        let points = Points::lattice(0.1, [10], 3);
        for (got, exact) in recovered(&grid, &points, |x| 2.0 - 5.0 * x[0]) {
            assert!((got - exact).abs() < 1e-14, "{got} for {exact}");
        }
    }

    #[test]
    fn a_column_s_closed_form_is_the_fit() {
        for (lower, upper) in [(true, true), (true, false), (false, true), (false, false)] {
            for step in -20..=20 {
                let offset = f64::from(step) / 40.0;
                let mut patch = Patch::<1>::empty();
                for (block, is_there) in [lower, true, upper].into_iter().enumerate() {
                    if is_there {
                        patch.add(block, [offset + block as f64 - 1.0]);
                    }
                }
                let mut row = [0.0; BLOCK];
                patch.rows_into(&mut row);
                let closed = match (lower, upper) {
                    (true, true) => whole_column_rows(&[offset; LANES]).map(|lanes| lanes[LANES - 1]),
                    sides => cut_column_row(offset, sides),
                };
                for (got, fitted) in closed.iter().zip(&row) {
                    assert!((got - fitted).abs() < 1e-14, "{got} for {fitted} at {offset}");
                }
            }
        }
    }

    #[test]
    fn too_few_cells_drop_the_order_and_never_divide_by_zero() {
        let one_cell = recovered(&Grid::new(1.0, [1]), &Points::lattice(1.0, [1], 2), |x| 1.0 + x[0]);
        assert_eq!(one_cell[0].0, 1.5, "one cell: its own value");
        // A column one cell wide in 2D: the plane has no slope across.
        let narrow = recovered(&Grid::new(1.0, [1, 4]), &Points::lattice(1.0, [1, 4], 2), |x| 3.0 * x[1]);
        for (got, exact) in narrow {
            assert!((got - exact).abs() < 1e-13);
        }
        // Cells along a diagonal lie on a line: constant, finite.
        let mut points = Points::<2>::lattice(1.0, [2, 2], 1);
        points.position = vec![[0.5, 0.5], [0.5, 0.5], [1.5, 1.5], [1.5, 1.5]];
        for (got, _) in recovered(&Grid::new(1.0, [2, 2]), &points, |x| x[0] + 2.0 * x[1]) {
            assert!(got.is_finite() && (1.5..=4.5).contains(&got));
        }
    }

    #[test]
    fn the_recovery_never_turns_a_pressure_wave_round() {
        // Fourier symbol of patch recovery followed by the mean over the cell's points.
        let grid = Grid::new(1.0, [9]);
        for per_cell in 1..=4 {
            let points = Points::lattice(1.0, [9], per_cell);
            for step in 0..=32 {
                let theta = std::f64::consts::PI * f64::from(step) / 32.0;
                let wave = recovered(&grid, &points, |x| (theta * (x[0] - 4.5)).cos());
                let middle = &wave[4 * per_cell..5 * per_cell];
                let symbol: f64 = middle.iter().map(|pair| pair.0).sum::<f64>() / per_cell as f64;
                assert!(symbol > 0.0, "symbol {symbol} at θ = {theta}, {per_cell} points a cell");
            }
        }
    }
}
