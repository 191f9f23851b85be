//! Mandel's problem: a slab between two rigid plates, drained at its sides.
//!
//! Plane strain, compressible water, a Biot coefficient and grains of finite stiffness where they are given: a slab of half width `a` between rigid,
//! smooth, impermeable plates that take the force `2F` per length at once, drained and without stress
//! at `x = ±a` (Mandel 1953; Cheng & Detournay 1988; docs/theory.md, Eq. 16). The pressure in the middle
//! rises above its start before it falls: the sides drain, soften and leave their load to the core.
//!
//! `sums::early` is the closed form of short times, `sums::series` the sum over the roots of `tan α/α = 1/κ`.

mod sums;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, held_within};
use crate::inputs::{BIOT_KEYS, COLUMN_KEYS, LAW_KEY};
pub use crate::mandel::sums::MandelRatios;
use crate::mandel::sums::{Groups, early, series};
use crate::parameters::ColumnParameters;
use crate::porous_soil::PorousSoil;
use crate::row::{Axis, Row};
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary;

/// The row of the solution.
pub(crate) static MANDEL: Row = Row {
    name: "mandel",
    words: "Mandel's solution with compressible water",
    inputs: &[COLUMN_KEYS, BIOT_KEYS, LAW_KEY, &["width"]],
    axis: Axis::AlongSlab,
    adds_up: true,
    ..Row::COLUMN
};

/// `T = B_1 T_v` from which on a handful of terms of the series is exact to round-off; the closed form
/// leaves out `e^{−1/T}`, 2e-22 there.
const SERIES_FROM: f64 = 0.02;

/// `T` between which the peak in the middle lies, whatever the material.
const PEAK_BETWEEN: [f64; 2] = [1e-3, 1.0];
/// Width in `ln T` to which a flat maximum can be located: somewhat more than the square root of round-off.
const PEAK_WITHIN: f64 = 1e-7;

/// Relative rise above the start that is more than round-off.
const LEAST_RISE: f64 = 1e-9;

/// Mandel's slab. A column's height is the half width `a`, so that the time factor is
/// `T_v = c_v t/a²` with the drained `c_v`; its length is half the distance of the plates, its load the mean
/// stress `F/a` under them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mandel {
    parameters: ColumnParameters,
    soil: PorousSoil,
    groups: Groups,
}

impl Mandel {
    /// The slab of a column's material, with its height as the half width.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let soil = PorousSoil::new(parameters)?;
        let groups = Groups::new(&soil, parameters.soil.poissons_ratio);
        Ok(Self { parameters: *parameters, soil, groups })
    }

    /// The ratios at a relative distance `x/a` from the middle.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or the distance outside [0, 1].
    pub fn ratios(&self, time_factor: f64, distance: f64) -> Result<MandelRatios, ExactError> {
        let time = self.groups.storage_ratio * checked_time_factor(time_factor)?;
        let distance = held_within(distance, 1.0).ok_or(ExactError::Distance(distance))?;
        if time < SERIES_FROM {
            return Ok(early::ratios(&self.groups, time, distance));
        }
        Ok(series::ratios(&self.groups, time, distance))
    }
}

impl Solution for Mandel {
    /// Pressure, effective stress and displacement towards the drained side at the depth `zeta` below it:
    /// `1 − x/a`.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let ratios = self.ratios(time_factor, 1.0 - checked_depth(zeta)?)?;
        let load = self.parameters.load;
        Ok(FieldValues {
            pressure: load * ratios.pressure,
            // No total stress acts towards the drained side: σ'_xx = αp.
            effective_stress: self.soil.alpha * load * ratios.pressure,
            displacement: load * self.parameters.height * ratios.displacement / self.soil.shear,
        })
    }

    /// Inward displacement of each plate, m; half the distance of the plates is the length of the parameters.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(-self.strain_across(time_factor)? * self.parameters.length)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        let strain = 0.5 * (1.0 - self.groups.poissons_ratio);
        Ok(self.parameters.load * strain / self.soil.shear * self.parameters.length)
    }

    /// Terms of the series, or 0 of the closed form, and a bound on what they leave out of any of the
    /// ratios.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let time = self.groups.storage_ratio * checked_time_factor(time_factor)?;
        if time < SERIES_FROM {
            return Ok(Accuracy::new(0, early::bound(&self.groups, time)));
        }
        let terms = series::terms(time);
        Ok(Accuracy::new(terms, series::bound(time, terms)))
    }

    /// Strain `ε_yy` across the plates, compression negative: the same everywhere.
    fn strain_across(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(-self.parameters.load * self.ratios(time_factor, 0.0)?.strain / self.soil.shear)
    }

    /// Time factor `T_v` and height `p a/F` of the highest pressure in the middle (Mandel 1953; Cryer 1963). `None` if the
    /// pressure never rises: for a skeleton of constant volume, or water that carries no load.
    fn pressure_peak(&self) -> Option<(f64, f64)> {
        let height = |time: f64| {
            let ratios = if time < SERIES_FROM { early::ratios } else { series::ratios };
            ratios(&self.groups, time, 0.0).pressure
        };
        // One peak between the diffusion's first touch of the middle and its end: the golden section of ln T.
        let [mut low, mut high] = PEAK_BETWEEN.map(elementary::ln);
        let share = 0.5 * (5.0_f64.sqrt() - 1.0);
        while high - low > PEAK_WITHIN {
            let step = share * (high - low);
            if height(elementary::exp(high - step)) < height(elementary::exp(low + step)) {
                low = high - step;
            } else {
                high = low + step;
            }
        }
        let time = elementary::exp(0.5 * (low + high));
        (height(time) > self.groups.start * (1.0 + LEAST_RISE))
            .then(|| (time / self.groups.storage_ratio, height(time)))
    }
}

#[cfg(test)]
mod tests;
