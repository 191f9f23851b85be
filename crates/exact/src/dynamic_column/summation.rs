//! How many modes are summed, and what the others may add.

use crate::consolidation::sine_series::eigenvalue;
use crate::dynamic_column::modes::{Amplitude, Drive, Growth, InitialState, Mode, ModeState};
use crate::dynamic_column::{DynamicColumn, Start};

/// More modes are not summed: beyond, a wave front is still sharp and the sum's tail says so.
const MOST_MODES: usize = 4096;
/// Modes below this share of the load are left out.
const RELATIVE_TAIL: f64 = 1e-18;

impl DynamicColumn {
    /// Wave number `M_j/H`, 1/m.
    pub(crate) fn wave_number(&self, mode: usize) -> f64 {
        eigenvalue(mode) / self.parameters.height
    }

    /// Drive of a mode: the whole load's force on `sin(M_j y/H)`, or the state it is let go from.
    pub(crate) fn drive(&self, mode: usize) -> Drive {
        // −q m² b, with y = Σ b_j sin(m_j y).
        let sign = if mode.is_multiple_of(2) { -2.0 } else { 2.0 };
        let force = sign * self.parameters.load / self.parameters.height;
        match self.start {
            Start::Step | Start::Ramp { .. } => Drive::Step { force },
            Start::Mode | Start::StandingWave => Drive::Release(self.released()),
        }
    }

    /// Coefficients of the slowest mode where the column is let go.
    pub(crate) fn released(&self) -> InitialState {
        let column = &self.parameters;
        let wave_number = self.wave_number(0);
        if self.start == Start::StandingWave {
            let together = -column.load / (column.coupling_modulus() * wave_number);
            return InitialState { displacement: [together; 2], velocity: [0.0; 2] };
        }
        let solid = column.load / (column.oedometric_modulus() * wave_number);
        let mixture = -column.load / (column.coupling_modulus() * wave_number);
        let discharge =
            wave_number * column.hydraulic_conductivity * column.load / column.unit_weight_of_water();
        let solid_velocity = -column.storage_ratio() * discharge;
        InitialState {
            displacement: [solid, (mixture - (1.0 - column.porosity) * solid) / column.porosity],
            velocity: [solid_velocity, solid_velocity + discharge / column.porosity],
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
    pub(crate) fn snapshot(&self, time_factor: f64) -> ModeState {
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

    /// What very high modes may add, Pa: their attenuation no longer grows with the frequency.
    fn sharp_front(&self, modes: usize, time: f64) -> f64 {
        let far = 1_000_000;
        let front = self.amplitude(far, time).envelope * far as f64;
        match self.start {
            Start::Ramp { .. } => front * far as f64 / modes as f64,
            Start::Step | Start::Mode | Start::StandingWave => front,
        }
    }
}
