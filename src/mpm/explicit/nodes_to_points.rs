//! From nodes to points: what carries them, and what they give back to the nodes at once.
//!
//! A point's new velocities need no other point: its momenta go back to the nodes in the same pass, while its weights
//! are in registers.

use crate::mpm::body::Body;
use crate::mpm::explicit::points_to_nodes::{add_momenta, momenta_of, volumes_of};
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::state::nodes::Nodes;
use crate::soil::tensor::Vector;

/// Durations and shares of a step, for the points.
#[derive(Clone, Copy)]
struct Motion {
    /// How long velocities and places advance, s.
    kick: f64,
    dt: f64,
    /// Share of the acceleration update in the velocities.
    flip: f64,
}

impl<const D: usize> Body<D> {
    /// Step 4: velocities and places of the points.
    pub(crate) fn advance_points(&mut self, kick: f64, dt: f64, flip: f64) {
        self.carry_points::<false>(Motion { kick, dt, flip });
    }

    /// Steps 4 and 5: velocities and places of the points, and their velocities back at the nodes.
    pub(crate) fn advance_points_and_map_back(&mut self, kick: f64, dt: f64, flip: f64) {
        self.carry_points::<true>(Motion { kick, dt, flip });
        enter(Phase::MapVelocities);
        self.take_velocities();
    }

    fn carry_points<const BACK: bool>(&mut self, motion: Motion) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => if motion.flip < 1.0 {
            self.carry_points_by::<true, BACK, _>(stencils.blocks(), motion);
        } else {
            self.carry_points_by::<false, BACK, _>(stencils.blocks(), motion);
        });
        self.basis = basis;
    }

    /// The same; where nothing is interpolated from the nodes, the water's velocities are not asked for.
    fn carry_points_by<const PIC: bool, const BACK: bool, const W: usize>(
        &mut self,
        basis: Blocks<'_, D, W>,
        Motion { kick, dt, flip }: Motion,
    ) {
        let moving = self.configuration.moves_points();
        let (pic, solid_fraction) = (1.0 - flip, 1.0 - self.material.porosity);
        let carrier = self.strain.carrier();
        let stride = *self.grid.node_stride();
        let Nodes { solid_velocity, solid_acceleration, water_velocity, water_acceleration, sums, .. } =
            &mut self.nodes;
        let (solid_field, solid_rates) = (&solid_velocity[..], &solid_acceleration[..]);
        let (water_field, water_rates) = (&water_velocity[..], &water_acceleration[..]);
        let momenta = &mut sums.momenta[..];
        if BACK {
            momenta.fill([[0.0; D]; 2]);
        }
        let points = &mut self.points;
        let count = points.len();
        let (solid_velocity, water_velocity) =
            (&mut points.solid_velocity[..count], &mut points.water_velocity[..count]);
        let (displacement, position) = (&mut points.displacement[..count], &mut points.position[..count]);
        let (initial_volume, volume_ratio) = (&points.initial_volume[..count], &points.volume_ratio[..count]);
        for point in 0..count {
            let ([mut solid, mut solid_rate], [mut water, mut water_rate]) = ([[0.0; D]; 2], [[0.0; D]; 2]);
            basis.visit_runs(&stride, point, |first, weights, _| {
                let run = first..first + W;
                add_weighted(&mut solid, &solid_field[run.clone()], weights);
                add_weighted(&mut solid_rate, &solid_rates[run.clone()], weights);
                add_weighted(&mut water_rate, &water_rates[run.clone()], weights);
                if PIC {
                    add_weighted(&mut water, &water_field[run], weights);
                }
            });
            let carrying = carrier.map_or(solid, |ends| ends.value(&stride, point, solid_field));
            let (solid_velocity, water_velocity) = (&mut solid_velocity[point], &mut water_velocity[point]);
            for d in 0..D {
                solid_velocity[d] += kick * solid_rate[d];
                water_velocity[d] += kick * water_rate[d];
                if PIC {
                    solid_velocity[d] = flip * solid_velocity[d] + pic * solid[d];
                    water_velocity[d] = flip * water_velocity[d] + pic * water[d];
                }
                displacement[point][d] += dt * carrying[d];
                if moving {
                    position[point][d] += dt * carrying[d];
                }
            }
            if BACK {
                let volumes = volumes_of(initial_volume[point], volume_ratio[point], solid_fraction);
                let given = momenta_of(volumes, solid_velocity, water_velocity);
                basis.visit_runs(&stride, point, |first, weights, _| {
                    add_momenta(&mut momenta[first..first + W], weights, &given);
                });
            }
        }
    }
}

/// Adds a run of nodal vectors with their weights.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
fn add_weighted<const D: usize>(value: &mut Vector<D>, nodes: &[Vector<D>], weights: &[f64]) {
    for (node, weight) in nodes.iter().zip(weights) {
        for d in 0..D {
            value[d] += weight * node[d];
        }
    }
}
