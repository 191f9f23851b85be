//! Truncation of the modal sum with its bound, and the waves of the modes at a depth.

use crate::consolidation::eigenvalue;
use crate::dynamic_column::column::{DynamicColumn, Start};
use crate::dynamic_column::modes::{Amplitude, Drive, Growth, InitialState, Mode, ModeState};
use core::f64::consts::PI;
use oedometer_soil::elementary;

/// Most modes that are summed; a front that is still sharp beyond them shows in the bound on the tail.
const MOST_MODES: usize = 4096;
/// Modes below this share of the load are left out.
const RELATIVE_TAIL: f64 = 1e-18;
/// Modes whose waves are made from those of the first of them.
pub(super) const BLOCK: usize = 16;

impl DynamicColumn {
    /// Wave number `M_j/H`, 1/m.
    pub(super) fn wave_number(&self, mode: usize) -> f64 {
        eigenvalue(mode) / self.parameters.height
    }

    /// Drive of a mode: the whole load's force on `sin(M_j y/H)`, or the state it is let go from.
    pub(super) fn drive(&self, mode: usize) -> Drive {
        // −q m² b, with y = Σ b_j sin(m_j y).
        let sign = if mode.is_multiple_of(2) { -2.0 } else { 2.0 };
        let force = sign * self.parameters.load / self.parameters.height;
        match self.start {
            Start::Step | Start::Ramp { .. } => Drive::Step { force },
            Start::Mode | Start::StandingWave => Drive::Release(self.released()),
        }
    }

    /// Coefficients of the slowest mode where the column is let go.
    pub(super) fn released(&self) -> InitialState {
        let column = &self.parameters;
        let wave_number = self.wave_number(0);
        if self.start == Start::StandingWave {
            let together = -column.load / (column.soil.coupling_modulus() * wave_number);
            return InitialState { displacement: [together; 2], velocity: [0.0; 2] };
        }
        let solid = column.load / (column.soil.oedometric_modulus() * wave_number);
        let mixture = -column.load / (column.soil.coupling_modulus() * wave_number);
        let discharge = wave_number * column.soil.hydraulic_conductivity * column.load
            / column.soil.unit_weight_of_water();
        let solid_velocity = -column.storage_ratio() * discharge;
        InitialState {
            displacement: [solid, (mixture - (1.0 - column.soil.porosity) * solid) / column.soil.porosity],
            velocity: [solid_velocity, solid_velocity + discharge / column.soil.porosity],
        }
    }

    /// Coefficients of one mode at a time in s.
    fn amplitude(&self, mode: usize, time: f64) -> Amplitude {
        let oscillator = Mode::new(&self.parameters, self.wave_number(mode));
        match self.start {
            Start::Ramp { duration } => self.growing_amplitude(&oscillator, mode, duration, time),
            _ => oscillator.amplitude(self.drive(mode), Growth::None, time),
        }
    }

    /// Sums as many modes as matter at a time factor.
    pub(super) fn snapshot(&self, time_factor: f64) -> ModeState {
        let time = self.parameters.time(time_factor);
        let mut snapshot = ModeState { time_factor, amplitudes: Vec::new(), tail: 0.0 };
        if self.start.is_release() {
            snapshot.amplitudes.push(self.amplitude(0, time));
            return snapshot;
        }
        if time_factor == 0.0 {
            return snapshot;
        }
        let negligible = RELATIVE_TAIL * self.parameters.load;
        for mode in 0..MOST_MODES {
            let amplitude = self.amplitude(mode, time);
            snapshot.amplitudes.push(amplitude);
            // Even where only the waves' 1/M is left of the decay, the tail is about this.
            snapshot.tail = amplitude.envelope * (mode as f64 + 1.0);
            if snapshot.tail <= negligible {
                break;
            }
        }
        snapshot.tail += self.sharp_front(snapshot.amplitudes.len(), time);
        snapshot
    }

    /// Bound on the contribution of very high modes, Pa, whose attenuation no longer grows with the frequency.
    fn sharp_front(&self, modes: usize, time: f64) -> f64 {
        let far = 1_000_000;
        let front = self.amplitude(far, time).envelope * far as f64;
        match self.start {
            Start::Ramp { .. } => front * far as f64 / modes as f64,
            Start::Step | Start::Mode | Start::StandingWave => front,
        }
    }
}

/// `sin(M_j y/H)` and `cos(M_j y/H)` at a depth, with `M_j = (2j + 1) π/2`, mode by mode in blocks.
///
/// The waves of the first mode of a block are taken as they are, the others by the theorem of addition: one rotation
/// each, whose rounding does not grow from block to block.
#[derive(Clone, Debug)]
pub(super) struct Waves {
    /// Relative depth and height.
    zeta: f64,
    above_base: f64,
    /// Sines and cosines of `k π y/H`, `k` the place in a block.
    steps: [[f64; BLOCK]; 2],
}

impl Waves {
    /// The waves at a relative depth.
    pub(super) fn at(zeta: f64) -> Self {
        let above_base = 1.0 - zeta;
        let mut steps = [[0.0; BLOCK]; 2];
        for place in 0..BLOCK {
            let (sine, cosine) = elementary::sincos(PI * place as f64 * above_base);
            (steps[0][place], steps[1][place]) = (sine, cosine);
        }
        Self { zeta, above_base, steps }
    }

    /// Sines and cosines of the modes of a block from its first, `[place in the block]`.
    pub(super) fn of_block(&self, first: usize) -> [[f64; BLOCK]; 2] {
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
