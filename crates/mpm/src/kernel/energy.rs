//! Energy balance of a run: drag and smoothing lower the energy, and only the work of loads may raise it.
//!
//! ```text
//! H = Σ ½ (m_s v_s² + m_w v_w²) + ∫ ½ σ':C⁻¹:σ' dV + ∫ n p²/(2 K_w) dV − W
//! ```
//!
//! with the work `W` of the loads since the start (Coussy 2004, section 4.3, for the free energy of a saturated
//! porous solid). `dH/dt = −∫ (n² γ_w/k) |v_w − v_s|² dV ≤ 0`: a step that makes energy has no other way to be told so long
//! before its fields are wrong, for what grows slowly grows in all of them alike.

use crate::actions::Actions;
use crate::kernel::body::Body;
use oedometer_problem::outcome as of_state;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::Tensor;

/// Largest accepted rise of the energy above its minimum so far, as a share of the largest kinetic energy so far.
///
/// The largest rise of the explicit cases of the shipped studies is a fifth of it; a mode that grows has made pressures
/// wrong by a fifth of the load where its energy is a twentieth of that of the load's own.
const MOST_RISE: f64 = 0.05;
/// [`MOST_RISE`] where points move: stresses of points that cross cells jump.
const MOST_RISE_MOVING: f64 = 0.1;

/// Energy of round-off, as a share of the work of the load: the square of what rounding leaves of velocities and stresses.
const ROUND_OFF: f64 = 1e-24;

/// Energy of a body at a time, J; in a column, J a unit area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Energy of stresses and pressures, since the start or in all.
    pub stored: f64,
    /// Work of the actions since the start.
    pub work: f64,
}

/// Extremes of a body's energy so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyAccount {
    /// Least of kinetic and stored energy less work so far, J.
    least: f64,
    /// Largest energy in motion so far, J.
    turned: f64,
    /// Energy in motion from which on a rise is judged, J.
    least_judged: f64,
    /// Largest rise above the least, over the energy in motion.
    pub largest_rise: f64,
}

impl EnergyAccount {
    /// Nothing seen yet of a body whose load does work of this order, J. A symmetric mesh may feel no load at all: what
    /// rounding leaves in motion is then no energy to judge.
    pub fn of_scale(work: f64) -> Self {
        Self { least: f64::INFINITY, turned: 0.0, least_judged: ROUND_OFF * work.abs(), largest_rise: 0.0 }
    }

    /// Records an energy; gives a sentence where it has risen more than under a sound step.
    pub fn note(&mut self, energy: Energy, moves: bool) -> Option<String> {
        let free = energy.kinetic + energy.stored - energy.work;
        self.turned = self.turned.max(energy.kinetic + energy.stored.abs() + energy.work.abs());
        self.least = self.least.min(free);
        let rise = free - self.least;
        if self.turned <= self.least_judged {
            return None;
        }
        let share = rise / self.turned;
        if share > self.largest_rise || share.is_nan() {
            self.largest_rise = share;
        }
        let most = if moves { MOST_RISE_MOVING } else { MOST_RISE };
        // NaN is not an energy.
        let is_within = share <= most;
        (!is_within).then(|| {
            format!(
                "energy grew by {rise:.3e} J without work, {share:.3} of all the energy in motion: a stable \
                 step causes less than {most}"
            )
        })
    }
}

impl<const D: usize> Body<D> {
    /// Energy at a settlement, m, of the loaded surface; none where something beside a load on the surface works. `water`
    /// is the volume of water and its pressure, Pa, at each of the places that have one.
    pub(crate) fn energy(&self, settlement: f64, water: impl Iterator<Item = (f64, f64)>) -> Option<Energy> {
        let Actions { weight, forcing, plate, surface, .. } = &self.actions;
        if weight.is_some() || forcing.is_some() || plate.is_some() {
            return None;
        }
        let of_state::Energy { kinetic, strain } = self.energy_now(water)?;
        Some(Energy { kinetic, stored: strain, work: surface.work(&self.points, settlement) })
    }

    /// Energy of the state alone; none where the law has no energy of its stresses. `water` as in [`energy`](Self::energy).
    pub(crate) fn energy_now(&self, water: impl Iterator<Item = (f64, f64)>) -> Option<of_state::Energy> {
        if self.material.law.is_hyperelastic() || self.has_history() {
            return None;
        }
        let nodes = &self.nodes;
        let square =
            |velocity: &[f64; D]| velocity.iter().map(|component| component * component).sum::<f64>();
        let moving = (0..nodes.len()).map(|node| {
            0.5 * (nodes.solid_mass[node] * square(&nodes.solid_velocity[node])
                + nodes.water_mass[node] * square(&nodes.water_velocity[node]))
        });
        let points = &self.points;
        let strained = (0..points.len()).map(|point| {
            let ratio = points.volume_ratio[point];
            let modulus = self.material.law.modulus_ratio(ratio, ratio);
            let energy = strain_energy(self.soil_of(point), &points.effective_stress[point]);
            points.volume(point) * energy / modulus
        });
        let pressed = water.map(|(volume, pressure)| volume * pressure * pressure);
        Some(of_state::Energy {
            kinetic: moving.sum(),
            strain: strained.sum::<f64>() + 0.5 * pressed.sum::<f64>() / self.material.water_bulk_modulus,
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

    /// Volumes of water of the points, as if all were as stiff as the first soil's, and their pressures.
    pub(crate) fn water_of_points(&self) -> impl Iterator<Item = (f64, f64)> {
        let points = &self.points;
        (0..points.len()).map(|point| {
            let soil = self.soil_of(point);
            let share = self.material.water_bulk_modulus / soil.water_bulk_modulus;
            let porosity = soil.porosity_at(points.volume_ratio[point]);
            (porosity * points.volume(point) * share, points.pressure[point])
        })
    }
}

/// Energy of an effective stress per volume, J/m³: of an oedometer's in one dimension, of plane strain in two.
fn strain_energy<const D: usize>(soil: &Material, stress: &Tensor<D>) -> f64 {
    if D == 1 {
        return 0.5 * stress[0][0] * stress[0][0] / soil.oedometric_modulus();
    }
    let (modulus, ratio) = (soil.youngs_modulus, soil.poissons_ratio);
    let squares: f64 = stress.as_flattened().iter().map(|component| component * component).sum();
    let trace: f64 = (0..D).map(|d| stress[d][d]).sum();
    0.5 * (1.0 + ratio) / modulus * (squares - ratio * trace * trace)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_may_fall_and_rises_only_by_work() {
        let mut account = EnergyAccount::of_scale(1.0);
        let energy = |kinetic, stored, work| Energy { kinetic, stored, work };
        for (kinetic, stored, work) in [(0.0, 1.0, 0.0), (1.0, 1.0, 1.0), (0.5, 1.0, 1.5), (0.0, 5.0, 6.0)] {
            assert_eq!(account.note(energy(kinetic, stored, work), false), None);
        }
        assert_eq!(account.largest_rise, 0.0);
        assert_eq!(account.note(energy(0.0, 5.5, 6.0), false), None, "round-off of a scheme");
        let grown = account.note(energy(1.0, 5.5, 6.0), false).expect("it rose by more than a tenth");
        assert!(grown.contains("1.500e0 J without work"), "{grown}");
        assert!(account.note(energy(f64::NAN, 5.5, 6.0), true).is_some());
        let mut still = EnergyAccount::of_scale(1.0);
        assert_eq!(still.note(energy(0.0, 0.0, 0.0), false), None, "nothing has happened yet");
        for kinetic in [1e-34, 9e-34] {
            assert_eq!(
                still.note(energy(kinetic, 0.0, 0.0), false),
                None,
                "round-off of a load that moves nothing"
            );
        }
        still.note(energy(1e-9, 0.0, 0.0), false);
        assert!(still.note(energy(9e-9, 0.0, 0.0), false).is_some());
    }

    #[test]
    fn the_energy_of_a_stress_is_half_its_product_with_the_strain_that_made_it() {
        let soil = Material { youngs_modulus: 3e6, poissons_ratio: 0.3, ..Material::default() };
        let gradient = [[1e-3, 4e-4], [-2e-4, -3e-3]];
        let stress = soil.stiffness().stress(&gradient);
        // The shear strain is the mean of the gradients across; none out of the plane.
        let strain = [[1e-3, 1e-4], [1e-4, -3e-3]];
        let product: f64 = (0..4).map(|i| stress[i / 2][i % 2] * strain[i / 2][i % 2]).sum();
        let energy = strain_energy(&soil, &stress);
        assert!((energy / (0.5 * product) - 1.0).abs() < 1e-14, "{energy:e}");
        let confined = strain_energy(&soil, &[[2e3]]);
        assert!((confined / (0.5 * 4e6 / soil.oedometric_modulus()) - 1.0).abs() < 1e-14, "{confined:e}");
    }
}
