//! Forces of a pressure that cells know one rate of: the adjoint of that rate.
//!
//! ```text
//! f_i = Σ_c V_c p̄_c ∇N_i(x_c),   p̄_c of the points of the cell (`cell_pressures`),   V_c = |cell ∩ domains|
//! ```
//!
//! A cell has one rate of the pressure, which what it presses with takes. Forces of each point by its own weights are
//! then no adjoint of rates once points are off the middle of their cells: the wave operator is not symmetric, and waves
//! grow at any step. With the cell's pressure at its centre, where its divergence is taken, they do not. A uniform
//! pressure presses as before: what of a cell the domains fill is counted where it lies.

use crate::layers::two_layers::TwoLayers;

impl<const D: usize> TwoLayers<D> {
    /// Adds the forces of the cells' mean pressures to those on the mixture and on the water.
    pub(crate) fn map_cell_forces(&mut self) {
        self.sum_cells();
        let (grid, nodes) = (&self.body.grid, &mut self.body.nodes);
        for (cell, [of_points, volume, of_domains, filled]) in self.sums.cells.iter().enumerate() {
            if !self.cells.is_occupied(cell) || *filled <= 0.0 {
                continue;
            }
            // A cell that only edges reach into has the pressure of their points.
            let mean = if *volume > 0.0 { of_points / volume } else { of_domains / filled };
            self.cells.visit_centre(grid, cell, |node, gradient| {
                for d in 0..D {
                    let force = filled * mean * gradient[d];
                    nodes.mixture_force[node][d] += force;
                    nodes.water_force[node][d] += force;
                }
            });
        }
    }

    fn sum_cells(&mut self) {
        self.sum_cell_pressures(0);
        let (grid, water, sums) = (&self.body.grid, &self.water, &mut self.sums.cells);
        let cell_volume: f64 = (0..D).map(|_| grid.cell_size).product();
        for sum in &mut *sums {
            sum[2..].fill(0.0);
        }
        for (point, pressure) in water.pressure.iter().enumerate() {
            let end = |side: f64| {
                let reach = |d: usize| water.place[point][d] + side * water.reach[point][d];
                grid.held_in_cells(&std::array::from_fn(reach))
            };
            let (low, high) = (end(-1.0), end(1.0));
            let (first, last) = (grid.cell_at(&low), grid.cell_at(&high));
            let mut cell = first;
            // All cells from the first to the last, the first direction fastest.
            loop {
                let along = |d: usize| high[d].min((cell[d] + 1) as f64) - low[d].max(cell[d] as f64);
                let filled = (0..D).map(along).product::<f64>() * cell_volume;
                let [_, _, of_domains, of_cell] = &mut sums[grid.flat_cell(&cell)];
                *of_domains += filled * pressure;
                *of_cell += filled;
                let Some(d) = (0..D).find(|d| cell[*d] < last[*d]) else { break };
                cell[..d].copy_from_slice(&first[..d]);
                cell[d] += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::layers::two_layers::TwoLayers;
    use crate::tests::two_layer_columns::with_water_shifted;

    #[test]
    fn a_uniform_pressure_presses_by_cells_as_by_points() {
        for method in ["GIMP-SRI", "GIMP-SRI-patch"] {
            let mut layers = with_water_shifted(method, 3);
            assert!(layers.presses_by_cells);
            layers.water.pressure.fill(3e4);
            layers.map_forces();
            let by_cells = layers.body.nodes.water_force.clone();
            layers.presses_by_cells = false;
            layers.map_forces();
            for (by_cells, by_points) in by_cells.iter().zip(&layers.body.nodes.water_force) {
                // The undrained start has shortened the column by a part in a hundred thousand.
                assert!((by_cells[0] - by_points[0]).abs() < 1.0, "{by_cells:?} {by_points:?}");
            }
            assert!(by_cells.iter().any(|force| force[0].abs() > 1e4));
        }
    }

    #[test]
    fn forces_are_the_adjoint_of_the_one_rate_of_a_cell() {
        let mut layers = with_water_shifted("GIMP-SRI", 3);
        for (point, pressure) in layers.water.pressure.iter_mut().enumerate() {
            *pressure = 1e4 * (1.0 + point as f64 * point as f64);
        }
        layers.body.nodes.external_force.fill([0.0]);
        layers.map_forces();
        let work = |field: &[[f64; 1]], layers: &TwoLayers<1>| -> f64 {
            layers
                .body
                .nodes
                .water_force
                .iter()
                .zip(field)
                .map(|(force, velocity)| force[0] * velocity[0])
                .sum()
        };
        // A velocity that dilates one cell alone: its points' mean pressure does the work.
        let cell = layers.cells.of_point[7];
        let node = layers.body.cells.first_node(cell);
        let mut field = vec![[0.0]; layers.body.nodes.len()];
        field[node + 1..].fill([1.0]);
        let own: Vec<usize> = (0..layers.water.len()).filter(|w| layers.cells.of_point[*w] == cell).collect();
        let volume: f64 = own.iter().map(|point| layers.water.volume_inside(*point)).sum();
        let mean: f64 = own
            .iter()
            .map(|point| layers.water.volume_inside(*point) * layers.water.pressure[*point])
            .sum::<f64>()
            / volume;
        let found = work(&field, &layers);
        assert!((found / mean - 1.0).abs() < 1e-9, "{found} for {mean}: a full cell dilates by its face");
    }
}
