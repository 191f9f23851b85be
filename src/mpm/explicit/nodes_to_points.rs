//! From nodes to points: what carries them, and what they give back to the nodes at once.
//!
//! A point's new velocities need no other point: its momenta go back to the nodes in the same pass, while its weights
//! are in registers.

use crate::mpm::body::Body;
use crate::mpm::explicit::points_to_nodes::{add_momenta, add_momenta_in_line, momenta_of, volumes_of};
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::state::lanes::LANES;
use crate::mpm::state::nodes::Nodes;
use crate::mpm::wide::wide;

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
        self.nodes.gather_motion();
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => {
            wide!(self.carry_points_by::<BACK, _>(stencils.blocks(), motion));
        });
        self.basis = basis;
    }

    /// The same, some neighbouring points after the others: first what the nodes do at each of them, then what
    /// follows.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    fn carry_points_by<const BACK: bool, const W: usize>(
        &mut self,
        basis: Blocks<'_, D, W>,
        Motion { kick, dt, flip }: Motion,
    ) {
        let moving = self.configuration.moves_points();
        let (pic, solid_fraction) = (1.0 - flip, 1.0 - self.material.porosity);
        let carrier = self.strain.carrier();
        let stride = *self.grid.node_stride();
        let Nodes { solid_velocity: solid_field, motion, sums, .. } = &mut self.nodes;
        let (solid_field, motion, momenta) = (&solid_field[..], &motion[..], &mut sums.momenta[..]);
        if BACK {
            momenta.fill([[0.0; D]; 2]);
        }
        let points = &mut self.points;
        let count = points.len();
        let (solid_velocity, water_velocity) =
            (&mut points.solid_velocity[..count], &mut points.water_velocity[..count]);
        let (displacement, position) = (&mut points.displacement[..count], &mut points.position[..count]);
        let (initial_volume, volume_ratio) = (&points.initial_volume[..count], &points.volume_ratio[..count]);
        let (mut motions, mut given) = ([[[0.0; D]; 4]; LANES], [[[0.0; D]; 2]; LANES]);
        for first in (0..count).step_by(LANES) {
            let block = first..count.min(first + LANES);
            for (at_point, point) in motions.iter_mut().zip(block.clone()) {
                *at_point = basis.values(&stride, point, motion);
            }
            for ([_, _, solid_rate, water_rate], point) in motions.iter().zip(block.clone()) {
                for d in 0..D {
                    solid_velocity[point][d] += kick * solid_rate[d];
                    water_velocity[point][d] += kick * water_rate[d];
                }
            }
            if flip < 1.0 {
                for ([solid, water, ..], point) in motions.iter().zip(block.clone()) {
                    for d in 0..D {
                        solid_velocity[point][d] = flip * solid_velocity[point][d] + pic * solid[d];
                        water_velocity[point][d] = flip * water_velocity[point][d] + pic * water[d];
                    }
                }
            }
            if let Some(ends) = carrier {
                for (at_point, point) in motions.iter_mut().zip(block.clone()) {
                    at_point[0] = ends.value(&stride, point, solid_field);
                }
            }
            for ([carrying, ..], displacement) in motions.iter().zip(&mut displacement[block.clone()]) {
                for d in 0..D {
                    displacement[d] += dt * carrying[d];
                }
            }
            if moving {
                for ([carrying, ..], position) in motions.iter().zip(&mut position[block.clone()]) {
                    for d in 0..D {
                        position[d] += dt * carrying[d];
                    }
                }
            }
            if BACK {
                for (given, point) in given.iter_mut().zip(block.clone()) {
                    let volumes = volumes_of(initial_volume[point], volume_ratio[point], solid_fraction);
                    *given = momenta_of(volumes, &solid_velocity[point], &water_velocity[point]);
                }
                if D == 1 {
                    add_momenta_in_line(basis, block, momenta, &given);
                    continue;
                }
                for (given, point) in given.iter().zip(block) {
                    basis.visit_runs(
                        &stride,
                        point,
                        #[inline(always)]
                        |run| add_momenta(momenta, run, given),
                    );
                }
            }
        }
    }
}
