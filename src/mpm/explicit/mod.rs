//! The explicit integrator: the eight steps of Zheng et al., section 4 (docs/theory.md, section 3).
//!
//! A body's step reads as the paper's list: [`kick_and_drift`](Body::kick_and_drift). Drag is part of step 2.

pub mod affine;
pub mod deformation;
pub mod nodes_to_points;
pub mod points_to_nodes;
pub mod scheme;
pub mod stress_slopes;
pub mod stresses;

use crate::mpm::body::Body;
use crate::mpm::method::{Memory, PressureIntegration};
use crate::mpm::momentum::{NodalBalance, implicit_drag, per_water_inertia};
use crate::mpm::operators::recovery::points_in_cells::points_in_cells;
use crate::mpm::run::profile::{Phase, enter};

pub use crate::mpm::explicit::scheme::{Drag, ExplicitSettings};

impl<const D: usize> Body<D> {
    /// One explicit step of `dt` seconds, as the paper has it.
    pub fn explicit_step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        self.reset_grid(settings); // step 1
        enter(Phase::Forces);
        self.nodal_accelerations(kick, settings.drag); // step 2
        if let Some(plate) = &self.plate {
            plate.tie_accelerations(&mut self.nodes);
        }
        enter(Phase::Motion);
        self.nodal_velocities(kick, dt); // step 3
        self.take_slopes();
        if settings.mapping_back {
            self.advance_points_and_map_back(kick, dt, settings.flip); // steps 4 and 5
        } else {
            self.advance_points(kick, dt, settings.flip); // step 4
        }
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

    /// Accelerations of both phases from the forces on the nodes, with the water's inertia per volume of water
    /// at each, kg, from the volume of the mixture at a node and its number.
    #[inline]
    pub(crate) fn accelerate_nodes(
        &mut self,
        kick: f64,
        drag_level: Drag,
        water_inertia: impl Fn(f64, usize) -> f64,
    ) {
        let (count, nodes) = (self.nodes.len(), &mut self.nodes);
        let (volume, drags) = (&nodes.volume[..count], &nodes.drag[..count]);
        let (water_mass, per_solid_mass) = (&nodes.water_mass[..count], &nodes.per_solid_mass[..count]);
        let (free, water_free) = (&nodes.free[..count], &nodes.water_free[..count]);
        let (mixture, water) = (&nodes.mixture_force[..count], &nodes.water_force[..count]);
        let (solid_velocity, water_velocity) =
            (&nodes.solid_velocity[..count], &nodes.water_velocity[..count]);
        let solid_acceleration = &mut nodes.solid_acceleration[..count];
        let water_acceleration = &mut nodes.water_acceleration[..count];
        for run in &nodes.runs {
            for node in run.start..run.end.min(count) {
                let (water_inertia, drag) = (water_inertia(volume[node], node), drags[node]);
                let whole_share = water_mass[node] * per_solid_mass[node];
                let implicit_drag = implicit_drag(drag_level, kick, drag, whole_share, water_inertia);
                for d in 0..D {
                    let (free, water_free) = (free[node][d], water_free[node][d]);
                    let water_share = free * whole_share;
                    let balance = NodalBalance {
                        per_solid_mass: free * per_solid_mass[node],
                        water_share,
                        per_water_inertia: per_water_inertia(
                            water_inertia,
                            implicit_drag,
                            water_share,
                            water_free,
                        ),
                        drag,
                        implicit_drag,
                    };
                    let velocity = [solid_velocity[node][d], water_velocity[node][d]];
                    [solid_acceleration[node][d], water_acceleration[node][d]] =
                        balance.accelerations(mixture[node][d], water[node][d], velocity);
                }
            }
        }
    }

    /// Step 3: nodal velocities by forward Euler.
    pub(crate) fn nodal_velocities(&mut self, kick: f64, dt: f64) {
        let (count, nodes) = (self.nodes.len(), &mut self.nodes);
        let (solid_rate, water_rate) =
            (&nodes.solid_acceleration[..count], &nodes.water_acceleration[..count]);
        let (solid, water) = (&mut nodes.solid_velocity[..count], &mut nodes.water_velocity[..count]);
        let displacement = &mut nodes.displacement[..count];
        for run in &nodes.runs {
            for node in run.start..run.end.min(count) {
                for d in 0..D {
                    solid[node][d] += kick * solid_rate[node][d];
                    water[node][d] += kick * water_rate[node][d];
                    displacement[node][d] += dt * solid[node][d];
                }
            }
        }
    }

    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the points:
    /// `Δp = −Δt (K_w/n) [∇·v_s + ∇·w]` (docs/theory.md, Eq. 8).
    fn update_pressure(&mut self, dt: f64) {
        if self.forcing.is_some() {
            self.update_forced_pressure(dt);
            return;
        }
        self.nodal_flux();
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
