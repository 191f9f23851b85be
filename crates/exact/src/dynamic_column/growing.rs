//! The column under a growing load: Terzaghi's pressures plus modes.
//!
//! Steady growth builds up pressures that may be a million times the load, and never comes about: as
//! a departure from it the sum of the modes would cancel as many digits. The diffusion of storage alone
//! has the same steady state and closed forms in which nothing cancels, and a mode departs from it
//! by what inertia adds, which is small and soon gone.

use oedometer_soil::elementary;

use crate::consolidation;
use crate::consolidation::eigenvalue;
use crate::consolidation::series::elapsed;
use crate::dynamic_column::column::{DynamicColumn, Steady};
use crate::dynamic_column::modes::{Amplitude, Growth, Mode};
use crate::exact_error::ExactError;

/// Whether a load that has grown over `duration` is so long past that the modes alone converge.
pub fn is_past(duration: f64, time: f64) -> bool {
    time >= 2.0 * duration
}

impl DynamicColumn {
    /// Time factor `B T_v` of the diffusion that the water's storage slows.
    fn diffused(&self, time: f64) -> f64 {
        self.parameters.storage_ratio() * self.parameters.time_factor(time)
    }

    /// Coefficients of one mode at a time in s, of a load that grows over `duration`.
    pub(super) fn growing_amplitude(
        &self,
        oscillator: &Mode,
        mode: usize,
        duration: f64,
        time: f64,
    ) -> Amplitude {
        if is_past(duration, time) {
            return oscillator.amplitude(self.drive(mode), Growth::Over { duration }, time - duration);
        }
        let mut amplitude = self.beyond_diffusion(oscillator, mode, duration, time);
        if time > duration {
            let since = self.beyond_diffusion(oscillator, mode, duration, time - duration);
            amplitude.solid -= since.solid;
            amplitude.mixture -= since.mixture;
            amplitude.solid_rate -= since.solid_rate;
            amplitude.mixture_rate -= since.mixture_rate;
            amplitude.envelope += since.envelope;
            amplitude.phase_error += since.phase_error;
        }
        amplitude
    }

    /// What a mode of the steadily growing load has beyond diffusion.
    fn beyond_diffusion(&self, oscillator: &Mode, mode: usize, duration: f64, time: f64) -> Amplitude {
        let column = &self.parameters;
        let m = eigenvalue(mode);
        // Both from the same side: they share the steady state, which cancels exactly.
        let is_early = oscillator.slowest() * time < 1.0;
        let growth = if is_early { Growth::FromStart { duration } } else { Growth::ToSteady { duration } };
        let mut amplitude = oscillator.amplitude(self.drive(mode), growth, time);

        let exponent = m * m * self.diffused(time);
        let decay = elementary::exp(-exponent);
        let grown = if is_early { -elementary::exp_m1(-exponent) } else { -decay };
        let sign = if mode.is_multiple_of(2) { 1.0 } else { -1.0 };
        let steady = sign * 2.0 / (m * m * m) * self.steady_pressure(duration) / self.wave_number(mode);
        let rate = m * m * self.diffused(1.0) * decay;
        let (solid, mixture) =
            (steady / column.soil.oedometric_modulus(), -steady / column.soil.coupling_modulus());
        amplitude.solid -= solid * grown;
        amplitude.mixture -= mixture * grown;
        amplitude.solid_rate -= solid * rate;
        amplitude.mixture_rate -= mixture * rate;
        if is_early {
            // The roots' parts share their steady state with the diffusion: what is left counts.
            let waves = oscillator.amplitude(self.drive(mode), Growth::ToSteady { duration }, time);
            let left = oscillator.size(amplitude.solid, amplitude.mixture);
            amplitude.envelope = left + waves.rest;
        } else {
            amplitude.envelope += oscillator.size(solid * grown, mixture * grown);
        }
        amplitude
    }

    /// Twice the pressure at the base, Pa, that steady growth would end with.
    fn steady_pressure(&self, duration: f64) -> f64 {
        self.parameters.load * self.parameters.storage_ratio() / self.diffused(duration)
    }

    /// The state that the modes of a growing load depart from, at a time in s and a relative depth.
    ///
    /// # Errors
    /// When the time or the depth is impossible.
    pub(super) fn diffusion(&self, duration: f64, time: f64, zeta: f64) -> Result<Steady, ExactError> {
        let column = &self.parameters;
        let strain = -column.load / column.soil.oedometric_modulus();
        let y = column.height * (1.0 - zeta);
        let mut state = Steady { solid: strain * y, solid_strain: strain, ..Steady::default() };
        if is_past(duration, time) {
            return Ok(state);
        }
        let scale = self.steady_pressure(duration);
        let mut impulse = 0.0;
        let mut impulse_rate = 0.0;
        let mut add = |time: f64, sign: f64| -> Result<(), ExactError> {
            let reached = self.diffused(time);
            state.pressure += sign * scale * elapsed::isochrone(zeta, reached);
            impulse += sign * scale * elapsed::isochrone_integral(zeta, reached);
            impulse_rate += sign * scale * consolidation::isochrone_integral(zeta, reached)?.value;
            Ok(())
        };
        add(time, 1.0)?;
        if time > duration {
            add(time - duration, -1.0)?;
        } else {
            let share = time / duration;
            state.solid *= share;
            state.solid_strain *= share;
            state.solid_rate = strain * y / duration;
        }
        let (impulse, impulse_rate) =
            (impulse * column.height, impulse_rate * column.height * self.diffused(1.0));
        state.solid += impulse / column.soil.oedometric_modulus();
        state.mixture -= impulse / column.soil.coupling_modulus();
        state.solid_rate += impulse_rate / column.soil.oedometric_modulus();
        state.mixture_rate -= impulse_rate / column.soil.coupling_modulus();
        state.solid_strain += state.pressure / column.soil.oedometric_modulus();
        Ok(state)
    }
}
