//! A body on which body forces and a source of water act at every point (docs/theory.md, Eq. 29).
//!
//! The source goes through the same sites as the divergence: at a cell's centre it is that of the point of the
//! skeleton which is there, and the recovery does the rest. Were it taken at the points while the divergence is at
//! the centres, the difference of both, times the stiffness of the water, would be left in the pressure.
//!
//! Second order in the step asks for all of it in the middle of the step: porosities, volumes, the configuration of
//! the divergence, and the time of the source.

use crate::kernel::body::Body;
use crate::kernel::stresses::to_middle;
use crate::kernel::volumetric::Place;
use oedometer_problem::method::PressureIntegration;
use oedometer_soil::tensor::{Tensor, Vector, identity, product};

impl<const D: usize> Body<D> {
    /// Begins a step of a body that something acts on, at a time, s.
    pub(crate) fn begin_forced_step(&mut self, time: f64) {
        if let Some(forced) = &mut self.actions.forcing {
            forced.begin_step(&self.points, time);
        }
    }

    /// Adds the body forces to those on the nodes, by the points' own volumes.
    pub(crate) fn add_body_forces(&mut self) {
        let Some(forced) = &self.actions.forcing else { return };
        let (points, nodes) = (&self.points, &mut self.nodes);
        let given = |point: usize| {
            let volume = points.volume(point);
            forced.forces()[point].map(|force| force.map(|component| volume * component))
        };
        self.operators.basis.sum_values(self.grid.node_stride(), given, &mut nodes.sums.forces);
        for &node in &nodes.active {
            let [mixture, water] = nodes.sums.forces[node];
            for d in 0..D {
                nodes.mixture_force[node][d] += mixture[d];
                nodes.water_force[node][d] += water[d];
            }
        }
    }

    /// Switches cells and nodes to the volumes in the middle of a step of points that have been strained, and back.
    fn enter_middle(&mut self) {
        let Some(forced) = &mut self.actions.forcing else { return };
        forced.find_middle(&self.points);
        forced.swap_middle(&mut self.points);
        self.cells.sum_volumes(&self.points, &self.soils);
        if self.is_pushed_forward {
            self.cells.average_deformation(&self.points);
        }
        self.map_masses();
    }

    /// Gives the points the deformation of the step's end again; cells and nodes follow in the next step.
    fn leave_middle(&mut self) {
        if let Some(forced) = &mut self.actions.forcing {
            forced.swap_middle(&mut self.points);
        }
    }

    /// Step 7 of a body with a source.
    pub(crate) fn update_forced_pressure(&mut self, dt: f64) {
        self.find_centres();
        self.take_sources(0.5 * dt);
        self.enter_middle();
        self.nodes.take_flux();
        self.add_pressure_increments(dt, |body, place, porosity| {
            let back = body.half_step_back(place, dt);
            body.volume_rate(porosity, |field| body.middle_divergence(place, &back, field))
                - body.source_at(place)
        });
        self.leave_middle();
    }

    /// Looks for the points of the skeleton at the cells' centres at the start of the step; where weights stay on the
    /// initial configuration they are the centres themselves.
    pub(crate) fn find_centres(&mut self) {
        let Some(forced) = &mut self.actions.forcing else { return };
        if self.configuration.moves_points() && self.method.pressure == PressureIntegration::Sri {
            forced.find_centres(&self.grid, self.cells.occupied());
        }
    }

    /// Evaluates the sources at the method's sites, so many seconds after the start of the step.
    fn take_sources(&mut self, later: f64) {
        let Some(forced) = &mut self.actions.forcing else { return };
        let time = forced.time + later;
        match self.method.pressure {
            PressureIntegration::Sri => forced.take_sources_at_centres(self.cells.occupied(), time),
            PressureIntegration::Points | PressureIntegration::Mean => {
                forced.take_sources_at_points(&self.points, time);
            }
        }
    }

    /// Evaluates the body forces and the sources so many seconds after the start of the step: for balances that are asked
    /// for there many times.
    pub(crate) fn act_later(&mut self, later: f64) {
        if let Some(forced) = &mut self.actions.forcing {
            let time = forced.time + later;
            forced.take_forces(&self.points, time);
        }
        self.take_sources(later);
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
            Place::Point(point) => self.operators.basis.gradient(self.grid.node_stride(), point, field),
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
mod tests;
