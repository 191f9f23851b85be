//! Patch recovery (MLSA): the plane `a + b·(x − x_p)` fitted to the values of the `3^D` cells around a point by
//! weighted least squares, evaluated at the point: `p_p = a`.
//!
//! Zienkiewicz & Zhu (1992); Zheng et al. The weight of a cell falls with its
//! distance: with equal weights the recovery's Fourier symbol `(1 + 2 cos θ)/3` turns negative
//! beyond `2π/3`, a negative stiffness that no step survives.

use crate::state::cells::Cells;
use crate::state::grid::{GHOST_LAYERS, Grid, SIXTH, power};
use crate::state::lanes::{FOUR, LANES, Lanes, lanes_of, some_of};
use crate::wide::wide;
use oedometer_soil::tensor::{Vector, solve_symmetric};
use std::ops::Range;

/// Cells along one direction of a patch.
const BLOCK: usize = 3;
/// Most cells of a patch, over the dimensions there are.
const MOST_CELLS: usize = BLOCK * BLOCK;

/// Which cells of a patch are occupied, but for its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Neighbours<const D: usize> {
    /// All.
    #[default]
    All,
    /// Those of a rectangle: lower and upper ones, a direction.
    Rectangle([(bool, bool); D]),
    /// Others.
    Some,
}

/// Recovery weights of every point over the `3^D` cells around its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchRows<const D: usize> {
    /// Flat index of the lowest cell of each point's block.
    first: Vec<usize>,
    /// Rows along each direction, of some neighbouring points side by side.
    lines: Vec<[LineRows; D]>,
    /// Whether each point's row is no product of lines, and its weights then.
    is_fitted: Vec<bool>,
    fitted: Vec<[f64; MOST_CELLS]>,
    /// Whether any row is fitted so.
    has_fitted: bool,
    /// Neighbours of each occupied cell, and which of its [occupations](Cells::occupations) they are of.
    neighbours: Vec<Neighbours<D>>,
    occupations: Option<u64>,
}

impl<const D: usize> PatchRows<D> {
    /// Room for `points` points on a grid.
    pub fn with_points(points: usize, grid: &Grid<D>) -> Self {
        // Along a direction of one cell nothing is ever fitted.
        let lines = grid.cells.map(|cells| if cells == 1 { LineRows::ALONE } else { LineRows::default() });
        Self {
            first: vec![0; points],
            lines: vec![lines; points.div_ceil(LANES)],
            is_fitted: vec![false; points],
            fitted: vec![[0.0; MOST_CELLS]; points],
            has_fitted: false,
            neighbours: vec![Neighbours::All; grid.cell_count()],
            occupations: None,
        }
    }

    /// Fits the rows to the points' places and to the occupied cells.
    ///
    /// The weights of the fit are products over the directions, and where the occupied cells fill a rectangle the
    /// moments that the normal equations mix vanish: with the row `r` of the line through the cells along a
    /// direction and the shares `a` of their weights, the plane's row is `r_i a_j + a_i r_j − a_i a_j`. Rows along a
    /// direction are worked out for some points side by side as if all cells were there, and then those that are
    /// not.
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        wide!(self.build_lines(grid, cells));
        if self.occupations.replace(cells.occupations()) != Some(cells.occupations()) {
            for cell in cells.occupied() {
                self.neighbours[cell] = Neighbours::of(grid, cells, cell);
            }
        }
        let lowest: usize = grid.cell_stride().iter().sum();
        if std::mem::take(&mut self.has_fitted) {
            self.is_fitted.fill(false);
        }
        for (cell, points) in cells.runs() {
            if cells.has_strays() {
                for point in points.clone() {
                    let home = self.first[point] + lowest;
                    let neighbours =
                        if cells.is_occupied(home) { self.neighbours[home] } else { Neighbours::Some };
                    self.cut(grid, cells, point..point + 1, home, neighbours);
                }
            } else if self.neighbours[*cell] != Neighbours::All {
                self.cut(grid, cells, points.clone(), *cell, self.neighbours[*cell]);
            }
        }
    }

    /// The rows along each direction.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn build_lines(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        let lowest: usize = grid.cell_stride().iter().sum();
        for (first, home) in self.first.iter_mut().zip(&cells.of_point) {
            *first = home - lowest;
        }
        // The cells that points lie in are not always those that they belong to.
        if D > 1 && cells.has_strays() {
            for (first, place) in self.first.iter_mut().zip(&cells.place) {
                *first = grid.flat_cell(&grid.cell_at(place)) - lowest;
            }
        }
        let homes = cells.of_point.chunks(LANES);
        for ((lines, places), homes) in self.lines.iter_mut().zip(cells.place.chunks(LANES)).zip(homes) {
            for d in 0..D {
                if grid.cells[d] == 1 {
                    continue;
                }
                let line = grid.line(d);
                let place = lanes_of(places, d, GHOST_LAYERS as f64);
                let mut along = place;
                for along in &mut along {
                    *along = line.cell_at(*along);
                }
                if D == 1 && cells.has_strays() {
                    for (cell, home) in along.iter_mut().zip(homes) {
                        *cell = *home as f64;
                    }
                }
                fill::<D>(&mut lines[d], &along, &place);
            }
        }
    }

    /// The rows of points of a cell with such neighbours.
    fn cut(
        &mut self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        points: Range<usize>,
        home: usize,
        neighbours: Neighbours<D>,
    ) {
        match neighbours {
            Neighbours::All => {}
            Neighbours::Rectangle(sides) => {
                // Rows of a direction of one cell are made so.
                for d in (0..D).filter(|d| sides[*d] != (true, true) && grid.cells[*d] > 1) {
                    for point in points.clone() {
                        self.lines[point / LANES][d].cut::<D>(point % LANES, sides[d]);
                    }
                }
            }
            Neighbours::Some => {
                self.has_fitted = true;
                for point in points {
                    self.is_fitted[point] = true;
                    fit(grid, cells, home, &cells.place[point], &mut self.fitted[point]);
                }
            }
        }
    }

    /// Values at the points of a field given at the cells, each put into its place.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn recover(&self, grid: &Grid<D>, field: &[f64], out: &mut [f64], put: impl Fn(&mut f64, f64)) {
        let whole = if self.has_fitted { 0 } else { out.len() / FOUR * FOUR };
        let (together, rest) = out.split_at_mut(whole);
        for (group, places) in together.as_chunks_mut::<FOUR>().0.iter_mut().enumerate() {
            let point = group * FOUR;
            let firsts = some_of::<_, FOUR>(&self.first, point);
            if firsts.iter().all(|first| *first == firsts[0]) {
                let values = self.values_together(grid, point, field);
                for (place, value) in places.iter_mut().zip(values) {
                    put(place, value);
                }
                continue;
            }
            for (which, place) in places.iter_mut().enumerate() {
                put(place, self.value(grid, point + which, field));
            }
        }
        for (which, place) in rest.iter_mut().enumerate() {
            put(place, self.value(grid, whole + which, field));
        }
    }

    /// Values at neighbouring points of the same cells, whose rows are products of lines, side by side.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn values_together(&self, grid: &Grid<D>, point: usize, field: &[f64]) -> [f64; FOUR] {
        let (lines, lane, first) = (&self.lines[point / LANES], point % LANES, self.first[point]);
        let row = |rows: &[Lanes; BLOCK], k: usize| *some_of::<_, FOUR>(&rows[k], lane);
        let along = |rows: &[Lanes; BLOCK], cells: &[f64]| {
            let rows: [[f64; FOUR]; BLOCK] = [row(rows, 0), row(rows, 1), row(rows, 2)];
            let mut values = [0.0; FOUR];
            for point in 0..FOUR {
                values[point] =
                    rows[0][point] * cells[0] + rows[1][point] * cells[1] + rows[2][point] * cells[2];
            }
            values
        };
        if D == 1 {
            return along(&lines[0].line, &field[first..first + BLOCK]);
        }
        let (up, stride) = (&lines[D - 1], grid.cell_stride()[D - 1]);
        let mut values = [0.0; FOUR];
        for k in 0..BLOCK {
            let cells = &field[first + k * stride..first + k * stride + BLOCK];
            let (of_line, of_shares) = (along(&lines[0].line, cells), along(&lines[0].shares, cells));
            let (share, line) = (row(&up.shares, k), row(&up.line, k));
            for point in 0..FOUR {
                values[point] +=
                    share[point] * of_line[point] + (line[point] - share[point]) * of_shares[point];
            }
        }
        values
    }

    /// Value at a point of a field given at the cells.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn value(&self, grid: &Grid<D>, point: usize, field: &[f64]) -> f64 {
        let (lines, lane) = (&self.lines[point / LANES], point % LANES);
        let first = self.first[point];
        if self.is_fitted[point] {
            let weights = self.fitted[point][..power(BLOCK, D)].iter().enumerate();
            return weights.map(|(block, weight)| weight * field[block_cell(grid, first, block).0]).sum();
        }
        let line: [f64; BLOCK] = std::array::from_fn(|k| lines[0].line[k][lane]);
        if D == 1 {
            return product(&line, &field[first..first + BLOCK]);
        }
        let shares: [f64; BLOCK] = std::array::from_fn(|k| lines[0].shares[k][lane]);
        let (up, stride) = (&lines[D - 1], grid.cell_stride()[D - 1]);
        let mut value = 0.0;
        for k in 0..BLOCK {
            let (share, run) = (up.shares[k][lane], &field[first + k * stride..first + k * stride + BLOCK]);
            value += share * product(&line, run) + (up.line[k][lane] - share) * product(&shares, run);
        }
        value
    }

    /// The cells of a point's patch with their weights.
    pub fn row(&self, grid: &Grid<D>, point: usize) -> Vec<(usize, f64)> {
        let mut weights = self.fitted[point];
        if !self.is_fitted[point] {
            combine(&self.lines[point / LANES], point % LANES, &mut weights);
        }
        let cells = (0..power(BLOCK, D)).map(|block| block_cell(grid, self.first[point], block).0);
        cells.zip(weights).collect()
    }
}

/// Sum of three cells' values with their weights.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn product(weights: &[f64; BLOCK], values: &[f64]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
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

impl<const D: usize> Neighbours<D> {
    /// The neighbours of a cell.
    fn of(grid: &Grid<D>, cells: &Cells<D>, cell: usize) -> Self {
        let mut sides = [(true, true); D];
        for d in 0..D {
            let stride = grid.cell_stride()[d];
            sides[d] = (cells.is_occupied(cell - stride), cells.is_occupied(cell + stride));
        }
        let first = cell - grid.cell_stride().iter().sum::<usize>();
        let is_rectangle = (0..power(BLOCK, D)).all(|block| {
            let (other, steps) = block_cell(grid, first, block);
            let is_in = (0..D).all(|d| [sides[d].0, true, sides[d].1][steps[d]]);
            cells.is_occupied(other) == is_in
        });
        if !is_rectangle {
            Self::Some
        } else if sides == [(true, true); D] {
            Self::All
        } else {
            Self::Rectangle(sides)
        }
    }
}

/// Lines fitted along one direction through the cells around some points, side by side, `[cell][point]`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
struct LineRows {
    /// How far above each point the centre of its cell lies, in cells.
    offsets: Lanes,
    /// Weights of the cells in the line's value at the point.
    line: [Lanes; BLOCK],
    /// Shares of the cells in the sum of the weights of the fit.
    shares: [Lanes; BLOCK],
}

impl Default for LineRows {
    fn default() -> Self {
        let zero = [0.0; LANES];
        Self { offsets: zero, line: [[0.0; LANES]; BLOCK], shares: [[0.0; LANES]; BLOCK] }
    }
}

impl LineRows {
    /// The rows of points whose cells have no neighbours.
    const ALONE: Self = {
        let (none, all) = ([0.0; LANES], [1.0; LANES]);
        Self { offsets: none, line: [none, all, none], shares: [none, all, none] }
    };

    /// The row of a point some of whose cells are empty: the line through two, or the value of the only one.
    #[inline]
    fn cut<const D: usize>(&mut self, lane: usize, sides: (bool, bool)) {
        let offset = self.offsets[lane];
        let (line, mut shares) = match sides {
            (true, true) => return,
            (false, true) => ([0.0, 1.0 + offset, -offset], [0.0, offset, offset + 1.0]),
            (true, false) => ([offset, 1.0 - offset, 0.0], [offset - 1.0, offset, 0.0]),
            (false, false) => ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
        };
        // A column has no use for the shares.
        if D > 1 && sides != (false, false) {
            let is_there = [sides.0, true, sides.1];
            for k in 0..BLOCK {
                shares[k] = if is_there[k] { distance_weight(shares[k]) } else { 0.0 };
            }
            let per_sum = 1.0 / shares.iter().sum::<f64>();
            shares = shares.map(|weight| weight * per_sum);
        }
        for k in 0..BLOCK {
            (self.line[k][lane], self.shares[k][lane]) = (line[k], shares[k]);
        }
    }
}

/// The rows of points in cells, whole numbers, at places (in cells) where all cells are occupied, and in a plane the
/// shares: the same fit as [`Patch`] in closed form. Moving points pay for it at every step.
///
/// The spline is the cubic B-spline, whose four values around a point have the moments 1, 0 and 1/3.
/// The patch lacks the outermost, `u³/6` at the distance `2 − u` on the near side, `u = |offset|`,
/// which gives its own moments, and the fit's weights from them.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn fill<const D: usize>(rows: &mut LineRows, cells: &Lanes, place: &Lanes) {
    for lane in 0..LANES {
        let offset = cells[lane] + 0.5 - place[lane];
        let u = offset.abs();
        let rest = 1.0 - u;
        let square = u * u;
        let far = SIXTH * rest * rest * rest;
        let home = 2.0 / 3.0 - square + 0.5 * square * u;
        let lacking = SIXTH * square * u;
        let near = 1.0 - home - far - lacking;
        let (lever, tilt) = (2.0 - u, 3.0 * lacking * (2.0 - u));
        let scale = 1.0 / (1.0 - lacking - tilt * lever);
        let line_near = near * (1.0 - tilt) * scale;
        let line_far = far * (1.0 - 3.0 * tilt) * scale;
        let is_above = offset > 0.0;
        rows.offsets[lane] = offset;
        rows.line[0][lane] = if is_above { line_near } else { line_far };
        rows.line[1][lane] = 1.0 - line_near - line_far;
        rows.line[2][lane] = if is_above { line_far } else { line_near };
    }
    // A column has no use for the shares.
    if D > 1 {
        for lane in 0..LANES {
            let u = rows.offsets[lane].abs();
            let rest = 1.0 - u;
            let square = u * u;
            let per_sum = 1.0 / (1.0 - SIXTH * square * u);
            let far = SIXTH * rest * rest * rest * per_sum;
            let home = (2.0 / 3.0 - square + 0.5 * square * u) * per_sum;
            let near = 1.0 - home - far;
            let is_above = rows.offsets[lane] > 0.0;
            rows.shares[0][lane] = if is_above { near } else { far };
            rows.shares[1][lane] = home;
            rows.shares[2][lane] = if is_above { far } else { near };
        }
    }
}

/// The row of a point from those of its directions.
fn combine<const D: usize>(lines: &[LineRows; D], lane: usize, row: &mut [f64; MOST_CELLS]) {
    if D == 1 {
        for k in 0..BLOCK {
            row[k] = lines[0].line[k][lane];
        }
        return;
    }
    let (across, up) = (&lines[0], &lines[D - 1]);
    for (j, run) in row.chunks_exact_mut(BLOCK).enumerate() {
        let (share, tilt) = (up.shares[j][lane], up.line[j][lane] - up.shares[j][lane]);
        for (i, weight) in run.iter_mut().enumerate() {
            *weight = across.line[i][lane] * share + across.shares[i][lane] * tilt;
        }
    }
}

/// The row of a point in any patch, by the normal equations.
#[inline(never)]
fn fit<const D: usize>(grid: &Grid<D>, cells: &Cells<D>, home: usize, place: &Vector<D>, row: &mut [f64]) {
    let (index, stride) = (grid.cell_index(home), grid.cell_stride());
    let first = home - stride.iter().sum::<usize>();
    let mut patch = Patch::<D>::empty();
    for block in 0..power(BLOCK, D) {
        let (cell, steps) = block_cell(grid, first, block);
        if cells.is_occupied(cell) {
            let mut offset = [0.0; D];
            for d in 0..D {
                offset[d] = (index[d] + steps[d]) as f64 - 0.5 - place[d];
            }
            patch.add(block, offset);
        }
    }
    patch.rows_into(row);
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
mod tests;
