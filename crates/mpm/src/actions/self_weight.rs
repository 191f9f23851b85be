//! Weight of skeleton and water under a free water level.

use crate::state::points::Points;

/// Weight of skeleton and water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfWeight {
    /// Gravity, m/s².
    pub gravity: f64,
    /// Height of the free water level, m: that of the surface at the start.
    pub level: f64,
    /// Rise of the surface within a step that has not moved its points yet, m.
    pub rise: f64,
}

impl SelfWeight {
    /// The self-weight of points; the water level is at the top of the highest domains.
    pub fn new<const D: usize>(gravity: f64, points: &Points<D>) -> Self {
        let top = |point: usize| points.initial_position[point][D - 1] + points.half_length[point][D - 1];
        let level = (0..points.len()).map(top).fold(f64::NEG_INFINITY, f64::max);
        Self { gravity, level, rise: 0.0 }
    }
}
