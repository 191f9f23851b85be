//! Sines and cosines of many modes at one depth.

use core::f64::consts::PI;

use crate::consolidation::sine_series::eigenvalue;
use oedometer_soil::elementary;

/// Modes whose waves are made from those of the first of them.
pub(crate) const BLOCK: usize = 16;

/// `sin(M_j y/H)` and `cos(M_j y/H)` at a depth, with `M_j = (2j + 1) π/2`, mode by mode in blocks.
///
/// The waves of the first mode of a block are taken as they are, the others by the theorem of addition: one rotation
/// each, whose rounding does not grow from block to block.
#[derive(Clone, Debug)]
pub(crate) struct Waves {
    /// Relative depth and height.
    zeta: f64,
    above_base: f64,
    /// Sines and cosines of `k π y/H`, `k` the place in a block.
    steps: [[f64; BLOCK]; 2],
}

impl Waves {
    /// At a relative depth.
    pub(crate) fn at(zeta: f64) -> Self {
        let above_base = 1.0 - zeta;
        let mut steps = [[0.0; BLOCK]; 2];
        for place in 0..BLOCK {
            let (sine, cosine) = elementary::sincos(PI * place as f64 * above_base);
            (steps[0][place], steps[1][place]) = (sine, cosine);
        }
        Self { zeta, above_base, steps }
    }

    /// Sines and cosines of the modes of a block from its first, `[place in the block]`.
    pub(crate) fn of_block(&self, first: usize) -> [[f64; BLOCK]; 2] {
        let mut waves = [[0.0; BLOCK]; 2];
        if self.zeta == 0.0 || self.above_base == 0.0 {
            // cos(M_j y/H) = ± sin(M_j ζ): both vanish exactly where they do.
            for place in 0..BLOCK {
                let mode = first + place;
                let sign = if mode.is_multiple_of(2) { 1.0 } else { -1.0 };
                waves[0][place] = elementary::sin(eigenvalue(mode) * self.above_base);
                waves[1][place] = sign * elementary::sin(eigenvalue(mode) * self.zeta);
            }
            return waves;
        }
        let (sine, cosine) = elementary::sincos(eigenvalue(first) * self.above_base);
        let [step_sines, step_cosines] = &self.steps;
        for place in 0..BLOCK {
            waves[0][place] = sine * step_cosines[place] + cosine * step_sines[place];
            waves[1][place] = cosine * step_cosines[place] - sine * step_sines[place];
        }
        waves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_of_a_block_are_those_of_its_modes() {
        for zeta in [0.0, 1e-3, 0.25, 0.7, 1.0] {
            let waves = Waves::at(zeta);
            for first in [0, BLOCK, 250 * BLOCK] {
                let [sines, cosines] = waves.of_block(first);
                for place in 0..BLOCK {
                    let angle = eigenvalue(first + place) * (1.0 - zeta);
                    // An angle is known to its round-off only.
                    let round_off = 1e-15 + 4e-16 * angle;
                    assert!((sines[place] - angle.sin()).abs() < round_off, "{zeta}, {first}, {place}");
                    assert!((cosines[place] - angle.cos()).abs() < round_off, "{zeta}, {first}, {place}");
                }
            }
        }
        let [surface, base] = [Waves::at(0.0), Waves::at(1.0)].map(|waves| waves.of_block(7 * BLOCK));
        assert!(
            surface[1].iter().chain(&base[0]).all(|wave| *wave == 0.0),
            "without round-off where they vanish"
        );
    }
}
