//! Patch recovery (MLSA): the plane `a + b·(x − x_p)` fitted to the values of the `3^D` cells around a point by
//! weighted least squares, evaluated at the point: `p_p = a`.
//!
//! Zienkiewicz & Zhu (1992); Zheng et al. The weight of a cell falls with its
//! distance: with equal weights the recovery's Fourier symbol `(1 + 2 cos θ)/3` turns negative
//! beyond `2π/3`, a negative stiffness that no step survives.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::state::cells::Cells;
use crate::state::grid::{Grid, SIXTH, power};
use crate::wide::LANES;
use oedometer_soil::tensor::{Vector, solve_symmetric};

/// Cells along one direction of a patch.
const BLOCK: usize = 3;
/// Most cells of a patch.
const MOST_CELLS: usize = BLOCK * BLOCK;

/// Shares of the `3^D` cells around each point in its value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchRows<const D: usize> {
    /// Flat index of the lowest cell of each point's patch.
    first: Vec<usize>,
    shares: Vec<[f64; MOST_CELLS]>,
    /// Which neighbours of each occupied cell are occupied, lower and upper a direction, where the occupied cells of
    /// its patch fill a rectangle.
    sides: Vec<Option<[[bool; 2]; D]>>,
    /// The change of the occupied cells that the sides belong to.
    listed_change: usize,
    /// Whether the rows above are of the points' places; elsewhere each is made where it is taken.
    is_stored: bool,
}

impl<const D: usize> PatchRows<D> {
    /// Room for `points` points on a grid.
    pub fn new(points: usize, grid: &Grid<D>) -> Self {
        Self {
            first: vec![0; points],
            shares: vec![[0.0; MOST_CELLS]; points],
            sides: vec![None; grid.cell_count()],
            listed_change: 0,
            is_stored: false,
        }
    }

    /// Fits the rows to the points' places and to the occupied cells.
    #[inline(always)]
    pub fn build(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        self.look_around(grid, cells);
        self.is_stored = true;
        let count = cells.of_point.len();
        let (mut first, mut shares) = (std::mem::take(&mut self.first), std::mem::take(&mut self.shares));
        let fitting = self.fitting(grid, cells, count);
        for (point, (first, shares)) in (0..count).zip(first.iter_mut().zip(&mut shares)) {
            (*first, *shares) = (fitting.homes[point] - fitting.to_lowest, fitting.shares(point));
        }
        (self.first, self.shares) = (first, shares);
    }

    /// Takes note of the occupied cells: rows are made of the points' places where they are taken.
    pub fn look_around(&mut self, grid: &Grid<D>, cells: &Cells<D>) {
        if self.listed_change != cells.changes() {
            for cell in cells.occupied() {
                self.sides[cell] = sides_of(grid, cells, cell);
            }
            self.listed_change = cells.changes();
        }
        self.is_stored = false;
    }

    /// What rows are made of, of so many points.
    #[inline(always)]
    fn fitting<'a>(&'a self, grid: &'a Grid<D>, cells: &'a Cells<D>, points: usize) -> Fitting<'a, D> {
        Fitting {
            grid,
            cells,
            homes: &cells.of_point[..points],
            within: &cells.within[..points],
            sides: &self.sides,
            to_lowest: grid.cell_stride().iter().sum(),
            up: grid.cell_stride()[D - 1],
        }
    }

    /// Fits the rows of a body of several soils to those cells around each point that hold the point's own: a pressure has
    /// a kink where the conductivity jumps, and no line across it is near either side.
    pub fn keep_to_soils(&mut self, grid: &Grid<D>, cells: &Cells<D>, soils: &[u8]) {
        let mut held = vec![0_u64; grid.cell_count()];
        for (cell, soil) in cells.of_point.iter().zip(soils) {
            held[*cell] |= 1 << soil;
        }
        for (point, soil) in soils.iter().enumerate() {
            let holds_soil = |cell: usize| held[cell] >> soil & 1 == 1;
            let (home, place) = (cells.of_point[point], &cells.place[point]);
            fit(grid, home, place, &mut self.shares[point], holds_soil);
        }
    }

    /// Puts the values at the points of a field given at the cells into their places.
    #[inline(always)]
    pub fn recover(
        &self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        field: &[f64],
        out: &mut [f64],
        put: impl Fn(&mut f64, f64),
    ) {
        let fitting = self.fitting(grid, cells, out.len());
        if self.is_stored {
            for (place, (first, shares)) in out.iter_mut().zip(self.first.iter().zip(&self.shares)) {
                put(place, fitting.sum(field, *first, shares));
            }
            return;
        }
        let mut point = 0;
        while point < out.len() {
            let places = out[point..].first_chunk_mut::<LANES>();
            if let (Some(places), Some(values)) = (places, fitting.values::<LANES>(field, point)) {
                for p in 0..LANES {
                    put(&mut places[p], values[p]);
                }
                point += LANES;
            } else {
                put(&mut out[point], fitting.value(field, point));
                point += 1;
            }
        }
    }

    /// The cells of a point's patch with their shares.
    pub fn row(&self, grid: &Grid<D>, cells: &Cells<D>, point: usize) -> Vec<(usize, f64)> {
        let fitting = self.fitting(grid, cells, cells.of_point.len());
        let shares = if self.is_stored { self.shares[point] } else { fitting.shares(point) };
        let first = fitting.homes[point] - fitting.to_lowest;
        let cells = (0..power(BLOCK, D)).map(|block| block_cell(grid, first, block).0);
        cells.zip(shares).collect()
    }
}

/// What rows are made of, as slices of one length.
#[derive(Clone, Copy)]
struct Fitting<'a, const D: usize> {
    grid: &'a Grid<D>,
    cells: &'a Cells<D>,
    homes: &'a [usize],
    within: &'a [Vector<D>],
    sides: &'a [Option<[[bool; 2]; D]>],
    /// From the lowest cell of a patch to its middle, and to the next row of cells.
    to_lowest: usize,
    up: usize,
}

impl<const D: usize> Fitting<'_, D> {
    /// Fits lines through the cells around each of `N` points from one on along each direction, where the occupied cells
    /// fill rectangles of one shape; false elsewhere, and where there are fewer points.
    #[inline(always)]
    fn fit_lines<const N: usize>(&self, first: usize, lines: &mut [LineFit<N>; D]) -> bool {
        let Some(homes) = self.homes.get(first..first + N) else { return false };
        let within = &self.within[first..first + N];
        let sides = self.sides[homes[0]];
        let is_alike = |home: &usize| self.sides[*home] == sides;
        if *homes != [homes[0]; N] && !homes.iter().all(is_alike) {
            return false;
        }
        let Some(sides) = sides else { return false };
        for d in 0..D {
            let mut offsets = [0.0; N];
            for p in 0..N {
                offsets[p] = 0.5 - within[p][d];
            }
            lines[d].fit(&offsets, sides[d], D > 1);
        }
        true
    }

    /// Shares of the cells around a point.
    ///
    /// The weights of the fit are products over the directions, and where the occupied cells fill a rectangle the
    /// moments that the normal equations mix vanish: with the row `r` of the line through the cells along a
    /// direction and the shares `a` of their weights, the plane's row is `r_i a_j + a_i r_j − a_i a_j`.
    #[inline(always)]
    fn shares(&self, point: usize) -> [f64; MOST_CELLS] {
        let mut shares = [0.0; MOST_CELLS];
        let mut lines = [LineFit::NOTHING; D];
        if !self.fit_lines::<1>(point, &mut lines) {
            let is_in = |cell| self.cells.is_occupied(cell);
            fit(self.grid, self.homes[point], &self.cells.place[point], &mut shares, is_in);
            return shares;
        }
        let [along, up] = [&lines[0], &lines[D - 1]];
        for j in 0..power(BLOCK, D - 1) {
            let ([row], [shared]) = (up.row[j], up.shares[j]);
            let (share, tilt) = if D == 1 { (1.0, 0.0) } else { (shared, row - shared) };
            for i in 0..BLOCK {
                shares[BLOCK * j + i] = along.row[i][0] * share + along.shares[i][0] * tilt;
            }
        }
        shares
    }

    /// Value at a point of a field given at the cells.
    #[inline(always)]
    fn value(&self, field: &[f64], point: usize) -> f64 {
        if let Some([value]) = self.values::<1>(field, point) {
            return value;
        }
        self.sum(field, self.homes[point] - self.to_lowest, &self.shares(point))
    }

    /// Values at `N` neighbours from one on, where there are lines for [all of them](Self::fit_lines).
    #[inline(always)]
    fn values<const N: usize>(&self, field: &[f64], first: usize) -> Option<[f64; N]> {
        let mut lines = [LineFit::NOTHING; D];
        if !self.fit_lines(first, &mut lines) {
            return None;
        }
        let homes = &self.homes[first..first + N];
        // What neighbours in one cell take of the field is read once.
        Some(if *homes == [homes[0]; N] {
            self.combined(&lines, field, |_| homes[0])
        } else {
            self.combined(&lines, field, |p| homes[p])
        })
    }

    /// Values at points with their lines, of a field given at the cells; `home` is the cell of a point by its place among
    /// them.
    #[inline(always)]
    fn combined<const N: usize>(
        &self,
        lines: &[LineFit<N>; D],
        field: &[f64],
        home: impl Fn(usize) -> usize,
    ) -> [f64; N] {
        let [along, up] = [&lines[0], &lines[D - 1]];
        let mut values = [0.0; N];
        for j in 0..power(BLOCK, D - 1) {
            // `[cell][point]`.
            let mut cells = [[0.0; N]; BLOCK];
            for p in 0..N {
                let of_point = &field[home(p) - self.to_lowest + j * self.up..][..BLOCK];
                for k in 0..BLOCK {
                    cells[k][p] = of_point[k];
                }
            }
            if D == 1 {
                return sum_of_each(&along.row, &cells);
            }
            let of_row = sum_of_each(&along.row, &cells);
            for p in 0..N {
                values[p] += of_row[p] * up.shares[j][p];
            }
            let of_shares = sum_of_each(&along.shares, &cells);
            for p in 0..N {
                values[p] += of_shares[p] * (up.row[j][p] - up.shares[j][p]);
            }
        }
        values
    }

    /// Sum over a patch of the values of its cells times their shares.
    #[inline(always)]
    fn sum(&self, field: &[f64], first: usize, shares: &[f64; MOST_CELLS]) -> f64 {
        let mut value = 0.0;
        for j in 0..power(BLOCK, D - 1) {
            let lowest = first + j * self.up;
            let cells = &field[lowest..lowest + BLOCK];
            let shares = &shares[BLOCK * j..BLOCK * j + BLOCK];
            value += shares[0] * cells[0] + shares[1] * cells[1] + shares[2] * cells[2];
        }
        value
    }
}

/// Sums over three cells of their values times shares, `[cell][point]`.
#[inline(always)]
fn sum_of_each<const N: usize>(shares: &[[f64; N]; BLOCK], cells: &[[f64; N]; BLOCK]) -> [f64; N] {
    let mut sums = [0.0; N];
    for p in 0..N {
        sums[p] = shares[0][p] * cells[0][p] + shares[1][p] * cells[1][p] + shares[2][p] * cells[2][p];
    }
    sums
}

/// Flat cell of a place in a patch, and its steps from the patch's lowest cell.
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

/// Which neighbours of a cell are occupied along each direction; none where the occupied cells of its patch fill no
/// rectangle.
fn sides_of<const D: usize>(grid: &Grid<D>, cells: &Cells<D>, cell: usize) -> Option<[[bool; 2]; D]> {
    let stride = grid.cell_stride();
    let sides: [[bool; 2]; D] =
        std::array::from_fn(|d| [cells.is_occupied(cell - stride[d]), cells.is_occupied(cell + stride[d])]);
    let first = cell - stride.iter().sum::<usize>();
    let is_rectangle = (0..power(BLOCK, D)).all(|block| {
        let (other, steps) = block_cell(grid, first, block);
        let is_in = (0..D).all(|d| [sides[d][0], true, sides[d][1]][steps[d]]);
        cells.is_occupied(other) == is_in
    });
    is_rectangle.then_some(sides)
}

/// Cubic spline of the distance `d` in cells with radius two cells (Monaghan & Lattanzio 1985,
/// as used in moving least squares): positive inside, smooth to zero.
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

/// The lines fitted along one direction through the cells around each of `N` points, `[cell][point]`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LineFit<const N: usize> {
    /// Shares of the cells in the line's value at the point.
    row: [[f64; N]; BLOCK],
    /// Shares of the cells in the sum of the weights of the fit.
    shares: [[f64; N]; BLOCK],
}

impl<const N: usize> LineFit<N> {
    const NOTHING: Self = Self { row: [[0.0; N]; BLOCK], shares: [[0.0; N]; BLOCK] };

    /// Takes the lines of points by the offsets of their cells' centres from them.
    #[inline(always)]
    fn fit(&mut self, offsets: &[f64; N], neighbours: [bool; 2], takes_shares: bool) {
        // Between two neighbours a loop without a branch.
        match neighbours {
            [true, true] => self.fit_by(offsets, [true, true], takes_shares),
            [false, false] => self.fit_by(offsets, [false, false], takes_shares),
            one_sided => self.fit_by(offsets, one_sided, takes_shares),
        }
    }

    #[inline(always)]
    fn fit_by(&mut self, offsets: &[f64; N], neighbours: [bool; 2], takes_shares: bool) {
        for p in 0..N {
            let [row, shares] = line_shares(offsets[p], neighbours, takes_shares);
            for k in 0..BLOCK {
                (self.row[k][p], self.shares[k][p]) = (row[k], shares[k]);
            }
        }
    }
}

/// Shares of the cells in the value of the line of a point whose cell's centre lies so far above it, in cells, with the
/// neighbours that are there, and in the sum of the weights of its fit: the
/// same fit as [`fit`] in closed form, for moving points pay for it at every step. A column has no use for the
/// shares.
///
/// The spline is the cubic B-spline, whose four values around a point have the moments 1, 0 and 1/3.
/// The patch lacks the outermost, `u³/6` at the distance `2 − u` on the near side, `u = |offset|`,
/// which gives its own moments, and the fit's weights from them. With one neighbour it is the line through two
/// cells, with none the value of the only one.
#[inline(always)]
fn line_shares(offset: f64, neighbours: [bool; 2], takes_shares: bool) -> [[f64; BLOCK]; 2] {
    if neighbours == [true, true] {
        let u = offset.abs();
        let (rest, square) = (1.0 - u, u * u);
        let far = SIXTH * rest * rest * rest;
        let home = 2.0 / 3.0 - square + 0.5 * square * u;
        let lacking = SIXTH * square * u;
        let near = 1.0 - home - far - lacking;
        let (lever, tilt) = (2.0 - u, 3.0 * lacking * (2.0 - u));
        let scale = 1.0 / (1.0 - lacking - tilt * lever);
        let (row_near, row_far) = (near * (1.0 - tilt) * scale, far * (1.0 - 3.0 * tilt) * scale);
        let is_above = offset > 0.0;
        let of_sides = |near: f64, far: f64| {
            let [low, high] = [if is_above { near } else { far }, if is_above { far } else { near }];
            [low, 1.0 - near - far, high]
        };
        let per_sum = if takes_shares { 1.0 / (1.0 - lacking) } else { 1.0 };
        return [of_sides(row_near, row_far), of_sides(near * per_sum, far * per_sum)];
    }
    let row = match neighbours {
        [false, true] => [0.0, 1.0 + offset, -offset],
        [true, false] => [offset, 1.0 - offset, 0.0],
        _ => return [[0.0, 1.0, 0.0]; 2],
    };
    let is_there = [neighbours[0], true, neighbours[1]];
    let mut shares = [0.0; BLOCK];
    for k in (0..BLOCK).filter(|k| is_there[*k]) {
        shares[k] = distance_weight(offset + k as f64 - 1.0);
    }
    let sum: f64 = shares.iter().sum();
    for share in &mut shares {
        *share /= sum;
    }
    [row, shares]
}

/// The row of a point in a patch of any of the cells around, by the normal equations.
fn fit<const D: usize>(
    grid: &Grid<D>,
    home: usize,
    place: &Vector<D>,
    row: &mut [f64],
    is_in: impl Fn(usize) -> bool,
) {
    let (index, stride) = (grid.cell_index(home), grid.cell_stride());
    let first = home - stride.iter().sum::<usize>();
    let mut patch = Patch::<D>::empty();
    for block in 0..power(BLOCK, D) {
        let (cell, steps) = block_cell(grid, first, block);
        if is_in(cell) {
            patch.add(block, std::array::from_fn(|d| (index[d] + steps[d]) as f64 - 0.5 - place[d]));
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
