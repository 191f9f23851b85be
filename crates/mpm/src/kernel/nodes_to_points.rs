//! From nodes to points: velocities and places of the points.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::kernel::body::Body;
use crate::kernel::points_to_nodes::{Given, Gives, ToNodes, scaled};
use crate::operators::stencil::{Stencils, with_stencils};
use crate::state::points::Points;
use crate::wide::wide;
use oedometer_soil::tensor::Vector;

/// Durations and shares of a step, for the points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// How long velocities advance, s.
    pub kick: f64,
    /// How long places and displacements do, s.
    pub dt: f64,
    /// Share of the acceleration update (FLIP) in the velocities.
    pub flip: f64,
}

impl Motion {
    /// Takes a point's velocity through the step, m/s: by the acceleration that the nodes have there, and for what is
    /// not `flip`, to the velocity that they have there.
    #[inline(always)]
    pub fn accelerate<const D: usize>(self, velocity: &mut Vector<D>, rate: &Vector<D>, nodal: &Vector<D>) {
        for d in 0..D {
            velocity[d] += self.kick * rate[d];
        }
        if self.flip < 1.0 {
            for d in 0..D {
                velocity[d] = self.flip * velocity[d] + (1.0 - self.flip) * nodal[d];
            }
        }
    }

    /// Takes a place or a displacement through the step, m.
    #[inline(always)]
    pub fn carry<const D: usize>(self, place: &mut Vector<D>, velocity: &Vector<D>) {
        for d in 0..D {
            place[d] += self.dt * velocity[d];
        }
    }
}

impl<const D: usize> Body<D> {
    /// Step 4: velocities and places of the points, and in the same pass what they give back to the same nodes: the momenta
    /// of step 5, or nothing.
    pub(crate) fn advance_points<G: Gives>(&mut self, motion: Motion) {
        let basis = std::mem::take(&mut self.operators.basis);
        with_stencils!(&basis, stencils => wide!(self.advance_points_by::<_, G>(stencils, motion)));
        self.operators.basis = basis;
    }

    #[inline(always)]
    fn advance_points_by<const W: usize, G: Gives>(&mut self, stencils: &Stencils<D, W>, motion: Motion) {
        let (stride, moves) = (*self.grid.node_stride(), self.configuration.moves_points());
        let (nodes, carrier) = (&mut self.nodes, self.operators.strain.carrier());
        let (nodal_motion, nodal_velocity) = (&nodes.motion[..], &nodes.solid_velocity[..]);
        let count = self.points.len();
        let Points {
            position,
            displacement,
            solid_velocity,
            water_velocity,
            grain_volume,
            initial_volume,
            volume_ratio,
            ..
        } = &mut self.points;
        let [position, displacement, solid_velocity] =
            [position, displacement, solid_velocity].map(|field| &mut field[..count]);
        let [grain_volume, initial_volume, volume_ratio] =
            [grain_volume, initial_volume, volume_ratio].map(|field| &field[..count]);
        let mut sums = ToNodes::<D, W, G>::new(&mut nodes.sums, stride);
        let stencils = stencils.slices(count);
        for point in 0..count {
            let stencil = stencils.of_point(point);
            let [mut carrying, solid_rate, water_carrying, water_rate] =
                stencil.values_of(&stride, nodal_motion);
            let solid = &mut solid_velocity[point];
            motion.accelerate(solid, &solid_rate, &carrying);
            let mut momenta = [*solid, [0.0; D]];
            // None where the water has points of its own.
            if let Some(water) = water_velocity.get_mut(point) {
                motion.accelerate(water, &water_rate, &water_carrying);
                momenta[1] = *water;
            }
            if let Some(ends) = carrier {
                [carrying] = ends.of_point(point).values(&stride, [nodal_velocity]);
            }
            motion.carry(&mut displacement[point], &carrying);
            if moves {
                motion.carry(&mut position[point], &carrying);
            }
            if G::MOMENTA {
                let grains = grain_volume[point];
                let volumes = [grains, initial_volume[point] * volume_ratio[point] - grains];
                sums.add(stencil, &Given { momenta: scaled(&momenta, volumes), ..Given::NOTHING });
            }
        }
        sums.close();
    }
}
