//! Choices of the explicit integrator: its scheme in time, its drag, and what points bring to the nodes.
//!
//! Both schemes kick the velocities with the forces of the present stresses, and let the stresses drift with
//! the new velocities. Forward Euler gives both the whole step: its velocities lag by half a step
//! behind the stresses, and everything that waves is of first order in the step. The leapfrog knows
//! that velocities live half a step off, and begins with half a kick (Verlet 1967; Hairer, Lubich &
//! Wanner 2003): second order for the same work. The drag must then be centred too.

use oedometer_soil::elementary;
use oedometer_wording::{is_default, words};
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

/// Choices of the explicit integrator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ExplicitSettings {
    /// Time levels of velocities and stresses.
    #[serde(default, skip_serializing_if = "is_default")]
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
    pub fn implicit_share(self, z: f64) -> f64 {
        match self {
            Self::Explicit => 0.0,
            Self::Implicit => 1.0,
            Self::Centred if z < 1e-2 => 0.5 + z / 12.0 - z * z * z / 720.0,
            Self::Centred => -1.0 / elementary::exp_m1(-z) - 1.0 / z,
        }
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
