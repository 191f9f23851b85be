//! Fading pressure lines of double-point MPM. Own invention; without them the errors late in a consolidation are three times
//! as large (docs/methods.md).
//!
//! ```text
//! p_w ← p_w + η [p̄_c + G_c p̄·(x_w − x_c) − p_w],   g_w ← g_w + η (G_c p̄ − g_w),   η = 2 |v_c| Δt/h
//! ```
//!
//! A cell presses with one value and has one rate. What its points carry beyond it is the memory of other cells and of
//! what passed there: no force sees it and no rate makes it good. It fades while the water goes through the cells, by
//! `e²` a cell, and only as it does. What cells press with stays as it is, and so does the energy.

use crate::integrate::double_point::DoublePoint;
use crate::state::grid::{GHOST_LAYERS, Grid};
use oedometer_soil::tensor::Vector;

/// Number of times that the deviation of a point from the line of its cell falls by a factor `e` while the water crosses
/// a cell.
const FADINGS_PER_CELL: f64 = 2.0;

impl<const D: usize> DoublePoint<D> {
    /// Computes the middles of the parts that the soil fills in cells with water points.
    pub(crate) fn take_middles(&mut self) {
        let surface = self.body.actions.surface.lowest(&self.body.points);
        for cell in self.cells.occupied() {
            self.middles[cell] = middle_of(&self.body.grid, cell, surface);
        }
    }

    /// Takes the slope over each cell with water points of values that it and some of its neighbours have, per m:
    /// between the neighbours, or to the only one, along each direction.
    pub(crate) fn take_slopes(&mut self, value: impl Fn(&Self, usize) -> Option<f64>) {
        let mut slopes = std::mem::take(&mut self.slopes);
        let (stride, middles) = (*self.body.grid.cell_stride(), &self.middles);
        for cell in self.cells.occupied() {
            let centre = value(self, cell);
            slopes[cell] = std::array::from_fn(|d| {
                let Some(centre) = centre else { return 0.0 };
                let or_centre =
                    |other: usize| value(self, other).map_or((cell, centre), |value| (other, value));
                let ((lower, low), (upper, high)) =
                    (or_centre(cell - stride[d]), or_centre(cell + stride[d]));
                if lower == upper { 0.0 } else { (high - low) / (middles[upper][d] - middles[lower][d]) }
            });
        }
        self.slopes = slopes;
    }

    /// Damps the deviations of the points from the pressure lines of their cells, in a step of so many seconds.
    pub(crate) fn fade_beyond_lines(&mut self, dt: f64) {
        self.sum_cell_pressures(0);
        for cell in self.cells.occupied() {
            let share = self.fading_share(cell, dt);
            let [pressed, volume, pressure, fading] = &mut self.cell_sums[cell];
            (*pressure, *fading) = (*pressed / *volume, share);
        }
        self.take_slopes(|double, cell| {
            let [_, volume, pressure, _] = double.cell_sums[cell];
            (volume > 0.0).then_some(pressure)
        });
        let water = &mut self.water;
        for (point, cell) in self.cells.of_point.iter().enumerate() {
            let [.., pressure, share] = self.cell_sums[*cell];
            let (slope, middle) = (&self.slopes[*cell], &self.middles[*cell]);
            let along = |d: usize| slope[d] * (water.place[point][d] - middle[d]);
            let line = pressure + (0..D).map(along).sum::<f64>();
            water.pressure[point] += share * (line - water.pressure[point]);
            for d in 0..D {
                water.slope[point][d] += share * (slope[d] - water.slope[point][d]);
            }
        }
    }

    /// Share of it that fades in a step of so many seconds, by the speed of the water in the middle of a cell.
    fn fading_share(&self, cell: usize, dt: f64) -> f64 {
        let (grid, velocity) = (&self.body.grid, &self.body.nodes.water_velocity);
        let corners = grid.corners(self.cells.first_node(cell));
        let sum = corners
            .fold([0.0; D], |sum: Vector<D>, node| std::array::from_fn(|d| sum[d] + velocity[node][d]));
        let speed = sum.iter().map(|along| along * along).sum::<f64>().sqrt() / (1_usize << D) as f64;
        (FADINGS_PER_CELL * speed * dt / grid.cell_size).min(1.0)
    }
}

/// Middle of what the soil fills of a cell, m; `surface` is the lowest height of its surface, m.
fn middle_of<const D: usize>(grid: &Grid<D>, cell: usize, surface: f64) -> Vector<D> {
    let (index, up) = (grid.cell_index(cell), D - 1);
    let base = |d: usize| (index[d] as f64 - GHOST_LAYERS as f64) * grid.cell_size;
    std::array::from_fn(|d| {
        let top = base(d) + grid.cell_size;
        0.5 * (base(d) + if d == up { surface.min(top) } else { top })
    })
}

#[cfg(test)]
mod tests {
    use super::middle_of;
    use crate::tests::double_point_columns::with_water_shifted;

    #[test]
    fn deviations_from_the_pressure_line_fade_and_forces_of_cells_stay() {
        let mut double = with_water_shifted("GIMP-SRI-patch", 3);
        let line = |place: f64| 1e4 + 2e4 * place;
        for (pressure, place) in double.water.pressure.iter_mut().zip(&double.water.place) {
            *pressure = line(place[0]);
        }
        double.water.slope.fill([2e4]);
        // Three points of one cell off their line, one of them in its slope too.
        let odd = [(6, 50.0), (7, -100.0), (8, 50.0)];
        for (point, off) in odd {
            double.water.pressure[point] += off;
        }
        double.water.slope[7] = [2.6e4];
        double.sum_cell_pressures(0);
        let before = double.cell_sums.clone();
        // Through a quarter of a cell: e² a cell is to first order a half of it.
        double.body.nodes.water_velocity.fill([-0.01]);
        double.fade_beyond_lines(5.0);
        double.sum_cell_pressures(0);
        for cell in double.cells.of_point.clone() {
            let ([before, ..], [after, ..]) = (before[cell], double.cell_sums[cell]);
            assert!((after / before - 1.0).abs() < 1e-12, "{after} for {before}");
        }
        // The slope of one of three points moves what their cell presses with, and so the line that they fade to.
        let moved = 6e3 * (0.5 - double.water.place[7][0]) / 3.0;
        for (point, off) in odd {
            let left = double.water.pressure[point] - line(double.water.place[point][0]);
            assert!((left - 0.5 * (off + moved)).abs() < 0.01, "{left} of {off}");
        }
        let slope = double.water.slope[7][0];
        assert!((slope - 2.3e4).abs() < 1.0, "{slope}");
        // Where no water goes, nothing fades.
        let pressures = double.water.pressure.clone();
        double.body.nodes.water_velocity.fill([0.0]);
        double.fade_beyond_lines(5.0);
        assert_eq!(double.water.pressure, pressures);
    }

    #[test]
    fn the_surface_cuts_the_middle_of_its_cell_and_the_slope_through_it() {
        let mut double = with_water_shifted("GIMP-SRI-patch", 3);
        let top = *double.cells.of_point.last().expect("points");
        let (grid, surface) = (double.body.grid.clone(), 0.9);
        assert!((middle_of(&grid, top, surface)[0] - 0.85).abs() < 1e-12);
        assert!((middle_of(&grid, top - 1, surface)[0] - 0.7).abs() < 1e-12);
        // Values that lie on a line in those middles, and no value above.
        for cell in double.cells.occupied() {
            double.middles[cell] = middle_of(&grid, cell, surface);
        }
        double.take_slopes(|_, cell| (cell <= top).then(|| 3.0 * middle_of(&grid, cell, surface)[0]));
        for cell in [top, top - 1, top - 2] {
            let [slope] = double.slopes[cell];
            assert!((slope - 3.0).abs() < 1e-9, "{slope}");
        }
        double.take_slopes(|_, cell| (cell == top).then_some(1.0));
        assert_eq!(double.slopes[top], [0.0]);
    }
}
