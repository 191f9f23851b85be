//! Injection of water at a point of an infinite body.

use core::f64::consts::PI;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{BIOT_KEYS, COLUMN_KEYS};
use crate::parameters::ColumnParameters;
use crate::porous_soil::PorousSoil;
use crate::solution::{Accuracy, FieldValues, Solution};
use oedometer_soil::elementary::{erf, erfc, exp};

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, BIOT_KEYS];

/// Point source at a constant rate from `t = 0` on (Rudnicki 1986).
///
/// `y = (1 − ζ)H` is the distance `r` from the source; stress and displacement are radial, outward positive. The load
/// names the rate: `q` is the steady pressure at `r = H`, so that `4πk/γ_w H q` m³/s flow in.
///
/// ```text
/// p = q (H/r) erfc ξ       u = m_v α q H [½ erfc ξ + erf ξ/(4ξ²) − e^{−ξ²}/(2√π ξ)]      ξ = r/(2√(ct))
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Injection {
    load: f64,
    /// `m_v q H`, m.
    compressed: f64,
    height: f64,
    soil: PorousSoil,
}

impl Injection {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let soil = PorousSoil::new(parameters)?;
        let (load, height) = (parameters.load, parameters.height);
        Ok(Self { load, compressed: parameters.final_settlement(), height, soil })
    }

    /// `ξ` at a distance over `H`; infinite at the start.
    fn similarity(&self, time_factor: f64, distance: f64) -> Result<f64, ExactError> {
        Ok(0.5 * distance / (self.soil.diffusivity_ratio() * checked_time_factor(time_factor)?).sqrt())
    }
}

impl Solution for Injection {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let distance = 1.0 - checked_depth(zeta)?;
        if distance == 0.0 {
            return Err(ExactError::AtTheSource);
        }
        let similarity = self.similarity(time_factor, distance)?;
        let pressure = self.load / distance * erfc(similarity);
        let displacement = self.compressed * self.soil.alpha * pushed(similarity);
        let hoop = displacement / (distance * self.height);
        Ok(FieldValues {
            pressure,
            effective_stress: self.soil.alpha * pressure - 4.0 * self.soil.shear * hoop,
            displacement,
        })
    }

    /// Negative: the sphere `r = H` is pushed outward.
    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(-self.compressed * self.soil.alpha * pushed(self.similarity(time_factor, 1.0)?))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(-0.5 * self.compressed * self.soil.alpha)
    }

    fn has_degree(&self) -> bool {
        false
    }

    /// Closed form.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.similarity(time_factor, 1.0)?;
        Ok(Accuracy::new(1, 0.0))
    }
}

/// `½ erfc ξ + erf ξ/(4ξ²) − e^{−ξ²}/(2√π ξ)`: a half near the source or late, 0 before.
fn pushed(xi: f64) -> f64 {
    if xi.is_infinite() {
        return 0.0;
    }
    if xi > 1.0 {
        return 0.5 * erfc(xi) + erf(xi) / (4.0 * xi * xi) - exp(-xi * xi) / (2.0 * PI.sqrt() * xi);
    }
    // Σ (−1)ᵏ⁺¹ ξ²ᵏ⁻¹ 2k/((2k + 1) k!), where the two terms cancel.
    let (mut power, mut sum) = (xi, 0.0);
    for k in 1..20 {
        let k = f64::from(k);
        sum += power * 2.0 * k / (2.0 * k + 1.0);
        power *= -xi * xi / (k + 1.0);
    }
    0.5 * erfc(xi) + sum / (2.0 * PI.sqrt())
}
