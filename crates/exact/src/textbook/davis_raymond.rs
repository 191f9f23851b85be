//! Nonlinear consolidation of a soil whose coefficient of consolidation stays.

use crate::consolidation::{consolidated_below, isochrone};
use crate::exact_error::{ExactError, normal, positive};
use crate::inputs::COLUMN_KEYS;
use crate::parameters::ColumnParameters;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary;

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, &["initial_stress"]];

/// Column of a soil that compresses with the logarithm of its effective stress, and whose permeability falls with its
/// compressibility (Davis & Raymond 1965). Small strain, no weight, incompressible water.
///
/// With `σ'_0` before the load, `σ'_f = σ'_0 + q` after it, and `E_oed` the modulus at `σ'_0`,
///
/// ```text
/// σ' = σ'_f (σ'_0/σ'_f)^W     p = σ'_f − σ'     s = H (σ'_0/E_oed) ln(σ'_f/σ'_0) U
/// ```
///
/// with Terzaghi's `W(ζ, T_v)` and `U(T_v)`: the settlement is as fast as Terzaghi's, the pressure slower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DavisRaymond {
    /// `σ'_f`, Pa.
    end: f64,
    load: f64,
    /// `ln(σ'_f/σ'_0)`.
    logarithm: f64,
    final_settlement: f64,
}

impl DavisRaymond {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let load = parameters.load;
        let start =
            positive("effective stress of the start", parameters.textbook.initial_stress.unwrap_or(load))?;
        let logarithm = normal("logarithm of the stress ratio", elementary::ln_1p(load / start))?;
        let final_settlement = parameters.height * start / parameters.soil.oedometric_modulus() * logarithm;
        Ok(Self { end: start + load, load, logarithm, final_settlement })
    }
}

impl Solution for DavisRaymond {
    /// The effective stress is the whole one, with `σ'_0`.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let pressure = -self.end * elementary::exp_m1(-self.logarithm * isochrone(zeta, time_factor)?.value);
        Ok(FieldValues {
            pressure,
            effective_stress: pressure - self.end,
            displacement: -self.final_settlement * consolidated_below(zeta, time_factor)?.value,
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.final_settlement * consolidated_below(0.0, time_factor)?.value)
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.final_settlement)
    }

    /// The isochrone's bound times the largest slope of `p` in `W`, `σ'_f ln(σ'_f/σ'_0)`.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let base = isochrone(1.0, time_factor)?;
        Ok(Accuracy::new(base.terms, self.end / self.load * self.logarithm * base.tail_bound))
    }
}
