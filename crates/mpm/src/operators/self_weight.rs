//! The weight of skeleton and water, under a water level that stands where the surface was at the start.
//!
//! Points then carry total pressures. The hydrostatic one, `ρ_w g (H − y)` at the present height `y`, is not
//! taken out of the balances: forces of weight and of pressure meet at every node, and only what is sampled is
//! the excess. Pore water that leaves does not raise the free level, for over an impermeable base the mixture
//! does not move, `(1 − n) v_s + n v_w = 0`: a surface that has settled lies under the free water of that depth,
//! which presses on mixture and pore water alike. Where nothing deforms, the surface stays in the level.

use crate::state::points::Points;

/// Weight of skeleton and water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfWeight {
    /// Gravity, m/s².
    pub gravity: f64,
    /// Height of the free water level, m: that of the surface at the start.
    pub level: f64,
    /// What the surface has risen within a step whose points do not move yet, m.
    pub rise: f64,
}

impl SelfWeight {
    /// The weight of points whose highest domains end at the water level.
    pub fn of<const D: usize>(gravity: f64, points: &Points<D>) -> Self {
        let top = |point: usize| points.initial_position[point][D - 1] + points.half_length[point][D - 1];
        let level = (0..points.len()).map(top).fold(f64::NEG_INFINITY, f64::max);
        Self { gravity, level, rise: 0.0 }
    }
}
