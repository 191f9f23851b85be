//! The explicit integrator: the eight steps of Zheng et al., section 4 (docs/theory.md, section 3).
//!
//! A body's step reads as the paper's list: [`kick_and_drift`](Body::kick_and_drift). Drag is part of step 2.

pub mod affine;
pub mod deformation;
pub mod nodal_step;
pub mod nodes_to_points;
pub mod points_to_nodes;
pub mod scheme;
pub mod stress_slopes;
pub mod stresses;

use crate::body::Body;
use crate::method::{Memory, PressureIntegration};
use crate::operators::recovery::points_in_cells::points_in_cells;
use crate::run::profile::{Phase, enter};

pub use crate::explicit::scheme::{Drag, ExplicitSettings};

impl<const D: usize> Body<D> {
    /// One explicit step of `dt` seconds, as the paper has it.
    pub fn explicit_step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        let is_plain = self.leaves_nodes_alone();
        if is_plain {
            self.kick_nodes_at_once(kick, dt, settings.drag); // steps 1 to 3
        } else {
            self.reset_grid(settings); // step 1
            enter(Phase::Forces);
            self.nodal_accelerations(kick, settings.drag); // step 2
            if let Some(plate) = &self.plate {
                plate.tie_accelerations(&mut self.nodes);
            }
            enter(Phase::Motion);
            self.nodal_velocities(kick, dt); // step 3
            self.take_slopes();
            self.nodes.gather_motion();
        }
        if settings.mapping_back {
            self.advance_points_and_map_back(kick, dt, settings.flip); // steps 4 and 5
        } else {
            self.advance_points(kick, dt, settings.flip); // step 4
        }
        self.take_mapped_velocities(settings.mapping_back, is_plain);
        enter(Phase::Stresses);
        self.update_effective_stress(dt); // step 6
        enter(Phase::Recovery);
        self.update_pressure(dt); // step 7, and step 8 is the next one
        if self.method.memory == Memory::Cells && self.configuration.moves_points() {
            self.cell_memory.spread_over_points(&self.grid, &self.cells, &mut self.points);
        }
    }

    /// Step 1: operators, masses and velocities on the points' places. Where nothing moves, the
    /// operators stand, and velocities mapped back by the last step are already there; where something does, one pass
    /// takes the forces of step 2 along.
    fn reset_grid(&mut self, settings: &ExplicitSettings) {
        enter(Phase::BuildWeights);
        self.follow_places();
        if self.configuration.deforms() {
            enter(Phase::MapVelocities);
            self.map_masses_velocities_and_forces();
        } else if !settings.mapping_back {
            enter(Phase::MapVelocities);
            self.map_velocities();
        }
    }

    /// Step 2: accelerations of water and skeleton at the nodes.
    fn nodal_accelerations(&mut self, kick: f64, drag_level: Drag) {
        if !self.configuration.deforms() {
            self.map_forces();
        }
        let water_density = self.material.water_density;
        self.accelerate_nodes(kick, drag_level, |volume, _| water_density * volume);
    }

    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the points:
    /// `Δp = −Δt (K_w/n) [∇·v_s + ∇·w]` (docs/theory.md, Eq. 8), with the flux that the nodes have.
    fn update_pressure(&mut self, dt: f64) {
        if self.forcing.is_some() {
            self.update_forced_pressure(dt);
            return;
        }
        self.surface_flux += dt * self.outflow_of(&self.nodes.flux);
        self.evaluate_sites(|body, place, porosity| {
            let rate = body.volume_rate(porosity, |field| body.divergence_at(place, field));
            let bulk_modulus = body.material.water_bulk_modulus;
            // The same product in two orders of rounding: those of the accepted values.
            match body.method.pressure {
                PressureIntegration::Points => dt * (-bulk_modulus / porosity * rate),
                PressureIntegration::Sri | PressureIntegration::Mean => -dt * bulk_modulus / porosity * rate,
            }
        });
        let at = points_in_cells!(self);
        let pressures = &mut self.points.pressure;
        self.recovery
            .recover(&at, &self.site_values, pressures, |pressure, increment| *pressure += increment);
    }
}
