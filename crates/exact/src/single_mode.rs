//! The slowest mode of the unloaded column: smooth in space and time.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{COLUMN_KEYS, LAW_KEY, WATER_KEYS};
use crate::parameters::ColumnParameters;
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary;

/// The row of the solution.
pub(crate) static SINGLE_MODE: Row = Row {
    name: "single-mode",
    words: "the exact first eigenmode",
    inputs: &[COLUMN_KEYS, WATER_KEYS, LAW_KEY],
    ..Row::COLUMN
};

/// Decay of `p = σ' = p_0 sin(M_0 ζ)`, `M_0 = π/2`, without any load.
///
/// `p = p_0 sin(M_0 ζ) exp(−M_0² B T_v)`, where the amplitude `p_0` is the column's `load`. Inertia
/// is left out, as in Terzaghi's theory. The displacement is measured from the state at `t = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleMode {
    parameters: ColumnParameters,
    /// `B`, or 1 with incompressible water.
    storage_ratio: f64,
}

/// Velocities of both phases, upward positive, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseVelocities {
    /// Velocity `v_s` of the solid skeleton.
    pub solid: f64,
    /// Velocity `v_w` of the pore water.
    pub water: f64,
}

impl SingleMode {
    /// The mode with compressible water.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn compressible(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        Ok(Self { parameters: *parameters, storage_ratio: parameters.storage_ratio() })
    }

    /// Exponent `M_0² B T_v` of the decay.
    fn decay_exponent(&self, time_factor: f64) -> f64 {
        FRAC_PI_2 * FRAC_PI_2 * self.storage_ratio * time_factor
    }

    /// Velocities of both phases, from the balances of volume and Darcy's law.
    ///
    /// `∂v_s/∂y = σ̇'/E_oed` and `n (v_w − v_s) = −(k/γ_w) ∂p/∂y`. A solver starts from those at
    /// `time_factor = 0`.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn velocities(&self, time_factor: f64, zeta: f64) -> Result<PhaseVelocities, ExactError> {
        let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
        let column = &self.parameters;
        let profile = from_base(zeta) * elementary::exp(-self.decay_exponent(time_factor));
        // M_0 k p_0/(γ_w H), the specific discharge through the drained surface.
        let discharge = FRAC_PI_2 * column.soil.hydraulic_conductivity * column.load
            / (column.soil.unit_weight_of_water() * column.height)
            * profile;
        let solid = -self.storage_ratio * discharge;
        Ok(PhaseVelocities { solid, water: solid + discharge / column.soil.porosity })
    }
}

impl Solution for SingleMode {
    /// Pressure, effective stress and displacement at a relative depth.
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let (zeta, time_factor) = (checked_depth(zeta)?, checked_time_factor(time_factor)?);
        let exponent = self.decay_exponent(time_factor);
        let pressure = self.parameters.load * elementary::sin(FRAC_PI_2 * zeta) * elementary::exp(-exponent);
        let amplitude = self.parameters.final_settlement() / FRAC_PI_2;
        Ok(FieldValues {
            pressure,
            effective_stress: pressure,
            displacement: amplitude * from_base(zeta) * elementary::exp_m1(-exponent),
        })
    }

    /// Since `t = 0`.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let exponent = self.decay_exponent(checked_time_factor(time_factor)?);
        Ok(-self.final_settlement()? * elementary::exp_m1(-exponent))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.parameters.final_settlement() * FRAC_2_PI)
    }

    /// One term, no tail.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        checked_time_factor(time_factor)?;
        Ok(Accuracy::new(1, 0.0))
    }
}

/// `cos(M_0 ζ)`, written from the base so that it vanishes there.
fn from_base(zeta: f64) -> f64 {
    elementary::sin(FRAC_PI_2 * (1.0 - zeta))
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::material::Material;

    /// Central difference over a step that balances truncation and round-off.
    fn slope(f: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
        (f(at + step) - f(at - step)) / (2.0 * step)
    }

    #[test]
    fn balances_hold_in_the_mode() {
        let column = ColumnParameters {
            soil: Material { water_bulk_modulus: 4.0e6, ..Material::default() },
            height: 2.0,
            load: 3.0e3,
            ..ColumnParameters::default()
        };
        let mode = SingleMode::compressible(&column).unwrap();
        let (time_factor, zeta) = (0.3, 0.4);
        let velocities = |zeta| mode.velocities(time_factor, zeta).unwrap();
        let discharge = |zeta| column.soil.porosity * (velocities(zeta).water - velocities(zeta).solid);
        let per_height = -1.0 / column.height;
        let strain_rate = slope(|z| velocities(z).solid, zeta, 1e-5) * per_height;
        let outflow = slope(discharge, zeta, 1e-5) * per_height;
        let rate = |f: &dyn Fn(f64) -> f64| slope(f, time_factor, 1e-5) / column.time(1.0);
        let pressure_rate = rate(&|t| mode.fields(t, zeta).unwrap().pressure);
        let displacement_rate = rate(&|t| mode.fields(t, zeta).unwrap().displacement);
        let storage = -column.soil.coupling_modulus() * (strain_rate + outflow);
        assert!((pressure_rate / storage - 1.0).abs() < 1e-8);
        assert!((pressure_rate / column.soil.oedometric_modulus() / strain_rate - 1.0).abs() < 1e-8);
        assert!((displacement_rate / velocities(zeta).solid - 1.0).abs() < 1e-8);
        let gradient = slope(|z| mode.fields(time_factor, z).unwrap().pressure, zeta, 1e-5);
        let darcy =
            -column.soil.hydraulic_conductivity / column.soil.unit_weight_of_water() * gradient * per_height;
        assert!((darcy / discharge(zeta) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn settlement_is_the_surfaces_displacement() {
        let mode = SingleMode::compressible(&ColumnParameters::default()).unwrap();
        for time_factor in [0.0, 1e-9, 0.2, 5.0] {
            let surface = mode.fields(time_factor, 0.0).unwrap();
            assert_eq!(surface.displacement, -mode.settlement(time_factor).unwrap());
            assert_eq!(surface.pressure, 0.0);
            assert_eq!(mode.fields(time_factor, 1.0).unwrap().displacement, 0.0);
        }
    }
}
