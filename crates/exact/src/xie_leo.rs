//! Large-strain consolidation in closed form.

use crate::consolidation::{consolidated_below, isochrone};
use crate::exact_error::{ExactError, positive};
use crate::inputs::{COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WEIGHT_KEY};
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary;

/// The row of the solution.
pub(crate) static XIE_LEO: Row = Row {
    name: "xie-leo",
    words: "Xie & Leo's solution",
    inputs: &[COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WEIGHT_KEY, &["porosity", "continuity", "loading_time"]],
    ..Row::COLUMN
};

/// Xie & Leo (2004): consolidation at large strain of a soil with constant
/// `m_vl = −(1/(1 + e)) de/dσ'` and `k = k_0 J²`, incompressible water.
///
/// With `m = m_vl q` the volume ratio obeys a linear diffusion equation,
///
/// ```text
/// J = e^{−m} + (1 − e^{−m}) W(ζ, T_v)
/// p = (1/m_vl) ln{1 + (e^m − 1) W(ζ, T_v)}
/// s = H (1 − e^{−m}) U(T_v)
/// ```
///
/// at the Lagrangian depth `ζ`. The effective stress is Cauchy's, `σ' = p − q`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct XieLeo {
    parameters: ColumnParameters,
    /// `m = m_vl q`.
    strain: f64,
}

impl XieLeo {
    /// The column drained at its top alone.
    ///
    /// # Errors
    /// When the parameters are impossible, the load grows, or `m_vl q ≥ −ln(1 − n_0)`: the porosity
    /// `n = 1 − (1 − n_0)/J` would end below zero.
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let strain = positive(
            "load over the oedometric modulus",
            parameters.load / parameters.soil.oedometric_modulus(),
        )?;
        let limit = -elementary::ln_1p(-parameters.soil.porosity);
        if strain >= limit {
            return Err(ExactError::LoadClosesPores {
                load: strain,
                limit,
                porosity: parameters.soil.porosity,
            });
        }
        if parameters.loading_time > 0.0 {
            return Err(ExactError::LoadGrows { loading_time: parameters.loading_time });
        }
        if !parameters.soils.is_empty() {
            return Err(ExactError::Layers("has no closed form at large strain: ask for `large-strain`"));
        }
        Ok(Self { parameters: *parameters, strain })
    }

    /// Final settlement over the height, `1 − e^{−m}`.
    pub fn final_strain(&self) -> f64 {
        -elementary::exp_m1(-self.strain)
    }

    /// Volume ratio `J` at a relative depth.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn volume_ratio(&self, time_factor: f64, zeta: f64) -> Result<f64, ExactError> {
        let isochrone = isochrone(zeta, time_factor)?.value;
        Ok(1.0 - self.final_strain() * (1.0 - isochrone))
    }

    /// Excess pore pressure at a relative depth, Pa.
    fn pressure(&self, time_factor: f64, zeta: f64) -> Result<f64, ExactError> {
        let isochrone = isochrone(zeta, time_factor)?.value;
        let pressure = elementary::ln_1p(elementary::exp_m1(self.strain) * isochrone);
        Ok(self.parameters.load * (pressure / self.strain))
    }
}

impl Solution for XieLeo {
    /// Pressure, effective (Cauchy) stress and displacement at a relative depth.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let pressure = self.pressure(time_factor, zeta)?;
        let compressed = consolidated_below(zeta, time_factor)?.value;
        Ok(FieldValues {
            pressure,
            effective_stress: pressure - self.parameters.load,
            displacement: -self.parameters.height * self.final_strain() * compressed,
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.final_settlement()? * consolidated_below(0.0, time_factor)?.value)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.parameters.height * self.final_strain())
    }

    /// Terms and tail of the pressure, the worst over the depth.
    /// At the end, at the surface.
    fn least_porosity(&self) -> Option<f64> {
        Some(1.0 - (1.0 - self.parameters.soil.porosity) * elementary::exp(self.strain))
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let base = isochrone(1.0, time_factor)?;
        // |∂p/∂W| ≤ (e^m − 1)/m_vl, reached at the drained surface.
        let slope = elementary::exp_m1(self.strain) / self.strain;
        Ok(Accuracy::new(base.terms, slope * base.tail_bound))
    }
}

#[cfg(test)]
mod tests;
