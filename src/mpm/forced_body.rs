//! A body on which body forces and a source of water act at every point (docs/theory.md, Eq. 29).
//!
//! The source goes through the same sites as the divergence: at a cell's centre it is that of the point of the
//! skeleton which is there, and the recovery does the rest. Were it taken at the points while the divergence is at
//! the centres, the difference of both, times the stiffness of the water, would be left in the pressure.
//!
//! Second order in the step asks for all of it in the middle of the step: porosities, volumes, the configuration of
//! the divergence, and the time of the source.

use crate::mpm::body::Body;
use crate::mpm::explicit::deformation::to_middle;
use crate::mpm::forcing::Forced;
use crate::mpm::operators::recovery::points_in_cells::points_in_cells;
use crate::mpm::operators::volumetric::Place;
use crate::soil::tensor::{Tensor, Vector, identity, product};

impl<const D: usize> Body<D> {
    /// Adds the body forces to those on the nodes, by the points' own places and volumes.
    pub(crate) fn add_body_forces(&mut self) {
        let Some(mut forced) = self.forcing.take() else { return };
        forced.begin_step(&self.points);
        let stride = *self.grid.node_stride();
        for point in 0..self.points.len() {
            let [mixture, water] =
                forced.acting.body_forces(&self.points.initial_position[point], forced.time);
            let volume = self.points.volume(point);
            let nodes = &mut self.nodes;
            self.basis.visit(&stride, point, |node, weight, _| {
                for d in 0..D {
                    nodes.mixture_force[node][d] += weight * (volume * mixture[d]);
                    nodes.water_force[node][d] += weight * (volume * water[d]);
                }
            });
        }
        self.forcing = Some(forced);
    }

    /// Brings cells and nodes to the volumes of the middle of a step of points that have been strained, and back.
    fn enter_middle(&mut self, forced: &mut Forced<D>) {
        forced.find_middle(&self.points);
        forced.swap_middle(&mut self.points);
        self.cells.sum_volumes(&self.points, self.material.porosity);
        if self.is_pushed_forward {
            self.cells.average_deformation(&self.points);
        }
        self.map_masses();
    }

    /// Gives the points the deformation of the step's end again; cells and nodes follow in the next step.
    fn leave_middle(&mut self, forced: &mut Forced<D>) {
        forced.swap_middle(&mut self.points);
    }

    /// Step 7 of a body with a source.
    pub(crate) fn update_forced_pressure(&mut self, dt: f64) {
        let Some(mut forced) = self.forcing.take() else { return };
        self.find_centres(&mut forced);
        self.enter_middle(&mut forced);
        self.nodal_flux();
        let time = forced.time + 0.5 * dt;
        self.evaluate_sites(|body, place, porosity| {
            let back = body.half_step_back(place, dt);
            let gained = body.volume_rate(porosity, |field| body.middle_divergence(place, &back, field));
            let added = forced.acting.source(body.material_place(&forced, place), time);
            dt * body.material.water_bulk_modulus / porosity * (added - gained)
        });
        let at = points_in_cells!(self);
        let pressures = &mut self.points.pressure;
        self.recovery
            .recover(&at, &self.site_values, pressures, |pressure, increment| *pressure += increment);
        self.leave_middle(&mut forced);
        self.forcing = Some(forced);
    }

    /// Looks for the points of the skeleton at the cells' centres at the start of the step; on the initial
    /// configuration they are the centres themselves.
    fn find_centres(&self, forced: &mut Forced<D>) {
        if self.is_pushed_forward || !self.method.pressure.is_by_cells() {
            return;
        }
        for cell in self.cells.occupied() {
            let centre = self.grid.cell_centre(cell);
            let found = forced.acting.material_place(&centre, forced.time, &forced.at_centre[cell]);
            forced.at_centre[cell] = found;
        }
    }

    /// The point of the skeleton at a place.
    fn material_place<'a>(&'a self, forced: &'a Forced<D>, place: Place) -> &'a Vector<D> {
        match place {
            Place::Centre(cell) => &forced.at_centre[cell],
            Place::Point(point) => &self.points.initial_position[point],
        }
    }

    /// `(I + Δt L/2)⁻¹` at a place: from the middle of a step back to its start, where its weights are from. Unity
    /// where gradients are pushed forward anyway.
    fn half_step_back(&self, place: Place, dt: f64) -> Tensor<D> {
        if self.is_pushed_forward {
            return identity();
        }
        to_middle(&self.start_gradient(place, &self.nodes.solid_velocity), dt)
    }

    /// Gradient of a nodal field at a place, on the configuration of the weights.
    fn start_gradient(&self, place: Place, field: &[Vector<D>]) -> Tensor<D> {
        match place {
            Place::Centre(cell) => self.cells.centre_gradient(&self.grid, cell, field),
            Place::Point(point) => self.basis.gradient(self.grid.node_stride(), point, field),
        }
    }

    /// Divergence of a nodal field at a place in the middle of a step.
    fn middle_divergence(&self, place: Place, back: &Tensor<D>, field: &[Vector<D>]) -> f64 {
        if self.is_pushed_forward {
            return self.divergence_at(place, field);
        }
        let gradient = product(&self.start_gradient(place, field), back);
        (0..D).map(|d| gradient[d][d]).sum()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mpm_forced.rs"]
mod tests;
