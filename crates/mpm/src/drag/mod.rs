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

use oedometer_problem::settings::Drag;

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
