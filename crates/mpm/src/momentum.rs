//! The balances of momentum, lumped at the nodes, per component: of the water (docs/theory.md, Eq. 1; Zheng et al.
//! Eq. 1) and of the mixture (Eq. 2).
//!
//! ```text
//! ρ_w V a_w         = f_w − D (v_w − v_s)
//! m_s a_s + m_w a_w = f
//! ```
//!
//! with the force `f` on the mixture and `f_w` of the pressure gradient on the water. The point-wise step, the assembled
//! one and implicit stages all take their accelerations from here.

use crate::drag::NodalDrag;

/// What turns the forces on one component of a node into accelerations, for one kick.
#[derive(Clone, Copy, Debug)]
pub struct NodalBalance {
    /// One over the mass of the grains where the skeleton is free, else zero, 1/kg.
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
