//! Seabed under a wave: its pressure acts on the soil and on the pore water.

use core::f64::consts::PI;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, positive};
use crate::inputs::{BIOT_KEYS, COLUMN_KEYS};
use crate::parameters::ColumnParameters;
use crate::porous_soil::PorousSoil;
use crate::solution::{Accuracy, FieldValues, Solution};
use nalgebra::Complex;
use oedometer_soil::elementary::{self, exp_complex, exp_m1_complex};

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, BIOT_KEYS, &["period"]];

/// Column of the depth `H` on an impermeable base under `q cos ωt` of total stress and pore pressure, long after its
/// start: the bed under a wave much longer than it is deep (Verruijt 1982; Madsen 1978 and Yamamoto et al. 1978
/// for a wave number of zero).
///
/// With `B = α/(E_oed S)` and `m² = iωH²/c`,
///
/// ```text
/// p/q = Re{[B + (1 − B) cosh(my/H)/cosh m] e^{iωt}}
/// u   = −m_v q Re{[y (1 − αB) − α(1 − B) H sinh(my/H)/(m cosh m)] e^{iωt}}
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seabed {
    load: f64,
    final_settlement: f64,
    soil: PorousSoil,
    /// `m`.
    number: Complex<f64>,
    /// Periods per unit of the time factor.
    periods: f64,
}

impl Seabed {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let soil = PorousSoil::new(parameters)?;
        let periods = parameters.time(1.0) / positive("period of the wave", parameters.textbook.wave_period)?;
        let squared = positive("square of the wave number", 2.0 * PI * periods / soil.diffusivity_ratio())?;
        Ok(Self {
            load: parameters.load,
            final_settlement: parameters.final_settlement(),
            soil,
            // √i = (1 + i)/√2.
            number: Complex::new(1.0, 1.0) * (0.5 * squared).sqrt(),
            periods,
        })
    }

    /// `e^{iωt}`, the phase of whole periods left out.
    fn turned(&self, time_factor: f64) -> Result<Complex<f64>, ExactError> {
        let periods = self.periods * checked_time_factor(time_factor)?;
        let (sine, cosine) = elementary::sincos(2.0 * PI * (periods - periods.floor()));
        Ok(Complex::new(cosine, sine))
    }

    /// Settlement of the part below a height over the base, `y/H`, over `m_v q H`.
    fn compressed(&self, turned: Complex<f64>, height: f64) -> f64 {
        let PorousSoil { alpha, fixed_storage, storage, .. } = self.soil;
        let ended = Complex::new(1.0, 0.0) + exp_complex(-2.0 * self.number);
        let wave = -exp_m1_complex(-2.0 * height * self.number) / (ended * self.number);
        let drained = exp_complex(-(1.0 - height) * self.number) * wave;
        ((Complex::new(fixed_storage / storage * height, 0.0) - drained * self.drainable() * alpha) * turned)
            .re
    }

    /// `1 − B`.
    fn drainable(&self) -> f64 {
        1.0 - self.soil.alpha * self.soil.diffusivity_ratio()
    }
}

impl Solution for Seabed {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let (turned, height) = (self.turned(time_factor)?, 1.0 - checked_depth(zeta)?);
        let unit = Complex::new(1.0, 0.0);
        let ended = unit + exp_complex(-2.0 * self.number);
        let wave = (unit + exp_complex(-2.0 * height * self.number)) / ended;
        let drained = exp_complex(-(1.0 - height) * self.number) * wave;
        let start = self.soil.alpha * self.soil.diffusivity_ratio();
        let ratio = ((drained * self.drainable() + start) * turned).re;
        Ok(FieldValues {
            pressure: self.load * ratio,
            effective_stress: self.load * (self.soil.alpha * ratio - turned.re),
            displacement: -self.final_settlement * self.compressed(turned, height),
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.final_settlement * self.compressed(self.turned(time_factor)?, 1.0))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.final_settlement)
    }

    fn has_degree(&self) -> bool {
        false
    }

    /// Closed form; a phase after many periods has lost their digits.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let phase = 2.0 * PI * self.periods * checked_time_factor(time_factor)?;
        Ok(Accuracy { phase_bound: 4.0 * f64::EPSILON * phase, ..Accuracy::new(1, 0.0) })
    }
}
