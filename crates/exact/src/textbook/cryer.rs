//! Cryer's sphere: the pressure in its middle rises before it falls.

use core::f64::consts::PI;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::inputs::{BIOT_KEYS, COLUMN_KEYS};
use crate::numerics::bisected;
use crate::parameters::ColumnParameters;
use crate::porous_soil::PorousSoil;
use crate::solution::{Accuracy, FieldValues, Solution};
use crate::textbook::terms::terms_for;
use oedometer_soil::elementary;
use std::sync::OnceLock;

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, BIOT_KEYS];

/// Roots that are known: enough from `c t/a²` = 1e-6 on.
const MOST_TERMS: usize = 2000;

/// Sphere of the radius `a = H` under a total stress `q` all round, drained at its surface (Cryer 1963).
///
/// `ζ` is the depth below the surface, `y` the distance from the centre; stress and displacement are radial.
/// With `g = 4Gα²/(3K E_oed S)`, `h = 3g/(1 + g)` and the roots of `β² = h(1 − β cot β)`, `β_i ∈ (iπ, (i + 1)π)`,
///
/// ```text
/// p/p_0 = Σ 2[(−1)ⁱ R sin(βr/a)/(βr/a) − h] e^{−β²T}/(h² − 3h + β²)     R² = h²β² + (β² − h)²
/// p̄/p_0 = Σ 2(3 − h) e^{−β²T}/(h² − 3h + β²)                            T = ct/a²
/// p_0 = q (α/K)/(1/M + α²/K)        s = a (q − αp̄)/(3K)
/// ```
///
/// from the transform with `C(t) = E_oed ε − αp = −qE_oed/K + 4Gαp̄/(3K)`, the same throughout the sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Cryer {
    load: f64,
    radius: f64,
    soil: PorousSoil,
    /// `p_0`, Pa.
    start: f64,
    /// `h`, from 0, where the sphere does not couple, to 3.
    coupling: f64,
    /// `3 − h`, without cancellation.
    slack: f64,
    /// `β`, of those that a sum has needed.
    roots: Vec<OnceLock<f64>>,
}

/// Sums over the roots.
#[derive(Clone, Copy)]
struct Sums {
    /// `p/p_0`.
    pressure: f64,
    /// Mean of `p/p_0` within the place's radius, a third of it.
    within: f64,
    /// `p̄/p_0`.
    mean: f64,
}

impl Cryer {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let soil = PorousSoil::new(parameters)?;
        let squared = soil.alpha * soil.alpha;
        let share = 4.0 * soil.shear * squared / (3.0 * soil.bulk * soil.modulus * soil.storage);
        let coupling = 3.0 * share / (1.0 + share);
        Ok(Self {
            load: parameters.load,
            radius: parameters.height,
            soil,
            start: parameters.load * soil.alpha / soil.bulk / (soil.fixed_storage + squared / soil.bulk),
            coupling,
            slack: 3.0 / (1.0 + share),
            roots: vec![OnceLock::new(); MOST_TERMS],
        })
    }

    /// A root by its number.
    fn root(&self, index: usize) -> f64 {
        let found = || {
            // β = (i + 1)π − δ with tan δ = hβ/(β² − h).
            let end = (index as f64 + 1.0) * PI;
            let excess = |gap: f64| {
                let root = end - gap;
                gap - elementary::atan2(self.coupling * root, root * root - self.coupling)
            };
            end - bisected(0.0, PI, excess)
        };
        *self.roots[index].get_or_init(found)
    }

    /// The sums at a distance from the centre over the radius.
    fn sums(&self, time_factor: f64, distance: f64) -> Result<Sums, ExactError> {
        let h = self.coupling;
        let time = self.soil.diffusivity_ratio() * checked_time_factor(time_factor)?;
        if time == 0.0 {
            let pressure = if distance < 1.0 { 1.0 } else { 0.0 };
            return Ok(Sums { pressure, within: 1.0 / 3.0, mean: 1.0 });
        }
        let terms = self.terms(time_factor)?.terms;
        let mut sums = Sums { pressure: 0.0, within: 0.0, mean: 0.0 };
        // The small ones first.
        for index in (0..terms).rev() {
            let root = self.root(index);
            let square = root * root;
            let weight = 2.0 * elementary::exp(-square * time) / (square - h * self.slack);
            let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
            let amplitude = sign * elementary::hypot(h * root, square - h);
            let turned = root * distance;
            let sine = if turned == 0.0 { 1.0 } else { elementary::sin(turned) / turned };
            sums.pressure += weight * (amplitude * sine - h);
            sums.within += weight * (amplitude * within_ball(turned) - h / 3.0);
            sums.mean += weight * self.slack;
        }
        if distance == 1.0 {
            sums.pressure = 0.0;
        }
        Ok(sums)
    }

    /// Terms, with a bound on the rest: with `β_i ≥ iπ`, `R ≤ β² + h + hβ` and `h < 3` each is at most `7 e^{−β²T}`.
    fn terms(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let time = self.soil.diffusivity_ratio() * time_factor;
        terms_for(MOST_TERMS, time_factor, |terms| {
            let first = terms as f64 * PI;
            let fall = -elementary::exp_m1(-(2.0 * first + PI) * PI * time);
            7.0 * self.start / self.load * elementary::exp(-first * first * time) / fall
        })
    }
}

impl Solution for Cryer {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let distance = 1.0 - checked_depth(zeta)?;
        let sums = self.sums(time_factor, distance)?;
        let PorousSoil { modulus, shear, bulk, alpha, .. } = self.soil;
        // C(t), and the displacement over the distance from the centre.
        let confined = (4.0 * shear * alpha / 3.0 * self.start * sums.mean - modulus * self.load) / bulk;
        let stretch = (alpha * self.start * sums.within + confined / 3.0) / modulus;
        let pressure = self.start * sums.pressure;
        Ok(FieldValues {
            pressure,
            effective_stress: confined - 4.0 * shear * stretch + alpha * pressure,
            displacement: stretch * distance * self.radius,
        })
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let mean = self.start * self.sums(time_factor, 1.0)?.mean;
        Ok(self.radius * (self.load - self.soil.alpha * mean) / (3.0 * self.soil.bulk))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.radius * self.load / (3.0 * self.soil.bulk))
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        if checked_time_factor(time_factor)? == 0.0 {
            return Ok(Accuracy::new(0, 0.0));
        }
        let accuracy = self.terms(time_factor)?;
        // Where a soil has hardly any bulk modulus the first root is small and flat: its digits go with its fourth power.
        let flat = self.slack.min(1.0);
        Ok(Accuracy { phase_bound: 4.0 * accuracy.phase_bound / (flat * flat), ..accuracy })
    }
}

/// `(sin x − x cos x)/x³`, a third at 0.
fn within_ball(x: f64) -> f64 {
    if x > 0.5 {
        return (elementary::sin(x) - x * elementary::cos(x)) / (x * x * x);
    }
    // Σ (−1)ᵏ 2(k + 1) x²ᵏ/(2k + 3)!
    let (mut term, mut sum) = (1.0 / 3.0, 0.0);
    for k in 1..9 {
        sum += term;
        let k = f64::from(k);
        term *= -x * x * (k + 1.0) / (k * (2.0 * k + 2.0) * (2.0 * k + 3.0));
    }
    sum
}
