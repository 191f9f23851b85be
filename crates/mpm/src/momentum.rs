//! The balances of momentum, lumped at the nodes, per component: of the water (docs/theory.md, Eq. 1; Zheng et al.
//! Eq. 1) and of the mixture (Eq. 2).
//!
//! ```text
//! ρ_w V a_w         = f_w − D (v_w − v_s)          D = n γ_w V/k
//! m_s a_s + m_w a_w = f
//! ```
//!
//! with the force `f` on the mixture and `f_w` of the pressure gradient on the water. A share `w` of the drag at
//! the velocities after a kick of `Δt` adds `w Δt D (a_s − a_w)` to the water's. The point-wise step, the assembled
//! one and implicit stages all take their accelerations from here.

use crate::explicit::scheme::Drag;

/// What turns the forces on one component of a node into accelerations, for one kick.
#[derive(Clone, Copy, Debug)]
pub struct NodalBalance {
    /// One over the mass of the grains where the skeleton is free, else zero, 1/kg.
    pub per_solid_mass: f64,
    /// `m_w/m_s` where the skeleton is free, else zero.
    pub water_share: f64,
    /// Acceleration of the water over its force, 1/kg.
    pub per_water_inertia: f64,
    /// `D`, N s/m.
    pub drag: f64,
    /// `w Δt D`, kg.
    pub implicit_drag: f64,
}

impl NodalBalance {
    /// Accelerations of skeleton and water, m/s², under the forces `f` and `f_w` at velocities of both.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn accelerations(&self, mixture_force: f64, water_force: f64, velocity: [f64; 2]) -> [f64; 2] {
        let mixture = mixture_force * self.per_solid_mass;
        let water = self.water_acceleration(water_force, velocity, mixture);
        [mixture - self.water_share * water, water]
    }

    /// Acceleration of the water, m/s², where the skeleton's is given but for what the water takes of it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the step's innermost loop; a call costs more than its body")]
    pub fn water_acceleration(&self, water_force: f64, [solid, water]: [f64; 2], skeleton: f64) -> f64 {
        let force = water_force - self.drag * (water - solid) + self.implicit_drag * skeleton;
        self.per_water_inertia * force
    }
}

/// `w Δt D`, kg, for a kick of so many seconds, at a node with `m_w/m_s` and `ρ_w V`.
#[inline]
pub fn implicit_drag(level: Drag, kick: f64, drag: f64, water_share: f64, water_inertia: f64) -> f64 {
    level.implicit_weight(|| kick * drag * (1.0 + water_share) / water_inertia) * kick * drag
}

/// Acceleration of the water over its force, 1/kg: the skeleton gives way by `water_share`, the water where it
/// is free.
#[inline]
pub fn per_water_inertia(water_inertia: f64, implicit_drag: f64, water_share: f64, water_free: f64) -> f64 {
    water_free / (water_inertia + implicit_drag * (1.0 + water_share))
}
