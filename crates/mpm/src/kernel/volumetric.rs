//! The volumetric operators of a method: `D` from nodes to the sites of the dilation, `R` from the sites to the
//! points, in place and as sparse rows.
//!
//! The explicit step works in place; what is assembled (the frozen step, the undrained start, implicit
//! integrators) takes the rows.

use crate::kernel::body::Body;
use crate::kernel::projection::SiteRows;
use crate::operators::recovery::points_in_cells::points_in_cells;
use oedometer_problem::method::PressureIntegration;
use oedometer_soil::tensor::Vector;

/// A linear functional of a nodal vector field: one vector of coefficients a node.
pub type VectorRow<const D: usize> = Vec<(usize, Vector<D>)>;

/// `D` and `R` of a method on a body's present operators.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VolumetricRows<const D: usize> {
    /// Cell or point of each site.
    pub sites: Vec<usize>,
    /// Site of each cell or point, where it is one.
    pub site_of_place: Vec<Option<usize>>,
    /// Divergence at each site, 1/m of the field: occupied cells, or points.
    pub divergence: Vec<VectorRow<D>>,
    /// Coupling modulus `K_w/n` of each site, Pa.
    pub coupling: Vec<f64>,
    /// Sites that each point recovers its value from, with their weights.
    pub recovery: Vec<Vec<(usize, f64)>>,
    /// Storage that a projection adds to each site, over its parameter; empty without one.
    pub projection: SiteRows,
}

/// A place where a divergence is taken.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// Centre of a cell.
    Centre(usize),
    /// A point.
    Point(usize),
}

impl<const D: usize> Body<D> {
    /// Divergence of a nodal field at a place, on the present configuration.
    #[inline]
    pub fn divergence_at(&self, place: Place, field: &[Vector<D>]) -> f64 {
        match place {
            Place::Centre(cell) => self.divergence_at_centre(cell, field),
            Place::Point(point) => self.divergence_at_point(point, field),
        }
    }

    /// Cell of a point, and the point's share of its volume.
    #[inline]
    fn share_of_cell(&self, point: usize) -> (usize, f64) {
        let cell = self.cells.of_point[point];
        (cell, self.points.volume(point) / self.cells.volume(cell))
    }

    /// Porosity of a cell, point or node that is a site.
    pub fn porosity_of(&self, place: usize) -> f64 {
        if self.method.has_projection() {
            self.nodes.porosity[place]
        } else if self.method.pressure.is_by_cells() {
            self.cells.porosity[place]
        } else {
            self.soil_of(place).porosity_at(self.points.volume_ratio[place])
        }
    }

    /// Storage of the water `n/K_w`, 1/Pa, of a cell, point or node that is a site, with its porosity: the mean of the soils
    /// in it or around it.
    #[inline]
    pub fn storage_of(&self, place: usize, porosity: f64) -> f64 {
        if !self.is_layered() {
            porosity / self.material.water_bulk_modulus
        } else if self.method.has_projection() {
            self.nodes.storage(place)
        } else if self.method.pressure.is_by_cells() {
            self.cells.storage[place]
        } else {
            porosity / self.soil_of(place).water_bulk_modulus
        }
    }

    /// Coupling modulus `Q = K_w/n`, Pa, of a site: one over its storage.
    #[inline]
    pub(crate) fn coupling_of(&self, place: usize, porosity: f64) -> f64 {
        if self.is_layered() {
            1.0 / self.storage_of(place, porosity)
        } else {
            self.material.water_bulk_modulus / porosity
        }
    }

    /// `D` in place: fills `site_values` with what a function gives at each site from a place and the porosity
    /// there. Sites are points, cells at their centres, cells as means over their points, weighted with volume, or
    /// nodes as means over the points around them.
    #[inline]
    pub fn evaluate_sites(&mut self, value: impl Fn(&Self, Place, f64) -> f64) {
        let mut sites = std::mem::take(&mut self.site_values);
        match self.method.pressure {
            PressureIntegration::Points if self.method.has_projection() => {
                sites.fill(0.0);
                for point in 0..self.points.len() {
                    let porosity = self.soil_of(point).porosity_at(self.points.volume_ratio[point]);
                    let given = self.points.volume(point) * value(self, Place::Point(point), porosity);
                    self.operators.basis.visit(self.grid.node_stride(), point, |node, share, _| {
                        sites[node] += share * given;
                    });
                }
                for (node, site) in sites.iter_mut().enumerate() {
                    *site = if self.nodes.is_active(node) { *site / self.nodes.volume[node] } else { 0.0 };
                }
            }
            PressureIntegration::Points => {
                for (point, site) in sites.iter_mut().enumerate() {
                    let porosity = self.soil_of(point).porosity_at(self.points.volume_ratio[point]);
                    *site = value(self, Place::Point(point), porosity);
                }
            }
            PressureIntegration::Sri => {
                sites.fill(0.0);
                for cell in self.cells.occupied() {
                    sites[cell] = value(self, Place::Centre(cell), self.cells.porosity[cell]);
                }
            }
            PressureIntegration::Mean => {
                sites.fill(0.0);
                for point in 0..self.points.len() {
                    let (cell, share) = self.share_of_cell(point);
                    sites[cell] += share * value(self, Place::Point(point), self.cells.porosity[cell]);
                }
            }
        }
        self.site_values = sites;
    }

    /// Step 7: pressure increments from the rates of the mixture's volume at the sites, each times the coupling modulus of
    /// its site (docs/theory.md, Eqs 8 and 41), projected where the method does and recovered to the points.
    #[inline]
    pub(crate) fn add_pressure_increments(&mut self, dt: f64, rate: impl Fn(&Self, Place, f64) -> f64) {
        self.evaluate_sites(rate);
        let mut sites = std::mem::take(&mut self.site_values);
        let coupling = |site: usize| -dt * self.coupling_of(site, self.porosity_of(site));
        match self.method.pressure {
            PressureIntegration::Points if self.method.has_projection() => {
                self.nodes.active.iter().for_each(|node| sites[*node] *= coupling(*node));
            }
            PressureIntegration::Points => {
                sites.iter_mut().enumerate().for_each(|(point, site)| *site *= coupling(point));
            }
            PressureIntegration::Sri | PressureIntegration::Mean => {
                self.cells.occupied().for_each(|cell| sites[cell] *= coupling(cell));
            }
        }
        self.site_values = sites;
        self.project_site_values();
        let at = points_in_cells!(self, self.operators.basis);
        let pressures = &mut self.points.pressure;
        self.operators
            .recovery
            .recover(&at, &self.site_values, pressures, |pressure, increment| *pressure += increment);
    }

    /// Rate of the mixture's volume at each site beyond that of a source, 1/s.
    pub fn evaluate_volume_rates(&mut self) {
        self.evaluate_sites(|body, place, porosity| {
            let rate = body.volume_rate(porosity, |field| body.divergence_at(place, field));
            rate - body.source_at(place)
        });
    }

    /// Source of water at a place, 1/s; nothing where none acts.
    #[inline]
    pub(crate) fn source_at(&self, place: Place) -> f64 {
        let Some(forced) = &self.actions.forcing else { return 0.0 };
        match place {
            Place::Centre(cell) => forced.source_at_centre(cell),
            Place::Point(point) => forced.source_at_point(point),
        }
    }

    /// The skeleton's volumetric rate at the points by the method's own `D` and `R`, 1/s: the trace that B-bar
    /// takes.
    pub fn recover_dilation_rates(&mut self) {
        self.evaluate_sites(|body, place, _| body.divergence_at(place, &body.nodes.solid_velocity));
        let at = points_in_cells!(self, self.operators.basis);
        self.operators.recovery.recover(
            &at,
            &self.site_values,
            &mut self.dilation_rates,
            |rate, recovered| *rate = recovered,
        );
    }

    /// `D` and `R` of the body's method as rows; gradients are those of small strain.
    pub fn volumetric_rows(&self) -> VolumetricRows<D> {
        let sites: Vec<usize> = match self.method.pressure {
            PressureIntegration::Points if self.method.has_projection() => self.nodes.active.clone(),
            PressureIntegration::Points => (0..self.points.len()).collect(),
            PressureIntegration::Sri | PressureIntegration::Mean => self.cells.occupied().collect(),
        };
        let mut site_of_place = vec![None; self.site_values.len()];
        for (site, place) in sites.iter().enumerate() {
            site_of_place[*place] = Some(site);
        }
        let at = points_in_cells!(self, self.operators.basis);
        let numbered = |row: Vec<(usize, f64)>| {
            let entries = row.into_iter().filter(|(_, weight)| *weight != 0.0);
            entries.filter_map(|(place, weight)| Some((site_of_place[place]?, weight))).collect()
        };
        VolumetricRows {
            divergence: self.divergence_rows(&sites, &site_of_place),
            coupling: sites.iter().map(|place| self.coupling_of(*place, self.porosity_of(*place))).collect(),
            recovery: self.operators.recovery.rows(&at).into_iter().map(numbered).collect(),
            projection: self.projection_rows(&sites, &site_of_place),
            sites,
            site_of_place,
        }
    }

    fn divergence_rows(&self, sites: &[usize], site_of_place: &[Option<usize>]) -> Vec<VectorRow<D>> {
        let at_point = |point: usize| self.operators.basis.gradient_row(&self.grid, point);
        match self.method.pressure {
            PressureIntegration::Points if self.method.has_projection() => {
                let mut rows = vec![VectorRow::new(); sites.len()];
                for point in 0..self.points.len() {
                    for (site, value) in self.sites_around(point, site_of_place) {
                        let share = value * self.points.volume(point) / self.nodes.volume[sites[site]];
                        for (node, gradient) in at_point(point) {
                            accumulate(&mut rows[site], node, &gradient.map(|component| share * component));
                        }
                    }
                }
                rows
            }
            PressureIntegration::Points => sites.iter().map(|point| at_point(*point)).collect(),
            PressureIntegration::Sri => {
                sites.iter().map(|cell| self.cells.centre_divergence_row(&self.grid, *cell)).collect()
            }
            PressureIntegration::Mean => {
                let mut rows = vec![VectorRow::new(); sites.len()];
                for point in 0..self.points.len() {
                    let (cell, share) = self.share_of_cell(point);
                    let Some(site) = site_of_place[cell] else { continue };
                    for (node, gradient) in at_point(point) {
                        accumulate(&mut rows[site], node, &gradient.map(|component| share * component));
                    }
                }
                rows
            }
        }
    }
}

/// Adds to a node's coefficients in a short row.
fn accumulate<const D: usize>(row: &mut VectorRow<D>, node: usize, coefficients: &Vector<D>) {
    let place = row.iter().position(|entry| entry.0 == node).unwrap_or_else(|| {
        row.push((node, [0.0; D]));
        row.len() - 1
    });
    for d in 0..D {
        row[place].1[d] += coefficients[d];
    }
}

impl<const D: usize> VolumetricRows<D> {
    /// Divergence of a nodal field at every site.
    pub fn at_sites(&self, field: &[Vector<D>]) -> Vec<f64> {
        self.divergence.iter().map(|row| applied(row, field)).collect()
    }

    /// Values at the points from those at the sites.
    pub fn at_points(&self, sites: &[f64]) -> Vec<f64> {
        let value = |row: &Vec<(usize, f64)>| row.iter().map(|(site, weight)| weight * sites[*site]).sum();
        self.recovery.iter().map(value).collect()
    }

    /// The volumetric rate at a point as a functional of the field: `R D` without moduli.
    pub fn dilation_row(&self, point: usize) -> VectorRow<D> {
        let mut row = VectorRow::new();
        for (site, weight) in &self.recovery[point] {
            for (node, coefficients) in &self.divergence[*site] {
                accumulate(&mut row, *node, &coefficients.map(|component| weight * component));
            }
        }
        row
    }
}

/// A functional applied to a field.
#[inline]
pub fn applied<const D: usize>(row: &VectorRow<D>, field: &[Vector<D>]) -> f64 {
    let mut sum = 0.0;
    for (node, coefficients) in row {
        for d in 0..D {
            sum += coefficients[d] * field[*node][d];
        }
    }
    sum
}
