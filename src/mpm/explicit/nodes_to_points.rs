//! From nodes to points: what carries them, and what they give back to the nodes at once.
//!
//! A point's new velocities need no other point: its momenta go back to the nodes in the same pass, while its weights
//! are in registers.

use crate::mpm::body::Body;
use crate::mpm::explicit::points_to_nodes::{add_momenta, momenta_of, volumes_of};
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::state::nodes::Nodes;

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
            basis.visit_runs(&stride, point, |run| {
                run.add_value(&mut solid, solid_field);
                run.add_value(&mut solid_rate, solid_rates);
                run.add_value(&mut water_rate, water_rates);
                if PIC {
                    run.add_value(&mut water, water_field);
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
                basis.visit_runs(&stride, point, |run| add_momenta(momenta, run, &given));
            }
        }
    }
}
