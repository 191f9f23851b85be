//! The pressure that a cell presses with, where a cell knows one rate of it and the points are given more.
//!
//! ```text
//! p̄_c = Σ_w ω_w p_w/Σ_w ω_w,   ω_w = V_w [1 + (y_c − ȳ)(y_w − ȳ)/s²],   Δp_w = (R Δp)_w + Δp_c − Σ_w ω_w (R Δp)_w/Σ_w ω_w
//! ```
//!
//! with the mean `ȳ` and the variance `s²` of the heights of the points of the cell, weighted with their volumes: the
//! line of least squares through their pressures, at the middle `y_c` of what the soil fills of the cell. It takes the
//! cell's rate whatever the recovery `R` gives to single points, so that forces of `p̄` stay the adjoint of rates.

use crate::mpm::layers::two_layers::TwoLayers;
use crate::mpm::state::grid::GHOST_LAYERS;

/// Variance of the heights of a cell's points, over its size squared, below which no line goes through them.
const LEAST_VARIANCE: f64 = 1e-4;

impl<const D: usize> TwoLayers<D> {
    /// Weighs the points in what their cells press with: by their volumes, and where the points of a cell are given
    /// slopes by their heights too.
    pub(crate) fn weigh_points(&mut self) {
        let (water, weights) = (&self.water, &mut self.weights);
        weights.clear();
        weights.extend((0..water.len()).map(|point| water.volume_inside(point)));
        if !self.keeps_cell_rates {
            return;
        }
        let (size, up) = (self.body.grid.cell_size, self.body.grid.cell_stride()[D - 1]);
        let surface = self.body.surface.lowest(&self.body.points);
        let sums = &mut self.sums.cells;
        sums.fill([0.0; 4]);
        for (point, volume) in weights.iter().enumerate() {
            let height = water.place[point][D - 1];
            let sum = &mut sums[self.cells.of_point[point]];
            for (sum, power) in sum.iter_mut().zip([1.0, height, height * height]) {
                *sum += volume * power;
            }
        }
        for (point, weight) in weights.iter_mut().enumerate() {
            let cell = self.cells.of_point[point];
            let [volume, first, second, _] = sums[cell];
            let mean = first / volume;
            let variance = second / volume - mean * mean;
            if variance <= LEAST_VARIANCE * size * size {
                continue;
            }
            let base = (cell / up) as f64 * size - GHOST_LAYERS as f64 * size;
            let middle = 0.5 * (base + surface.min(base + size));
            *weight *= 1.0 + (middle - mean) / variance * (water.place[point][D - 1] - mean);
        }
    }

    /// Sums weights, and with them the pressures of the points, over each cell, into its sums from a place on.
    pub(crate) fn sum_cell_pressures(&mut self, place: usize) {
        let sums = &mut self.sums.cells;
        for sum in &mut *sums {
            sum[place..place + 2].fill(0.0);
        }
        for (point, pressure) in self.water.pressure.iter().enumerate() {
            let (weight, sum) = (self.weights[point], &mut sums[self.cells.of_point[point]]);
            sum[place] += weight * pressure;
            sum[place + 1] += weight;
        }
    }

    /// Gives the points of every cell what its pressure lacks of the cell's own increment: the sums of before stand at
    /// the first places of a cell's.
    pub(crate) fn keep_cell_rates(&mut self) {
        self.sum_cell_pressures(2);
        for (point, pressure) in self.water.pressure.iter_mut().enumerate() {
            let cell = self.cells.of_point[point];
            let [before, weight, after, _] = self.sums.cells[cell];
            *pressure += self.site_values[cell] + (before - after) / weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::mpm::layers::cell_forces::tests::shifted;

    #[test]
    fn a_line_of_pressures_presses_with_its_value_in_the_middle() {
        let mut layers = shifted("GIMP-SRI-patch");
        assert!(layers.keeps_cell_rates);
        for (pressure, place) in layers.water.pressure.iter_mut().zip(&layers.water.place) {
            *pressure = 1e4 + 2e4 * place[0];
        }
        layers.sum_cell_pressures(0);
        let cell = layers.cells.of_point[7];
        let [pressed, weight, ..] = layers.sums.cells[cell];
        // The third cell of five of a column of a metre.
        assert!((pressed / weight - (1e4 + 2e4 * 0.5)).abs() < 1e-6, "{}", pressed / weight);
        let plain: f64 = (0..layers.water.len())
            .filter(|point| layers.cells.of_point[*point] == cell)
            .map(|point| layers.water.volume_inside(point))
            .sum();
        assert!((weight / plain - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_cell_takes_its_own_rate_and_its_points_the_slope_of_their_patch() {
        let mut layers = shifted("GIMP-SRI-patch");
        // A flux whose divergence grows with the height.
        let grid = &layers.body.grid;
        let heights: Vec<f64> =
            (0..layers.body.nodes.len()).map(|node| grid.node_position(node)[0]).collect();
        for (node, height) in heights.iter().enumerate() {
            let velocity = [-1e-9 * height * height];
            (layers.body.nodes.solid_velocity[node], layers.body.nodes.water_velocity[node]) =
                (velocity, velocity);
        }
        layers.sum_cell_pressures(0);
        let before = layers.sums.cells.clone();
        let pressures = layers.water.pressure.clone();
        layers.update_pressure(1e-3);
        layers.sum_cell_pressures(0);
        for cell in layers.cells.of_point.clone() {
            let ([one, weight, ..], [two, ..]) = (before[cell], layers.sums.cells[cell]);
            let (found, rate) = ((two - one) / weight, layers.site_values[cell]);
            assert!(rate > 0.0 && (found / rate - 1.0).abs() < 1e-6, "{found} for {rate}");
        }
        // −Δt (K_w/n) ∇·v has the slope 2e-9 Δt K_w/n over the height, at n = 0.3.
        let of = |point: usize| layers.water.pressure[point] - pressures[point];
        let (low, high) = (6, 8);
        assert_eq!(layers.cells.of_point[low], layers.cells.of_point[high]);
        let slope = (of(high) - of(low)) / (layers.water.place[high][0] - layers.water.place[low][0]);
        assert!((slope / 0.014_667 - 1.0).abs() < 0.01, "{slope}");
    }
}
