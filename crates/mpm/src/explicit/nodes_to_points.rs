//! From nodes to points: velocities and places of the points.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::body::Body;
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
    pub fn accelerate<const D: usize>(
        self,
        velocity: &mut Vector<D>,
        rate: &Vector<D>,
        nodal: impl FnOnce() -> Vector<D>,
    ) {
        for d in 0..D {
            velocity[d] += self.kick * rate[d];
        }
        if self.flip < 1.0 {
            let nodal = nodal();
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
    /// Step 4: velocities and places of the points.
    pub(crate) fn advance_points(&mut self, motion: Motion) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => wide!(self.advance_points_by(stencils, motion)));
        self.basis = basis;
    }

    #[inline(always)]
    fn advance_points_by<const W: usize>(&mut self, stencils: &Stencils<D, W>, motion: Motion) {
        let (stride, moves) = (*self.grid.node_stride(), self.configuration.moves_points());
        let (nodes, carrier) = (&self.nodes, self.strain.carrier());
        let Points { position, displacement, solid_velocity, water_velocity, .. } = &mut self.points;
        let fields =
            [&nodes.solid_velocity[..], &nodes.solid_acceleration[..], &nodes.water_acceleration[..]];
        for (point, (stencil, solid)) in stencils.all().zip(solid_velocity).enumerate() {
            let [mut carrying, solid_rate, water_rate] = stencil.values(&stride, fields);
            motion.accelerate(solid, &solid_rate, || carrying);
            // None where the water has points of its own.
            if let Some(water) = water_velocity.get_mut(point) {
                motion.accelerate(water, &water_rate, || {
                    stencil.values(&stride, [&nodes.water_velocity[..]])[0]
                });
            }
            if let Some(ends) = carrier {
                [carrying] = ends.of_point(point).values(&stride, [&nodes.solid_velocity[..]]);
            }
            motion.carry(&mut displacement[point], &carrying);
            if moves {
                motion.carry(&mut position[point], &carrying);
            }
        }
    }
}
