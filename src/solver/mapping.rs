//! From points to nodes: masses, velocities and forces, each one pass over the points.
//!
//! Where points move, these passes are most of a step. Each takes a point's run of nodes as one
//! slice, so that its bounds are checked once, and sums side by side what belongs to one node.

use super::body::{Body, ShapeFunction};
use super::grid::Tensor;
use super::method::Configuration;

impl<const D: usize, const W: usize, S: ShapeFunction<W>> Body<D, W, S> {
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

    #[inline]
    fn map_points<const MASSES: bool, const VELOCITIES: bool>(&mut self) {
        let (soil, nodes) = (&self.material, &mut self.nodes);
        let (solid_fraction, unit_weight) = (1.0 - soil.porosity, soil.unit_weight_of_water());
        // Slices of one length: the bounds of all are checked here and not at every point.
        let count = self.points.len();
        let (initial_volume, volume_ratio) =
            (&self.points.initial_volume[..count], &self.points.volume_ratio[..count]);
        let (solid_velocity, water_velocity) =
            (&self.points.solid_velocity[..count], &self.points.water_velocity[..count]);
        let (basis, stride) = (self.basis.blocks(), *self.grid.node_stride());
        if MASSES {
            nodes.shares.fill([0.0; 3]);
        }
        if VELOCITIES {
            nodes.solid_velocity.fill([0.0; D]);
            nodes.water_velocity.fill([0.0; D]);
        }
        let shares = &mut nodes.shares[..];
        let (solid_momenta, water_momenta) = (&mut nodes.solid_velocity[..], &mut nodes.water_velocity[..]);
        for point in 0..count {
            // Grains fill (1 − n) V = (1 − n_0) V_0, water n V.
            let (initial, ratio) = (initial_volume[point], volume_ratio[point]);
            let grain_volume = initial * solid_fraction;
            let pore_volume = initial * (ratio - solid_fraction);
            let drag =
                if MASSES { pore_volume * unit_weight / soil.hydraulic_conductivity_at(ratio) } else { 0.0 };
            let solid_flux = solid_velocity[point].map(|velocity| grain_volume * velocity);
            let water_flux = water_velocity[point].map(|velocity| pore_volume * velocity);
            basis.visit_runs(&stride, point, |first, weights, _| {
                if MASSES {
                    for (share, weight) in shares[first..first + W].iter_mut().zip(weights) {
                        share[0] += weight * grain_volume;
                        share[1] += weight * pore_volume;
                        share[2] += weight * drag;
                    }
                }
                if VELOCITIES {
                    let solid = &mut solid_momenta[first..first + W];
                    let water = &mut water_momenta[first..first + W];
                    for (k, weight) in weights.iter().enumerate() {
                        for d in 0..D {
                            solid[k][d] += weight * solid_flux[d];
                            water[k][d] += weight * water_flux[d];
                        }
                    }
                }
            });
        }
        if MASSES {
            nodes.take_shares(soil);
        }
        if VELOCITIES {
            nodes.divide_momenta(soil);
        }
    }

    /// Forces on the mixture and on the water from the points' stresses (weak form, drained
    /// surface natural).
    pub fn map_forces(&mut self) {
        let (nodes, points) = (&mut self.nodes, &self.points);
        nodes.mixture_force.copy_from_slice(&nodes.external_force);
        nodes.water_force.fill([0.0; D]);
        let (mixture_forces, water_forces) = (&mut nodes.mixture_force[..], &mut nodes.water_force[..]);
        let count = points.len();
        let (initial_volume, volume_ratio, stressed_share) =
            (&points.initial_volume[..count], &points.volume_ratio[..count], &points.stressed_share[..count]);
        let (effective_stress, pressure) = (&points.effective_stress[..count], &points.pressure[..count]);
        let inverse_deformation = &points.inverse_deformation[..count];
        let is_total = self.configuration == Configuration::Total;
        let (basis, stride) = (self.basis.blocks(), *self.grid.node_stride());
        for point in 0..count {
            let volume = initial_volume[point] * volume_ratio[point] * stressed_share[point];
            let pressure = volume * pressure[point];
            let mut total = effective_stress[point];
            let mut water = [[0.0; D]; D];
            for d in 0..D {
                for e in 0..D {
                    total[d][e] *= volume;
                }
                total[d][d] -= pressure;
                water[d][d] = pressure;
            }
            if is_total {
                [total, water] =
                    [total, water].map(|stress| pulled_back(&inverse_deformation[point], &stress));
            }
            basis.visit_runs(&stride, point, |first, _, gradients| {
                let mixture_force = &mut mixture_forces[first..first + W];
                let water_force = &mut water_forces[first..first + W];
                for (k, gradient) in gradients.iter().enumerate() {
                    for d in 0..D {
                        for e in 0..D {
                            mixture_force[k][d] -= total[d][e] * gradient[e];
                            water_force[k][d] += water[d][e] * gradient[e];
                        }
                    }
                }
            });
        }
    }
}

/// A stress that meets gradients on the initial configuration, `σ F⁻ᵀ`.
#[inline]
fn pulled_back<const D: usize>(inverse_deformation: &Tensor<D>, stress: &Tensor<D>) -> Tensor<D> {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..D).map(|k| stress[i][k] * inverse_deformation[j][k]).sum())
    })
}
