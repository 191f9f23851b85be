//! The energy of a body, from its points and nodes.

use crate::body::Body;
use crate::run::energy::Energy;
use oedometer_soil::tensor::Tensor;

impl<const D: usize> Body<D> {
    /// Energy at a settlement, m, of the loaded surface; none where something beside a load on the surface works. `water`
    /// is the volume of water and its pressure, Pa, at each of the places that have one.
    pub(crate) fn energy(&self, settlement: f64, water: impl Iterator<Item = (f64, f64)>) -> Option<Energy> {
        if self.weight.is_some()
            || self.forcing.is_some()
            || self.plate.is_some()
            || self.material.law.is_hyperelastic()
        {
            return None;
        }
        let nodes = &self.nodes;
        let square = |velocity: &[f64; D]| velocity.iter().map(|one| one * one).sum::<f64>();
        let moving = (0..nodes.len()).map(|node| {
            0.5 * (nodes.solid_mass[node] * square(&nodes.solid_velocity[node])
                + nodes.water_mass[node] * square(&nodes.water_velocity[node]))
        });
        let points = &self.points;
        let strained = (0..points.len()).map(|point| {
            let ratio = points.volume_ratio[point];
            let modulus = self.material.law.modulus_ratio(ratio, ratio);
            points.volume(point) * self.strain_energy(&points.effective_stress[point]) / modulus
        });
        let pressed = water.map(|(volume, pressure)| volume * pressure * pressure);
        Some(Energy {
            kinetic: moving.sum(),
            stored: strained.sum::<f64>() + 0.5 * pressed.sum::<f64>() / self.material.water_bulk_modulus,
            work: self.surface.work(&self.points, settlement),
        })
    }

    /// Largest force on a free component of the skeleton that accelerates its node, N; infinite where one is not finite.
    pub(crate) fn largest_accelerating_force(&self) -> f64 {
        let nodes = &self.nodes;
        let mut largest: f64 = 0.0;
        for node in (0..nodes.len()).filter(|node| nodes.is_active(*node)) {
            for d in (0..D).filter(|d| nodes.free[node][*d] > 0.0) {
                let force = nodes.solid_mass[node] * nodes.solid_acceleration[node][d]
                    + nodes.water_mass[node] * nodes.water_acceleration[node][d];
                largest = if force.is_finite() { largest.max(force.abs()) } else { f64::INFINITY };
            }
        }
        largest
    }

    /// Volumes of water of the points and their pressures.
    pub(crate) fn water_of_points(&self) -> impl Iterator<Item = (f64, f64)> {
        let points = &self.points;
        (0..points.len()).map(|point| {
            let porosity = self.material.porosity_at(points.volume_ratio[point]);
            (porosity * points.volume(point), points.pressure[point])
        })
    }

    /// Energy of an effective stress per volume, J/m³: of an oedometer's in one dimension, of plane strain in two.
    fn strain_energy(&self, stress: &Tensor<D>) -> f64 {
        if D == 1 {
            return 0.5 * stress[0][0] * stress[0][0] / self.material.oedometric_modulus();
        }
        let (modulus, ratio) = (self.material.youngs_modulus, self.material.poissons_ratio);
        let squares: f64 = stress.as_flattened().iter().map(|one| one * one).sum();
        let trace: f64 = (0..D).map(|d| stress[d][d]).sum();
        0.5 * (1.0 + ratio) / modulus * (squares - ratio * trace * trace)
    }
}
