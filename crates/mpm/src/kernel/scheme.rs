//! Scheme of the explicit step in time: the paper's forward Euler, or a leapfrog of second order.
//!
//! Both kick the velocities with the forces of the present stresses, and let the stresses drift with
//! the new velocities. Forward Euler gives both the whole step: its velocities lag by half a step
//! behind the stresses, and everything that waves is of first order in the step. The leapfrog knows
//! that velocities live half a step off, and begins with half a kick (Verlet 1967; Hairer, Lubich &
//! Wanner 2003): second order for the same work. The drag must then be centred too.

use crate::drag::Drag;
use oedometer_soil::wording::words;
use serde::{Deserialize, Serialize};

/// Time levels of velocities and stresses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Zheng et al.: velocities and stresses at the same times.
    #[default]
    ForwardEuler,
    /// Velocities in the middle between the times of the stresses.
    Leapfrog,
}

words!(Scheme: ForwardEuler "forward-euler", Leapfrog "leapfrog");

impl Scheme {
    /// Whether this is the paper's; records of it say nothing of the scheme.
    pub fn is_paper(&self) -> bool {
        *self == Self::ForwardEuler
    }
}

/// Choices of the explicit integrator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExplicitSettings {
    /// Time levels of velocities and stresses.
    #[serde(default, skip_serializing_if = "Scheme::is_paper")]
    pub scheme: Scheme,
    /// Time level of the drag.
    pub drag: Drag,
    /// Share of the acceleration update (FLIP) in the points' velocities; the rest is
    /// interpolated from the nodes (PIC).
    pub flip: f64,
    /// Whether the stresses see velocities mapped back from the updated points (the paper's
    /// step 5) instead of the nodal velocities of step 3.
    pub mapping_back: bool,
    /// Whether points that move bring the slopes of their velocities to the nodes (APIC's, with FLIP's increments).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub affine: bool,
    /// Whether stresses slope over the domains of points that move, by the planes through neighbouring cells.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stress_slopes: bool,
}

impl Default for ExplicitSettings {
    /// The paper's: forward Euler, explicit drag, pure FLIP, mapping back.
    fn default() -> Self {
        Self {
            scheme: Scheme::ForwardEuler,
            drag: Drag::Explicit,
            flip: 1.0,
            mapping_back: true,
            affine: false,
            stress_slopes: false,
        }
    }
}

/// Durations of the kicks of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rhythm {
    /// Last drift, s; 0 before the first.
    drift: f64,
}

impl Rhythm {
    /// Duration of the kick, s, before a drift of `dt` seconds: from the middle of the last drift to
    /// the middle of this one.
    pub fn kick(&mut self, dt: f64, settings: &ExplicitSettings) -> f64 {
        let last = std::mem::replace(&mut self.drift, dt);
        match settings.scheme {
            Scheme::ForwardEuler => dt,
            Scheme::Leapfrog => 0.5 * (last + dt),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leapfrog_kicks_from_middle_to_middle() {
        let settings = ExplicitSettings { scheme: Scheme::Leapfrog, ..ExplicitSettings::default() };
        let mut rhythm = Rhythm::default();
        let kicks = [0.4, 0.4, 0.2].map(|dt| rhythm.kick(dt, &settings));
        assert_eq!(kicks, [0.2, 0.4, 0.5 * (0.4 + 0.2)]);
        let mut rhythm = Rhythm::default();
        assert_eq!(rhythm.kick(0.4, &ExplicitSettings::default()), 0.4);
    }
}
