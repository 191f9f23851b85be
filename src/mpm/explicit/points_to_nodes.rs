//! From points to nodes: masses, velocities and forces, each one pass over the points.
//!
//! Where points move, these passes are most of a step. Each takes a point's run of nodes as one
//! slice, so that its bounds are checked once, and sums side by side what belongs to one node.

use crate::mpm::body::Body;
use crate::mpm::operators::stencil::{Blocks, with_stencils};
use crate::soil::conductivity_mean::ConductivityMean;
use crate::soil::tensor::product_with_transpose;

impl<const D: usize> Body<D> {
    /// Sums masses, volumes and drag of the points to the nodes.
    pub fn map_masses(&mut self) {
        self.map_points::<true, false>();
    }

    /// Maps the velocities of both phases from the points to the nodes, weighted with mass.
    pub fn map_velocities(&mut self) {
        self.map_points::<false, true>();
    }

    /// Both in one pass.
    pub fn map_masses_and_velocities(&mut self) {
        self.map_points::<true, true>();
    }

    fn map_points<const MASSES: bool, const VELOCITIES: bool>(&mut self) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => self.map_points_by::<MASSES, VELOCITIES, _>(stencils.blocks()));
        self.basis = basis;
        if MASSES && self.material.conductivity_mean == ConductivityMean::Chord {
            self.take_chord_drag();
        }
        if let Some(plate) = self.plate.as_ref().filter(|_| VELOCITIES) {
            plate.tie_velocities(&mut self.nodes);
        }
    }

    fn map_points_by<const MASSES: bool, const VELOCITIES: bool, const W: usize>(
        &mut self,
        basis: Blocks<'_, D, W>,
    ) {
        let (soil, nodes) = (&self.material, &mut self.nodes);
        let (solid_fraction, unit_weight) = (1.0 - soil.porosity, soil.unit_weight_of_water());
        // Slices of one length: the bounds of all are checked here and not at every point.
        let count = self.points.len();
        let (initial_volume, volume_ratio) =
            (&self.points.initial_volume[..count], &self.points.volume_ratio[..count]);
        let (solid_velocity, water_velocity) =
            (&self.points.solid_velocity[..count], &self.points.water_velocity[..count]);
        let stride = *self.grid.node_stride();
        if MASSES {
            nodes.sums.masses.fill([0.0; 4]);
        }
        if VELOCITIES {
            nodes.sums.momenta.fill([[0.0; D]; 2]);
        }
        let (nodal_masses, nodal_momenta) = (&mut nodes.sums.masses[..], &mut nodes.sums.momenta[..]);
        for point in 0..count {
            // Grains fill (1 − n) V = (1 − n_0) V_0, water n V.
            let (initial, ratio) = (initial_volume[point], volume_ratio[point]);
            let grain_volume = initial * solid_fraction;
            let pore_volume = initial * (ratio - solid_fraction);
            let drag =
                if MASSES { pore_volume * unit_weight / soil.hydraulic_conductivity_at(ratio) } else { 0.0 };
            let masses = [grain_volume, pore_volume, drag, 0.0];
            let momenta = [
                solid_velocity[point].map(|velocity| grain_volume * velocity),
                water_velocity[point].map(|velocity| pore_volume * velocity),
            ];
            basis.visit_runs(&stride, point, |first, weights, _| {
                if MASSES {
                    for (node, weight) in nodal_masses[first..first + W].iter_mut().zip(weights) {
                        for (sum, mass) in node.iter_mut().zip(&masses) {
                            *sum += weight * mass;
                        }
                    }
                }
                if VELOCITIES {
                    for (node, weight) in nodal_momenta[first..first + W].iter_mut().zip(weights) {
                        for (sum, momentum) in node.iter_mut().zip(&momenta) {
                            for d in 0..D {
                                sum[d] += weight * momentum[d];
                            }
                        }
                    }
                }
            });
        }
        if MASSES {
            nodes.take_masses(soil);
        }
        if VELOCITIES {
            nodes.take_velocities(soil);
        }
    }

    /// Forces on the mixture and on the water from the points' stresses (weak form, drained
    /// surface natural).
    pub fn map_forces(&mut self) {
        let basis = std::mem::take(&mut self.basis);
        with_stencils!(&basis, stencils => self.map_forces_by(stencils.blocks()));
        self.basis = basis;
        if self.forcing.is_some() {
            self.add_body_forces();
        }
    }

    fn map_forces_by<const W: usize>(&mut self, basis: Blocks<'_, D, W>) {
        let (nodes, points) = (&mut self.nodes, &self.points);
        for (forces, external) in nodes.sums.forces.iter_mut().zip(&nodes.external_force) {
            *forces = [*external, [0.0; D]];
        }
        let nodal_forces = &mut nodes.sums.forces[..];
        let count = points.len();
        let (initial_volume, volume_ratio, stressed_share) =
            (&points.initial_volume[..count], &points.volume_ratio[..count], &points.stressed_share[..count]);
        let (effective_stress, pressure) = (&points.effective_stress[..count], &points.pressure[..count]);
        let inverse_deformation = &points.inverse_deformation[..count];
        let is_total = self.is_pushed_forward;
        let stride = *self.grid.node_stride();
        for point in 0..count {
            let volume = initial_volume[point] * volume_ratio[point] * stressed_share[point];
            let pressure = volume * pressure[point];
            // What each unit of gradient gives to the mixture, −σ V, and to the water, p V.
            let mut mixture = effective_stress[point].map(|row| row.map(|stress| -(volume * stress)));
            let mut water = [[0.0; D]; D];
            for d in 0..D {
                mixture[d][d] += pressure;
                water[d][d] = pressure;
            }
            let mut given = [mixture, water];
            if is_total {
                // Gradients on the initial configuration meet `σ F⁻ᵀ`.
                given = given.map(|stress| product_with_transpose(&stress, &inverse_deformation[point]));
            }
            basis.visit_runs(&stride, point, |first, _, gradients| {
                for (node, gradient) in nodal_forces[first..first + W].iter_mut().zip(gradients) {
                    for (force, given) in node.iter_mut().zip(&given) {
                        for d in 0..D {
                            for e in 0..D {
                                force[d] += given[d][e] * gradient[e];
                            }
                        }
                    }
                }
            });
        }
        for (node, forces) in nodes.sums.forces.iter().enumerate() {
            [nodes.mixture_force[node], nodes.water_force[node]] = *forces;
        }
        if self.weight.is_some() {
            self.add_weight();
        }
    }
}
