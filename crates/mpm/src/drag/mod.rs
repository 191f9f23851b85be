//! The drag between water and skeleton: of a point, of a node with the balances of momentum that it is part of, and what
//! it allows as a step.
//!
//! ```text
//! D_p = n γ_w V/k(J)       D_i = Σ_p N_ip D_p, or the chord mean
//!
//! ρ_w V a_w         = f_w − D (v_w − v_s)          water (docs/theory.md, Eq. 1; Zheng et al. Eq. 1)
//! m_s a_s + m_w a_w = f                            mixture (Eq. 2)
//! ```
//!
//! with the force `f` on the mixture and `f_w` of the pressure gradient on the water, lumped at the nodes and per
//! component. The point-wise step, the assembled one and implicit stages all get their accelerations here.
//! The conductivity `k(J)` itself is in `oedometer_soil::conductivity`.

use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use oedometer_soil::wording::words;

/// Time level at which the drag between skeleton and water is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drag {
    /// Old velocities: the drag bounds the step.
    Explicit,
    /// New velocities, a 2 × 2 solve a node: the drag sets no bound.
    Implicit,
    /// The mean over the step: second order, and no bound either.
    Centred,
}

words!(Drag: Explicit "explicit", Implicit "implicit", Centred "centred");

impl Drag {
    /// Share of the new relative velocity in the drag of a kick, `z` its duration times the rate at
    /// which the drag alone brings the phases together.
    ///
    /// Centred: the share that makes the mean drag of `ṙ = −λ r + const` exact,
    /// `1/(1 − e^{−z}) − 1/z` (exponential fitting; Liniger & Willoughby 1970). One half for a short
    /// kick, and one where the drag is stiff: second order, and no limit on the step.
    #[inline]
    fn implicit_share(self, z: f64) -> f64 {
        match self {
            Self::Explicit => 0.0,
            Self::Implicit => 1.0,
            Self::Centred if z < 1e-2 => 0.5 + z / 12.0 - z * z * z / 720.0,
            Self::Centred => -1.0 / elementary::exp_m1(-z) - 1.0 / z,
        }
    }
}

/// Drag of a point, N s/m: of the pores in its volume (m^D), at its volume ratio.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the innermost loops of the step")]
pub fn drag_of_point(soil: &Material, pore_volume: f64, volume_ratio: f64) -> f64 {
    pore_volume * soil.unit_weight_of_water() / soil.hydraulic_conductivity_at(volume_ratio)
}

/// Drag on one component of the water at a node, for one kick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodalDrag {
    /// `D`, N s/m.
    pub coefficient: f64,
    /// `w Δt D`, kg: what a share `w` of the drag at the velocities after a kick of `Δt` adds.
    pub implicit: f64,
}

impl NodalDrag {
    /// The drag for a `kick` in s at a node with the `water_share` `m_w/m_s` and the `water_inertia` `ρ_w V`.
    #[inline]
    pub fn new(level: Drag, kick: f64, coefficient: f64, water_share: f64, water_inertia: f64) -> Self {
        if level == Drag::Explicit {
            return Self { coefficient, implicit: 0.0 };
        }
        let share = level.implicit_share(kick * coefficient * (1.0 + water_share) / water_inertia);
        Self { coefficient, implicit: share * kick * coefficient }
    }

    /// Force on the water, N, at the velocities of skeleton and water before the kick, and with the acceleration of a
    /// skeleton that does not give way.
    #[inline]
    pub fn force(&self, [solid, water]: [f64; 2], skeleton: f64) -> f64 {
        self.implicit * skeleton - self.coefficient * (water - solid)
    }

    /// Inertia of the water, kg, with what drag adds to it: the skeleton gives way by `water_share`.
    #[inline]
    pub fn inertia(&self, water_inertia: f64, water_share: f64) -> f64 {
        water_inertia + self.implicit * (1.0 + water_share)
    }
}

/// Limit, s, of the explicit drag alone (docs/theory.md, Eq. 10):
/// `2 / [(n² γ_w/k)(1/((1−n)ρ_s) + 1/(nρ_w))]`.
pub fn step_limit(soil: &Material) -> f64 {
    let n = soil.porosity;
    let drag = n * drag_of_point(soil, n, 1.0);
    2.0 / (drag * (1.0 / ((1.0 - n) * soil.grain_density) + 1.0 / (n * soil.water_density)))
}

/// Converts the forces on one component of a node to accelerations, for one kick.
#[derive(Clone, Copy, Debug)]
pub struct NodalBalance {
    /// Inverse of the mass of the grains where the skeleton is free, else zero, 1/kg.
    pub per_solid_mass: f64,
    /// `m_w/m_s` where the skeleton is free, else zero.
    pub water_share: f64,
    /// Acceleration of the water over its force, 1/kg; zero where the water is held.
    pub per_water_inertia: f64,
    /// Drag on the water.
    pub drag: NodalDrag,
}

impl NodalBalance {
    /// Accelerations of skeleton and water, m/s², under the forces `f` and `f_w` at velocities of both.
    #[inline]
    pub fn accelerations(&self, mixture_force: f64, water_force: f64, velocity: [f64; 2]) -> [f64; 2] {
        let mixture = mixture_force * self.per_solid_mass;
        let water = self.water_acceleration(water_force, velocity, mixture);
        [mixture - self.water_share * water, water]
    }

    /// Acceleration of the water, m/s², with that of a skeleton that does not give way to it.
    #[inline]
    pub fn water_acceleration(&self, water_force: f64, velocity: [f64; 2], skeleton: f64) -> f64 {
        self.per_water_inertia * (water_force + self.drag.force(velocity, skeleton))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_centred_drag_decays_as_the_exponential() {
        for z in [1e-6, 9e-3, 1.1e-2, 0.3, 4.0, 700.0, 1e9] {
            let share = Drag::Centred.implicit_share(z);
            // r⁺ = r − z ((1 − w) r + w r⁺)
            let decay = (1.0 - z * (1.0 - share)) / (1.0 + z * share);
            assert!((decay - (-z).exp()).abs() < 1e-13, "{z}: {decay}");
            assert!((0.5..=1.0).contains(&share));
        }
    }
}
