//! A motion of the soil that is chosen.

use serde::{Deserialize, Serialize};

/// A motion that is written down: its amplitudes and its frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MotionParameters {
    /// Amplitude `A` of the stretch along x.
    pub amplitude_x: f64,
    /// Amplitude `B` of the stretch along y.
    pub amplitude_y: f64,
    /// Amplitude of a vortex: its largest angle, rad.
    pub amplitude: f64,
    /// Frequency `ω` of `sin²(ωt)`, rad/s; 0 where nothing is made to move.
    pub frequency: f64,
}
