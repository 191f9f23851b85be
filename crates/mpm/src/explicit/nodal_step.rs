//! What the nodes do in an explicit step: from what the points gave them to their velocities.
//!
//! A node needs no other one. Where nothing acts on them all between the steps, each goes from its sums to its new
//! velocity at once, a few neighbours side by side.

use crate::body::Body;
use crate::explicit::scheme::Drag;
use crate::momentum::{NodalBalance, implicit_drag, per_water_inertia};
use crate::run::profile::{Phase, enter};
use crate::state::lanes::{some_mut, some_of};
use crate::state::nodes::{Nodes, each_of_runs};
use oedometer_soil::conductivity_mean::ConductivityMean;
use oedometer_soil::tensor::Vector;

impl<const D: usize> Body<D> {
    /// Whether each node takes all of a step from its own sums: no plate ties them, nothing but the points gives to them,
    /// and their drag is that of the points.
    pub(crate) fn leaves_nodes_alone(&self) -> bool {
        self.configuration.deforms()
            && self.plate.is_none()
            && self.slopes.is_none()
            && self.stress_planes.is_none()
            && self.weight.is_none()
            && self.forcing.is_none()
            && self.material.conductivity_mean == ConductivityMean::Points
    }

    /// Steps 1 to 3 of a body that leaves its nodes alone.
    pub(crate) fn kick_nodes_at_once(&mut self, kick: f64, dt: f64, drag_level: Drag) {
        enter(Phase::BuildWeights);
        self.follow_places();
        enter(Phase::MapVelocities);
        self.sum_masses_velocities_and_forces();
        enter(Phase::Forces);
        let (nodes, soil) = (&mut self.nodes, &self.material);
        let water_inertia = |volume: f64, _: usize| soil.water_density * volume;
        nodes.take_grains(soil.grain_density);
        each_of_runs!(nodes, |first, N| {
            nodes.masses_of::<N>(first, soil);
            nodes.velocities_of::<N>(first, soil);
            nodes.forces_of::<N>(first);
            nodes.accelerations_of::<N>(first, kick, drag_level, &water_inertia);
            nodes.advance_of::<N>(first, kick, dt);
            nodes.motion_of::<N>(first);
        });
        enter(Phase::Motion);
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
        let nodes = &mut self.nodes;
        each_of_runs!(nodes, |first, N| nodes.accelerations_of::<N>(first, kick, drag_level, &water_inertia));
    }

    /// Step 3: nodal velocities by forward Euler.
    pub(crate) fn nodal_velocities(&mut self, kick: f64, dt: f64) {
        let nodes = &mut self.nodes;
        each_of_runs!(nodes, |first, N| nodes.advance_of::<N>(first, kick, dt));
    }

    /// Velocities that the points have mapped back, where they have, and the flux that drives the pressure.
    pub(crate) fn take_mapped_velocities(&mut self, are_mapped_back: bool, is_plain: bool) {
        if are_mapped_back {
            enter(Phase::MapVelocities);
        }
        if are_mapped_back && is_plain {
            let (nodes, soil) = (&mut self.nodes, &self.material);
            each_of_runs!(nodes, |first, N| {
                nodes.velocities_of::<N>(first, soil);
                nodes.flux_of::<N>(first);
            });
            return;
        }
        if are_mapped_back {
            self.take_velocities();
        }
        if self.forcing.is_none() {
            self.nodal_flux();
        }
    }
}

impl<const D: usize> Nodes<D> {
    /// Accelerations of some nodes.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn accelerations_of<const N: usize>(
        &mut self,
        first: usize,
        kick: f64,
        drag_level: Drag,
        water_inertia: &impl Fn(f64, usize) -> f64,
    ) {
        let volume = some_of::<_, N>(&self.volume, first);
        let drag = some_of::<_, N>(&self.drag, first);
        let per_solid = some_of::<_, N>(&self.per_solid_mass, first);
        let water_mass = some_of::<_, N>(&self.water_mass, first);
        let [mut inertia, mut share, mut implicit_drags] = [[0.0; N]; 3];
        for node in 0..N {
            inertia[node] = water_inertia(volume[node], first + node);
        }
        for node in 0..N {
            share[node] = water_mass[node] * per_solid[node];
        }
        if drag_level != Drag::Explicit {
            for node in 0..N {
                implicit_drags[node] =
                    implicit_drag(drag_level, kick, drag[node], share[node], inertia[node]);
            }
        }
        let (free, water_free) =
            (some_of::<_, N>(&self.free, first), some_of::<_, N>(&self.water_free, first));
        let (mixture, water) =
            (some_of::<_, N>(&self.mixture_force, first), some_of::<_, N>(&self.water_force, first));
        let (solid_velocity, water_velocity) =
            (some_of::<_, N>(&self.solid_velocity, first), some_of::<_, N>(&self.water_velocity, first));
        let [mut solid_rate, mut water_rate] = [[[0.0; D]; N]; 2];
        for node in 0..N {
            for d in 0..D {
                let (free, water_free) = (free[node][d], water_free[node][d]);
                let water_share = free * share[node];
                let balance = NodalBalance {
                    per_solid_mass: free * per_solid[node],
                    water_share,
                    per_water_inertia: per_water_inertia(
                        inertia[node],
                        implicit_drags[node],
                        water_share,
                        water_free,
                    ),
                    drag: drag[node],
                    implicit_drag: implicit_drags[node],
                };
                let velocity = [solid_velocity[node][d], water_velocity[node][d]];
                [solid_rate[node][d], water_rate[node][d]] =
                    balance.accelerations(mixture[node][d], water[node][d], velocity);
            }
        }
        *some_mut(&mut self.solid_acceleration, first) = solid_rate;
        *some_mut(&mut self.water_acceleration, first) = water_rate;
    }

    /// Velocities and displacements of some nodes, and what accelerations the points are given.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn advance_of<const N: usize>(&mut self, first: usize, kick: f64, dt: f64) {
        let mut solid: [Vector<D>; N] = *some_of(&self.solid_velocity, first);
        let mut water: [Vector<D>; N] = *some_of(&self.water_velocity, first);
        let mut displacement: [Vector<D>; N] = *some_of(&self.displacement, first);
        let solid_rate = some_of::<_, N>(&self.solid_acceleration, first);
        let water_rate = some_of::<_, N>(&self.water_acceleration, first);
        for node in 0..N {
            for d in 0..D {
                solid[node][d] += kick * solid_rate[node][d];
            }
        }
        for node in 0..N {
            for d in 0..D {
                water[node][d] += kick * water_rate[node][d];
            }
        }
        for node in 0..N {
            for d in 0..D {
                displacement[node][d] += dt * solid[node][d];
            }
        }
        *some_mut(&mut self.solid_velocity, first) = solid;
        *some_mut(&mut self.water_velocity, first) = water;
        *some_mut(&mut self.displacement, first) = displacement;
        if D > 1 {
            // What slides along the base is the node's alone: the points have no part in it.
            let sliding = some_of::<_, N>(&self.sliding, first);
            let mut given: [Vector<D>; N] = *water_rate;
            for node in 0..N {
                for d in 0..D {
                    given[node][d] *= 1.0 - sliding[node][d];
                }
            }
            *some_mut(&mut self.water_acceleration, first) = given;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explicit::ExplicitSettings;
    use crate::method::{Configuration, Method};
    use crate::operators::rigid_plate::RigidPlate;
    use crate::scene::SceneKind;
    use crate::scene::column::Column;
    use crate::scene::problem::column_problem;
    use oedometer_soil::material::Material;

    /// Two bodies that take the same steps, one with its nodes at once, one after the paper's list.
    fn both<const D: usize>(settings: &ExplicitSettings) -> [Body<D>; 2] {
        let method = Method::named("GC-SRI-patch").expect("a known method");
        let method = Method { configuration: Some(Configuration::Updated), ..method };
        let (column, soil) = (Column { dimensions: D, ..Column::default() }, Material::default());
        let problem =
            column_problem::<D>(SceneKind::Terzaghi, &column, &soil, method, 5, 2).expect("a column");
        let mut at_once = Body::new(problem);
        let mut in_turn = at_once.clone();
        assert!(at_once.leaves_nodes_alone());
        let dt = 1e-5;
        for _ in 0..6 {
            at_once.kick_and_drift(0.9 * dt, dt, settings);
            in_turn.reset_grid(settings);
            in_turn.nodal_accelerations(0.9 * dt, settings.drag);
            in_turn.nodal_velocities(0.9 * dt, dt);
            in_turn.nodes.gather_motion();
            if settings.mapping_back {
                in_turn.advance_points_and_map_back(0.9 * dt, dt, settings.flip);
            } else {
                in_turn.advance_points(0.9 * dt, dt, settings.flip);
            }
            in_turn.take_mapped_velocities(settings.mapping_back, false);
            in_turn.update_effective_stress(dt);
            in_turn.update_pressure(dt);
        }
        [at_once, in_turn]
    }

    #[test]
    fn nodes_that_are_left_alone_take_the_same_step_at_once() {
        for drag in [Drag::Explicit, Drag::Implicit, Drag::Centred] {
            for (mapping_back, flip) in [(true, 1.0), (true, 0.8), (false, 1.0)] {
                let settings = ExplicitSettings { drag, flip, mapping_back, ..ExplicitSettings::default() };
                let [at_once, in_turn] = both::<1>(&settings);
                assert_eq!((&at_once.points, &at_once.nodes), (&in_turn.points, &in_turn.nodes));
                assert!(at_once.points.pressure.iter().any(|pressure| (pressure - 1.0).abs() > 1e-3));
                let [at_once, in_turn] = both::<2>(&settings);
                assert_eq!((&at_once.points, &at_once.nodes), (&in_turn.points, &in_turn.nodes));
            }
        }
    }

    #[test]
    fn nodes_that_something_ties_or_gives_to_are_not_left_alone() {
        let alone = || both::<2>(&ExplicitSettings::default())[0].clone();
        assert!(alone().leaves_nodes_alone());
        let mut tied = alone();
        let volumes = tied.points.initial_volume.iter().copied();
        tied.plate = Some(RigidPlate::of(1.0, &tied.grid, &tied.nodes, volumes));
        assert!(!tied.leaves_nodes_alone());
        let mut sloped = alone();
        sloped.bring_slopes();
        assert!(!sloped.leaves_nodes_alone());
        let mut sloped = alone();
        sloped.slope_stresses();
        assert!(!sloped.leaves_nodes_alone());
        let mut frozen = alone();
        frozen.configuration = Configuration::Frozen;
        assert!(!frozen.leaves_nodes_alone());
    }
}
