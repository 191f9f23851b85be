//! The pressure of the water points: continuity along the water (docs/theory.md, Eq. 23).
//!
//! ```text
//! (n/K_w) D_w p/Dt = −∇·[v_s + n (v_w − v_s)]
//! ```
//!
//! the divergence by the method's `D`, at the water points or in the cells that hold soil, and the way back to the
//! water points by its `R`.

use crate::layers::two_layers::TwoLayers;
use crate::method::PressureIntegration;
use crate::operators::recovery::points_in_cells::PointsInCells;
use crate::operators::volumetric::Place;
use oedometer_soil::tensor::Vector;

impl<const D: usize> TwoLayers<D> {
    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the water points.
    pub fn update_pressure(&mut self, dt: f64) {
        let body = &mut self.body;
        body.nodal_flux();
        body.surface_flux += dt * body.surface.mean_of(&body.grid, &body.points, &body.nodes.flux);
        let bulk_modulus = body.material.water_bulk_modulus;
        self.evaluate_water_sites(|layers, place, porosity| {
            let rate = layers.body.volume_rate(porosity, |field| layers.divergence_at(place, field));
            -dt * bulk_modulus / porosity * rate
        });
        self.recover_pressure();
        if self.keeps_cell_rates {
            self.fade_beyond_lines(dt);
        }
    }

    /// Compresses the water by a displacement of skeleton and water together, m, `[node][component]`.
    pub(crate) fn compress_by(&mut self, displacement: &[Vector<D>]) {
        let bulk_modulus = self.body.material.water_bulk_modulus;
        self.evaluate_water_sites(|layers, place, porosity| {
            -bulk_modulus / porosity * layers.divergence_at(place, displacement)
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
}
