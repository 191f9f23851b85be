//! How far a step takes the points of either phase.

use oedometer_soil::tensor::Vector;

/// Durations and shares of a step, for the points.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// How long velocities advance, s.
    pub kick: f64,
    /// How long places and displacements do, s.
    pub dt: f64,
    /// Share of the acceleration update in the velocities.
    pub flip: f64,
}

impl Motion {
    /// Takes a point's velocity through the step, m/s: by the acceleration that the nodes have there, and for what is
    /// not `flip`, to the velocity that carries it.
    pub(crate) fn accelerate<const D: usize>(
        self,
        velocity: &mut Vector<D>,
        rate: &Vector<D>,
        carrying: &Vector<D>,
    ) {
        for d in 0..D {
            velocity[d] += self.kick * rate[d];
            if self.flip < 1.0 {
                velocity[d] = self.flip * velocity[d] + (1.0 - self.flip) * carrying[d];
            }
        }
    }

    /// Takes a place or a displacement through the step, m.
    pub(crate) fn carry<const D: usize>(self, place: &mut Vector<D>, carrying: &Vector<D>) {
        for d in 0..D {
            place[d] += self.dt * carrying[d];
        }
    }
}
