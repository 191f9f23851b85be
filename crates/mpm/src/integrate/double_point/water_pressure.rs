//! The pressure of the water points: continuity along the water (docs/theory.md, Eq. 23), and its forces.
//!
//! ```text
//! (n/K_w) D_w p/Dt = −∇·[v_s + n (v_w − v_s)]
//! ```
//!
//! the divergence by the method's `D`, at the water points or in the cells that hold soil, and the way back to the
//! water points by its `R`. Where a cell knows one rate of the pressure, its forces are the adjoint of that rate (docs/theory.md,
//! Eq. 32):
//!
//! ```text
//! f_i = Σ_c V_c p̄_c ∇N_i(x_c),   V_c = |cell ∩ domains|,   p̄_c = Σ_w V_w [p_w + g_w·(x_c − x_w)]/Σ_w V_w
//! Δg_w = G_c Δp,   Δp_w = (R Δp)_w + a_c   so that   Δp̄_c = Δp_c
//! ```
//!
//! Forces of each point by its own shape functions are no adjoint of rates once points are off the middle of their
//! cells: the wave operator is not symmetric, and waves grow whatever the step. Every point carries the slope `g` of the
//! pressure where it is, which takes the slope of the cells' rates, and tells what its line says in the middle `x_c` of
//! what the soil fills of its cell. `p̄` then takes the cell's rate whatever `R` gives to single points, and however few
//! they are. A uniform pressure presses as before: what of a cell the domains fill is counted where it lies.

use crate::integrate::double_point::DoublePoint;
use crate::kernel::volumetric::Place;
use crate::operators::recovery::points_in_cells::PointsInCells;
use oedometer_problem::method::PressureIntegration;
use oedometer_soil::tensor::Vector;

impl<const D: usize> DoublePoint<D> {
    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the water points.
    pub fn update_pressure(&mut self, dt: f64) {
        let body = &mut self.body;
        body.nodes.take_flux();
        body.surface_flux += dt * body.actions.surface.mean_of(&body.grid, &body.points, &body.nodes.flux);
        let bulk_modulus = body.material.water_bulk_modulus;
        self.evaluate_water_sites(|double, place, porosity| {
            let rate = double.body.volume_rate(porosity, |field| double.divergence_at(place, field));
            -dt * bulk_modulus / porosity * rate
        });
        self.recover_pressure();
        if self.keeps_cell_rates {
            self.fade_beyond_lines(dt);
        }
    }

    /// Compresses the water by a displacement of skeleton and water together, m, `[node][component]`.
    pub(super) fn compress_by(&mut self, displacement: &[Vector<D>]) {
        let bulk_modulus = self.body.material.water_bulk_modulus;
        self.evaluate_water_sites(|double, place, porosity| {
            -bulk_modulus / porosity * double.divergence_at(place, displacement)
        });
        self.recover_pressure();
    }

    /// Divergence of a nodal field at a water point or a cell's centre.
    #[inline]
    fn divergence_at(&self, place: Place, field: &[Vector<D>]) -> f64 {
        let grid = &self.body.grid;
        match place {
            Place::Centre(cell) => self.body.cells.centre_divergence(grid, cell, field),
            Place::Point(point) => self.basis.divergence(grid.node_stride(), point, field),
        }
    }

    /// Fills the values at the sites from what a function gives at each from its place and the porosity there: that
    /// of the water point, or the mean over the skeleton's points of the cell.
    #[inline]
    fn evaluate_water_sites(&mut self, value: impl Fn(&Self, Place, f64) -> f64) {
        let mut sites = std::mem::take(&mut self.site_values);
        match self.body.method.pressure {
            PressureIntegration::Points => {
                sites.truncate(self.water.len());
                for (point, site) in sites.iter_mut().enumerate() {
                    *site = value(self, Place::Point(point), self.water.porosity[point]);
                }
            }
            PressureIntegration::Sri => {
                for (cell, site) in sites.iter_mut().enumerate() {
                    *site = if self.cells.is_occupied(cell) {
                        value(self, Place::Centre(cell), self.cells.porosity[cell])
                    } else {
                        0.0
                    };
                }
            }
            PressureIntegration::Mean => {
                sites.fill(0.0);
                for point in 0..self.water.len() {
                    let cell = self.cells.of_point[point];
                    let share = self.water.volume_inside(point) / self.cells.volume(cell);
                    sites[cell] += share * value(self, Place::Point(point), self.cells.porosity[cell]);
                }
            }
        }
        self.site_values = sites;
    }

    /// Adds to the pressures what is recovered from the sites.
    fn recover_pressure(&mut self) {
        if self.keeps_cell_rates {
            self.sum_cell_pressures(0);
        }
        self.recover_increments();
        if self.keeps_cell_rates {
            self.keep_cell_rates();
        }
    }

    fn recover_increments(&mut self) {
        let (body, water) = (&self.body, &mut self.water);
        let at = PointsInCells {
            grid: &body.grid,
            cells: &self.cells,
            nodes: &body.nodes,
            basis: &self.basis,
            positions: &water.place,
            volumes: [&water.volume, &water.share],
        };
        let pressures = &mut water.pressure;
        self.recovery
            .recover(&at, &self.site_values, pressures, |pressure, increment| *pressure += increment);
    }

    /// Adds the forces of each point's pressure, `Σ_w ∇N_iw p_w V_w`.
    pub(super) fn add_pressure_forces(&mut self) {
        let (water, nodes) = (&self.water, &mut self.body.nodes);
        let given = |point: usize| {
            let pressure = water.volume_inside(point) * water.pressure[point];
            std::array::from_fn(|e| [std::array::from_fn(|d| if d == e { pressure } else { 0.0 }); 2])
        };
        self.basis.sum_gradients(self.body.grid.node_stride(), given, &mut nodes.sums.forces);
        for &node in &nodes.active {
            let [force, _] = nodes.sums.forces[node];
            for d in 0..D {
                nodes.mixture_force[node][d] += force[d];
                nodes.water_force[node][d] += force[d];
            }
        }
    }

    /// Adds the forces of the cells' mean pressures to those on the mixture and on the water.
    pub(super) fn add_cell_forces(&mut self) {
        self.sum_cells();
        let (grid, nodes) = (&self.body.grid, &mut self.body.nodes);
        for (cell, [of_points, volume, of_domains, filled]) in self.cell_sums.iter().enumerate() {
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
        let (grid, water, sums) = (&self.body.grid, &self.water, &mut self.cell_sums);
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

    /// Sums the volumes of the points of each cell, and with them what their lines say in its middle, into the cell's
    /// sums from a place on.
    pub(crate) fn sum_cell_pressures(&mut self, place: usize) {
        let water = &self.water;
        for sum in &mut self.cell_sums {
            sum[place..place + 2].fill(0.0);
        }
        for (point, cell) in self.cells.of_point.iter().enumerate() {
            let mut pressure = water.pressure[point];
            if self.keeps_cell_rates {
                let (slope, middle) = (&water.slope[point], &self.middles[*cell]);
                pressure += (0..D).map(|d| slope[d] * (middle[d] - water.place[point][d])).sum::<f64>();
            }
            let (volume, sum) = (water.volume_inside(point), &mut self.cell_sums[*cell]);
            sum[place] += volume * pressure;
            sum[place + 1] += volume;
        }
    }

    /// Gives the points of every cell the slope of the rates around it, and what its pressure then lacks of the cell's
    /// own increment: the sums of before stand at the first places of a cell's.
    pub(crate) fn keep_cell_rates(&mut self) {
        self.take_slopes(|double, cell| double.cells.is_occupied(cell).then(|| double.site_values[cell]));
        for (slope, cell) in self.water.slope.iter_mut().zip(&self.cells.of_point) {
            for d in 0..D {
                slope[d] += self.slopes[*cell][d];
            }
        }
        self.sum_cell_pressures(2);
        for (pressure, cell) in self.water.pressure.iter_mut().zip(&self.cells.of_point) {
            let [before, volume, after, _] = self.cell_sums[*cell];
            *pressure += self.site_values[*cell] + (before - after) / volume;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::integrate::double_point::DoublePoint;
    use crate::tests::double_point_columns::with_water_shifted;

    #[test]
    fn a_uniform_pressure_has_the_same_forces_by_cells_and_by_points() {
        for method in ["GIMP-SRI", "GIMP-SRI-patch"] {
            let mut double = with_water_shifted(method, 3);
            assert!(double.presses_by_cells);
            double.water.pressure.fill(3e4);
            double.map_forces();
            let by_cells = double.body.nodes.water_force.clone();
            double.presses_by_cells = false;
            double.map_forces();
            for (by_cells, by_points) in by_cells.iter().zip(&double.body.nodes.water_force) {
                // The undrained start has shortened the column by a part in a hundred thousand.
                assert!((by_cells[0] - by_points[0]).abs() < 1.0, "{by_cells:?} {by_points:?}");
            }
            assert!(by_cells.iter().any(|force| force[0].abs() > 1e4));
        }
    }

    #[test]
    fn forces_are_the_adjoint_of_the_one_rate_of_a_cell() {
        let mut double = with_water_shifted("GIMP-SRI", 3);
        for (point, pressure) in double.water.pressure.iter_mut().enumerate() {
            *pressure = 1e4 * (1.0 + point as f64 * point as f64);
        }
        double.body.nodes.external_force.fill([0.0]);
        double.map_forces();
        let work = |field: &[[f64; 1]], double: &DoublePoint<1>| -> f64 {
            double
                .body
                .nodes
                .water_force
                .iter()
                .zip(field)
                .map(|(force, velocity)| force[0] * velocity[0])
                .sum()
        };
        // A velocity that dilates one cell alone: its points' mean pressure does the work.
        let cell = double.cells.of_point[7];
        let node = double.body.cells.first_node(cell);
        let mut field = vec![[0.0]; double.body.nodes.len()];
        field[node + 1..].fill([1.0]);
        let points: Vec<usize> =
            (0..double.water.len()).filter(|w| double.cells.of_point[*w] == cell).collect();
        let volume: f64 = points.iter().map(|point| double.water.volume_inside(*point)).sum();
        let mean: f64 = points
            .iter()
            .map(|point| double.water.volume_inside(*point) * double.water.pressure[*point])
            .sum::<f64>()
            / volume;
        let computed = work(&field, &double);
        assert!(
            (computed / mean - 1.0).abs() < 1e-9,
            "{computed} for {mean}: a full cell dilates by its face"
        );
    }

    #[test]
    fn a_linear_pressure_acts_with_its_value_in_the_middle_of_the_cell() {
        // Of a single point too, wherever in its cell it lies.
        for of_water in [1, 3] {
            let mut double = with_water_shifted("GIMP-SRI-patch", of_water);
            assert!(double.keeps_cell_rates);
            for (pressure, place) in double.water.pressure.iter_mut().zip(&double.water.place) {
                *pressure = 1e4 + 2e4 * place[0];
            }
            double.water.slope.fill([2e4]);
            double.sum_cell_pressures(0);
            let cell = double.cells.of_point[2 * of_water];
            let [pressed, volume, ..] = double.cell_sums[cell];
            // The third cell of five of a column of a metre.
            assert!((pressed / volume - (1e4 + 2e4 * 0.5)).abs() < 1e-6, "{}", pressed / volume);
            let held: f64 = (0..double.water.len())
                .filter(|point| double.cells.of_point[*point] == cell)
                .map(|point| double.water.volume_inside(point))
                .sum();
            assert!((volume / held - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_cell_takes_its_own_rate_and_its_points_the_slope_of_their_patch() {
        for of_water in [1, 3] {
            let mut double = with_water_shifted("GIMP-SRI-patch", of_water);
            // A flux whose divergence grows with the height.
            let grid = &double.body.grid;
            let heights: Vec<f64> =
                (0..double.body.nodes.len()).map(|node| grid.node_position(node)[0]).collect();
            for (node, height) in heights.iter().enumerate() {
                let velocity = [-1e-9 * height * height];
                (double.body.nodes.solid_velocity[node], double.body.nodes.water_velocity[node]) =
                    (velocity, velocity);
            }
            double.sum_cell_pressures(0);
            let before = double.cell_sums.clone();
            let pressures = double.water.pressure.clone();
            double.update_pressure(1e-3);
            double.sum_cell_pressures(0);
            for cell in double.cells.of_point.clone() {
                let ([start, volume, ..], [end, ..]) = (before[cell], double.cell_sums[cell]);
                let (computed, rate) = ((end - start) / volume, double.site_values[cell]);
                assert!(rate > 0.0 && (computed / rate - 1.0).abs() < 1e-6, "{computed} for {rate}");
            }
            // −Δt (K_w/n) ∇·v has the slope 2e-9 Δt K_w/n over the height, at n = 0.3: in what a point carries, and
            // from one point to another.
            let slope = double.water.slope[2 * of_water][0];
            assert!((slope / 0.014_667 - 1.0).abs() < 0.01, "{slope}");
            let change = |point: usize| double.water.pressure[point] - pressures[point];
            let (low, high) = if of_water == 1 { (1, 2) } else { (6, 8) };
            let slope =
                (change(high) - change(low)) / (double.water.place[high][0] - double.water.place[low][0]);
            assert!((slope / 0.014_667 - 1.0).abs() < 0.01, "{slope}");
        }
    }
}
