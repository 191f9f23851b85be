//! What the points of a phase and the nodes give each other in a step: each layer carries one phase, and takes and
//! gives that one alone.

use crate::layers::motion::Motion;
use crate::layers::two_layers::TwoLayers;
use crate::operators::stencil::{PointStencils, with_stencils};
use crate::state::nodes::Nodes;
use oedometer_soil::tensor::Vector;

/// Sums the momenta of points to the nodes, `[node][component]`.
fn sum_momenta<const D: usize>(
    basis: &PointStencils<D>,
    stride: &[usize; D],
    momenta: impl Iterator<Item = Vector<D>>,
    sums: &mut [Vector<D>],
) {
    sums.fill([0.0; D]);
    with_stencils!(basis, stencils => {
        for (point, momentum) in momenta.enumerate() {
            stencils.visit(stride, point, |node, weight, _| {
                for d in 0..D {
                    sums[node][d] += weight * momentum[d];
                }
            });
        }
    });
}

impl<const D: usize> TwoLayers<D> {
    /// Step 4 of the skeleton: velocities, displacements and places of its points.
    pub(crate) fn advance_skeleton(&mut self, motion: Motion) {
        let body = &mut self.body;
        let (stride, moves) = (*body.grid.node_stride(), body.configuration.moves_points());
        let (velocities, rates) = (&body.nodes.solid_velocity, &body.nodes.solid_acceleration);
        let carrier = body.strain.carrier();
        with_stencils!(&body.basis, stencils => {
            let (blocks, points) = (stencils.blocks(), &mut body.points);
            for point in 0..points.len() {
                let rate = blocks.value(&stride, point, rates);
                let of_basis = blocks.value(&stride, point, velocities);
                let carrying = carrier.map_or(of_basis, |ends| ends.value(&stride, point, velocities));
                motion.accelerate(&mut points.solid_velocity[point], &rate, &of_basis);
                motion.carry(&mut points.displacement[point], &carrying);
                if moves {
                    motion.carry(&mut points.position[point], &carrying);
                }
            }
        });
    }

    /// Step 4 of the water: velocities and places of its points.
    pub(crate) fn advance_water(&mut self, motion: Motion) {
        let moves = self.body.configuration.moves_points();
        let (stride, nodes) = (*self.body.grid.node_stride(), &self.body.nodes);
        with_stencils!(&self.basis, stencils => {
            let blocks = stencils.blocks();
            for point in 0..self.water.len() {
                let rate = blocks.value(&stride, point, &nodes.water_acceleration);
                let carrying = if moves || motion.flip < 1.0 {
                    blocks.value(&stride, point, &nodes.water_velocity)
                } else {
                    [0.0; D]
                };
                motion.accelerate(&mut self.water.velocity[point], &rate, &carrying);
                if moves {
                    motion.carry(&mut self.water.position[point], &carrying);
                }
            }
        });
    }

    /// Maps the velocity of the skeleton to the nodes, weighted with mass.
    pub(crate) fn map_skeleton_velocities(&mut self) {
        let body = &mut self.body;
        let (points, solid_fraction) = (&body.points, 1.0 - body.material.porosity);
        let momenta = points.solid_velocity.iter().zip(&points.initial_volume);
        let momenta =
            momenta.map(|(velocity, initial)| velocity.map(|component| initial * solid_fraction * component));
        sum_momenta(&body.basis, body.grid.node_stride(), momenta, &mut self.sums.momenta);
        let Nodes { runs, solid_velocity, per_solid_mass, free, .. } = &mut body.nodes;
        for node in runs.iter().cloned().flatten() {
            let per_grain_volume = body.material.grain_density * per_solid_mass[node];
            for d in 0..D {
                solid_velocity[node][d] = self.sums.momenta[node][d] * (free[node][d] * per_grain_volume);
            }
        }
    }

    /// Maps the velocity of the water to the nodes, weighted with mass; water that no soil holds goes with the soil,
    /// and what slides along a rough base stays as the node has it.
    pub(crate) fn map_water_velocities(&mut self) {
        let water = &self.water;
        let momenta = water.velocity.iter().enumerate();
        let momenta =
            momenta.map(|(point, velocity)| velocity.map(|component| water.mass_inside(point) * component));
        sum_momenta(&self.basis, self.body.grid.node_stride(), momenta, &mut self.sums.momenta);
        let nodes = &mut self.body.nodes;
        for (node, momentum) in self.sums.momenta.iter().enumerate() {
            for d in (0..D).filter(|d| nodes.sliding[node][*d] == 0.0) {
                nodes.water_velocity[node][d] = if nodes.water_mass[node] > 0.0 {
                    momentum[d] * (nodes.water_free[node][d] * nodes.per_water_mass[node])
                } else {
                    nodes.solid_velocity[node][d]
                };
            }
        }
    }
}
