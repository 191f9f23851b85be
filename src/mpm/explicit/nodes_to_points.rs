//! From nodes to points: what carries them, and what they give back to the nodes at once.
//!
//! A point's new velocities need no other point: its momenta go back to the nodes in the same pass, while its weights
//! are in registers.

use crate::mpm::body::Body;
use crate::mpm::explicit::points_to_nodes::{add_momenta, momenta_of, volumes_of};
use crate::mpm::operators::block_rows::Blocks;
use crate::mpm::operators::stencil::with_stencils;
use crate::mpm::run::profile::{Phase, enter};
use crate::mpm::state::lanes::{LANES, block_of, blocks_of, put_block};
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
        let (solid_field, motion, balances) = (&solid_field[..], &motion[..], &mut sums.balances[..]);
        if BACK {
            for [solid, water, ..] in &mut *balances {
                (*solid, *water) = ([0.0; D], [0.0; D]);
            }
        }
        let points = &mut self.points;
        for block in blocks_of(points.len()) {
            let (rows, count) = (basis.block(block.start / LANES), block.len().min(LANES));
            // Velocities of skeleton and water and their rates at the nodes.
            let mut at_points = [[[0.0; D]; 4]; LANES];
            for lane in 0..count {
                at_points[lane] = rows.values(&stride, lane, motion);
            }
            let mut solid = block_of(&points.solid_velocity, &block, [0.0; D]);
            let mut water = block_of(&points.water_velocity, &block, [0.0; D]);
            for lane in 0..LANES {
                let [_, _, solid_rate, water_rate] = &at_points[lane];
                for d in 0..D {
                    solid[lane][d] += kick * solid_rate[d];
                    water[lane][d] += kick * water_rate[d];
                }
            }
            if flip < 1.0 {
                for lane in 0..LANES {
                    let [solid_there, water_there, ..] = &at_points[lane];
                    for d in 0..D {
                        solid[lane][d] = flip * solid[lane][d] + pic * solid_there[d];
                        water[lane][d] = flip * water[lane][d] + pic * water_there[d];
                    }
                }
            }
            put_block(&mut points.solid_velocity, &block, &solid);
            put_block(&mut points.water_velocity, &block, &water);
            if let Some(ends) = carrier {
                let ends = ends.block(block.start / LANES);
                for lane in 0..count {
                    at_points[lane][0] = ends.value(&stride, lane, solid_field);
                }
            }
            let mut displacement = block_of(&points.displacement, &block, [0.0; D]);
            for lane in 0..LANES {
                let [carrying, ..] = &at_points[lane];
                for d in 0..D {
                    displacement[lane][d] += dt * carrying[d];
                }
            }
            put_block(&mut points.displacement, &block, &displacement);
            if moving {
                let mut position = block_of(&points.position, &block, [0.0; D]);
                for lane in 0..LANES {
                    let [carrying, ..] = &at_points[lane];
                    for d in 0..D {
                        position[lane][d] += dt * carrying[d];
                    }
                }
                put_block(&mut points.position, &block, &position);
            }
            if BACK {
                let initial = block_of(&points.initial_volume, &block, 0.0);
                let ratio = block_of(&points.volume_ratio, &block, 1.0);
                let [mut grains, mut pores] = [[0.0; LANES]; 2];
                for lane in 0..LANES {
                    [grains[lane], pores[lane]] = volumes_of(initial[lane], ratio[lane], solid_fraction);
                }
                add_momenta(
                    rows,
                    &stride,
                    count,
                    balances,
                    #[inline(always)]
                    |lane| momenta_of([grains[lane], pores[lane]], &solid[lane], &water[lane]),
                );
            }
        }
    }
}
