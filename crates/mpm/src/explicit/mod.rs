//! The explicit integrator: the eight steps of Zheng et al., section 4 (docs/theory.md, section 3).
//!
//! A body's step reads as the paper's list: [`kick_and_drift`](Body::kick_and_drift). Drag is part of step 2.

mod apic;
mod nodes_to_points;
mod points_to_nodes;
pub mod scheme;
pub(crate) mod stress_slopes;
pub(crate) mod stresses;

pub use crate::drag::Drag;
pub(crate) use crate::explicit::nodes_to_points::Motion;
pub use crate::explicit::scheme::ExplicitSettings;

use crate::body::Body;
use crate::drag::{NodalBalance, NodalDrag};
use crate::method::Memory;

impl<const D: usize> Body<D> {
    /// One explicit step of `dt` seconds by forward Euler.
    pub fn explicit_step(&mut self, dt: f64, settings: &ExplicitSettings) {
        self.kick_and_drift(dt, dt, settings);
    }

    /// One explicit step whose velocities advance by `kick` seconds, and all that they carry by `dt`.
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        self.reset_grid(settings); // step 1
        self.nodal_accelerations(kick, settings.drag); // step 2
        self.nodal_velocities(kick, dt); // step 3
        self.advance_points(Motion { kick, dt, flip: settings.flip }); // step 4
        if settings.mapping_back {
            self.map_velocities(); // step 5
        }
        self.update_effective_stress(dt); // step 6
        self.update_pressure(dt); // step 7, and step 8 is the next one
        if self.method.memory == Memory::Cells && self.configuration.moves_points() {
            self.cell_averages.spread_over_points(&self.grid, &self.cells, &mut self.points);
        }
    }

    /// Step 1: shape functions, masses and velocities at the points' places. Where nothing moves all of it
    /// stands, but for velocities that the last step has not mapped back.
    fn reset_grid(&mut self, settings: &ExplicitSettings) {
        self.follow_places();
        if self.configuration.deforms() {
            self.map_masses_and_velocities();
        } else if !settings.mapping_back {
            self.map_velocities();
        }
    }

    /// Step 2: accelerations of water and skeleton at the nodes.
    fn nodal_accelerations(&mut self, kick: f64, drag: Drag) {
        self.map_forces();
        let water_density = self.material.water_density;
        self.accelerate_nodes(kick, drag, |volume, _| water_density * volume);
        if let Some(plate) = &self.plate {
            plate.tie_accelerations(&mut self.nodes);
        }
    }

    /// Accelerations of both phases from the forces on the nodes, with the water's inertia per volume of water
    /// at each, kg, from the volume of the mixture at a node and its number.
    pub(crate) fn accelerate_nodes(
        &mut self,
        kick: f64,
        level: Drag,
        water_inertia: impl Fn(f64, usize) -> f64,
    ) {
        let nodes = &mut self.nodes;
        for &node in &nodes.active {
            let inertia = water_inertia(nodes.volume[node], node);
            let share = nodes.water_mass[node] * nodes.per_solid_mass[node];
            let drag = NodalDrag::of(level, kick, nodes.drag[node], share, inertia);
            for d in 0..D {
                let (free, water_free) = (nodes.free[node][d], nodes.water_free[node][d]);
                let balance = NodalBalance {
                    per_solid_mass: free * nodes.per_solid_mass[node],
                    water_share: free * share,
                    per_water_inertia: water_free / drag.inertia(inertia, free * share),
                    drag,
                };
                let velocity = [nodes.solid_velocity[node][d], nodes.water_velocity[node][d]];
                let force = [nodes.mixture_force[node][d], nodes.water_force[node][d]];
                let [solid, water] = balance.accelerations(force[0], force[1], velocity);
                nodes.solid_acceleration[node][d] = solid;
                nodes.water_acceleration[node][d] = water;
            }
        }
    }

    /// Step 3: nodal velocities by forward Euler.
    pub(crate) fn nodal_velocities(&mut self, kick: f64, dt: f64) {
        let nodes = &mut self.nodes;
        for &node in &nodes.active {
            for d in 0..D {
                nodes.solid_velocity[node][d] += kick * nodes.solid_acceleration[node][d];
                nodes.water_velocity[node][d] += kick * nodes.water_acceleration[node][d];
                nodes.displacement[node][d] += dt * nodes.solid_velocity[node][d];
                // What slides along the base is the node's alone: the points have no part in it.
                nodes.water_acceleration[node][d] *= 1.0 - nodes.sliding[node][d];
            }
        }
        self.take_velocity_gradients();
    }

    /// Step 7: pressure increments at the sites of the method's divergence, recovered to the points:
    /// `Δp = −Δt (K_w/n) [∇·v_s + ∇·w]` (docs/theory.md, Eq. 8), with the flux that the nodes have.
    fn update_pressure(&mut self, dt: f64) {
        if self.forcing.is_some() {
            self.update_forced_pressure(dt);
            return;
        }
        self.nodes.take_flux();
        self.surface_flux += dt * self.outflow_of(&self.nodes.flux);
        self.add_pressure_increments(dt, |body, place, porosity| {
            body.volume_rate(porosity, |field| body.divergence_at(place, field))
        });
    }
}
