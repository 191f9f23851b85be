//! The pressure that a cell presses with, where a cell knows one rate of it and the points are given more.
//!
//! ```text
//! p̄_c = Σ_w V_w [p_w + g_w·(x_c − x_w)]/Σ_w V_w      Δg_w = G_c Δp,   Δp_w = (R Δp)_w + a_c   so that  Δp̄_c = Δp_c
//! ```
//!
//! Every point carries the slope `g` of the pressure where it is, which takes the slope of the cells' rates, and tells
//! what its line says in the middle `x_c` of what the soil fills of its cell. `p̄` then takes the cell's rate whatever
//! the recovery `R` gives to single points, and however few they are, so that forces of `p̄` stay the adjoint of rates.

use crate::layers::two_layers::TwoLayers;

impl<const D: usize> TwoLayers<D> {
    /// Sums the volumes of the points of each cell, and with them what their lines say in its middle, into the cell's
    /// sums from a place on.
    pub(crate) fn sum_cell_pressures(&mut self, place: usize) {
        let (water, sums) = (&self.water, &mut self.sums);
        for sum in &mut sums.cells {
            sum[place..place + 2].fill(0.0);
        }
        for (point, cell) in self.cells.of_point.iter().enumerate() {
            let mut pressure = water.pressure[point];
            if self.keeps_cell_rates {
                let (slope, middle) = (&water.slope[point], &sums.middles[*cell]);
                pressure += (0..D).map(|d| slope[d] * (middle[d] - water.place[point][d])).sum::<f64>();
            }
            let (volume, sum) = (water.volume_inside(point), &mut sums.cells[*cell]);
            sum[place] += volume * pressure;
            sum[place + 1] += volume;
        }
    }

    /// Gives the points of every cell the slope of the rates around it, and what its pressure then lacks of the cell's
    /// own increment: the sums of before stand at the first places of a cell's.
    pub(crate) fn keep_cell_rates(&mut self) {
        self.take_slopes(|layers, cell| layers.cells.is_occupied(cell).then(|| layers.site_values[cell]));
        for (slope, cell) in self.water.slope.iter_mut().zip(&self.cells.of_point) {
            for d in 0..D {
                slope[d] += self.sums.slopes[*cell][d];
            }
        }
        self.sum_cell_pressures(2);
        for (pressure, cell) in self.water.pressure.iter_mut().zip(&self.cells.of_point) {
            let [before, volume, after, _] = self.sums.cells[*cell];
            *pressure += self.site_values[*cell] + (before - after) / volume;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::tests::two_layer_columns::with_water_shifted;

    #[test]
    fn a_line_of_pressures_presses_with_its_value_in_the_middle() {
        // Of a single point too, wherever in its cell it lies.
        for of_water in [1, 3] {
            let mut layers = with_water_shifted("GIMP-SRI-patch", of_water);
            assert!(layers.keeps_cell_rates);
            for (pressure, place) in layers.water.pressure.iter_mut().zip(&layers.water.place) {
                *pressure = 1e4 + 2e4 * place[0];
            }
            layers.water.slope.fill([2e4]);
            layers.sum_cell_pressures(0);
            let cell = layers.cells.of_point[2 * of_water];
            let [pressed, volume, ..] = layers.sums.cells[cell];
            // The third cell of five of a column of a metre.
            assert!((pressed / volume - (1e4 + 2e4 * 0.5)).abs() < 1e-6, "{}", pressed / volume);
            let held: f64 = (0..layers.water.len())
                .filter(|point| layers.cells.of_point[*point] == cell)
                .map(|point| layers.water.volume_inside(point))
                .sum();
            assert!((volume / held - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_cell_takes_its_own_rate_and_its_points_the_slope_of_their_patch() {
        for of_water in [1, 3] {
            let mut layers = with_water_shifted("GIMP-SRI-patch", of_water);
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
                let ([one, volume, ..], [two, ..]) = (before[cell], layers.sums.cells[cell]);
                let (found, rate) = ((two - one) / volume, layers.site_values[cell]);
                assert!(rate > 0.0 && (found / rate - 1.0).abs() < 1e-6, "{found} for {rate}");
            }
            // −Δt (K_w/n) ∇·v has the slope 2e-9 Δt K_w/n over the height, at n = 0.3: in what a point carries, and
            // from one point to another.
            let slope = layers.water.slope[2 * of_water][0];
            assert!((slope / 0.014_667 - 1.0).abs() < 0.01, "{slope}");
            let of = |point: usize| layers.water.pressure[point] - pressures[point];
            let (low, high) = if of_water == 1 { (1, 2) } else { (6, 8) };
            let slope = (of(high) - of(low)) / (layers.water.place[high][0] - layers.water.place[low][0]);
            assert!((slope / 0.014_667 - 1.0).abs() < 0.01, "{slope}");
        }
    }
}
