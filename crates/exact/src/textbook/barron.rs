//! Radial consolidation of a hollow cylinder that drains to a well in its middle.

use core::f64::consts::PI;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, positive};
use crate::inputs::COLUMN_KEYS;
use crate::numerics::bisected;
use crate::parameters::ColumnParameters;
use crate::solution::{Accuracy, FieldValues, Solution};
use crate::textbook::terms::terms_for;
use oedometer_soil::elementary::{self, exp, hypot, j0, j1, ln, y0, y1};
use std::sync::OnceLock;

/// Study keys that the solution reads.
pub(crate) const INPUTS: &[&[&str]] = &[COLUMN_KEYS, &["radius"]];

/// Roots that are known.
const MOST_TERMS: usize = 1000;

/// The cylinder: `r = r_w + ζH` from the drain, `ζ = 0`, to the outer radius `r_e = r_w + H`, `ζ = 1`, where nothing
/// passes. Flow is horizontal, water incompressible; the settlement is that of a layer as thick as `H`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cylinder {
    load: f64,
    final_settlement: f64,
    /// `r_w/r_e`.
    inner: f64,
    /// `H/r_e = 1 − r_w/r_e`.
    width: f64,
}

impl Cylinder {
    fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let drain = positive("radius of the drain", parameters.textbook.drain_radius)?;
        let outer = drain + parameters.height;
        let (inner, width) = (drain / outer, parameters.height / outer);
        positive("radius of the drain over the outer radius", inner)?;
        positive("width of the cylinder over the outer radius", width)?;
        Ok(Self { load: parameters.load, final_settlement: parameters.final_settlement(), inner, width })
    }

    /// `c_v t/r_e²`.
    fn time(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(checked_time_factor(time_factor)? * self.width * self.width)
    }

    /// `r/r_e` at a depth from the drain.
    fn radius(&self, zeta: f64) -> Result<f64, ExactError> {
        Ok(self.inner + checked_depth(zeta)? * self.width)
    }

    /// Fields of a pressure over the load and of the one that the strain follows.
    fn fields(&self, pressure: f64, strained: f64) -> FieldValues {
        FieldValues {
            pressure: self.load * pressure,
            effective_stress: self.load * (strained - 1.0),
            displacement: self.final_settlement * (strained - 1.0),
        }
    }
}

/// Equal strain: the layer settles evenly (Barron 1948; Hansbo 1981, without smear and well resistance).
///
/// With `n = r_e/r_w` and `μ = n²/(n² − 1) ln n − (3n² − 1)/(4n²)`,
///
/// ```text
/// p̄ = q e^{−2c_v t/(μ r_e²)}     p = (p̄/μ) [ln(r/r_w) − (r² − r_w²)/(2r_e²)]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barron {
    cylinder: Cylinder,
    /// `μ`.
    spacing: f64,
}

impl Barron {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        let cylinder = Cylinder::new(parameters)?;
        let square = cylinder.inner * cylinder.inner;
        let spacing = -ln(cylinder.inner) / (1.0 - square) - 0.25 * (3.0 - square);
        Ok(Self {
            cylinder,
            spacing: positive("drain spacing function (is the drain too wide for its cylinder?)", spacing)?,
        })
    }

    /// `p̄/q`.
    fn mean(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(exp(-2.0 * self.cylinder.time(time_factor)? / self.spacing))
    }
}

impl Solution for Barron {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let mean = self.mean(time_factor)?;
        let (radius, inner) = (self.cylinder.radius(zeta)?, self.cylinder.inner);
        let profile = ln(radius / inner) - 0.5 * (radius - inner) * (radius + inner);
        Ok(self.cylinder.fields(mean * profile / self.spacing, mean))
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(-self.cylinder.final_settlement
            * elementary::exp_m1(-2.0 * self.cylinder.time(time_factor)? / self.spacing))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.cylinder.final_settlement)
    }

    /// Closed form; a thin cylinder cancels digits of `μ`.
    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.mean(time_factor)?;
        Ok(Accuracy { phase_bound: 8.0 * f64::EPSILON / self.spacing, ..Accuracy::new(1, 0.0) })
    }
}

/// Free strain: each ring settles by itself (Barron 1948; Carslaw & Jaeger 1959, section 13.4).
///
/// In `r/r_e`, with `a = r_w/r_e` and the roots `β_m` of `J₀(βa) Y₁(β) = Y₀(βa) J₁(β)`,
///
/// ```text
/// p/q = Σ π/(1 − k²) [J₀(βr) Y₀(βa) − Y₀(βr) J₀(βa)] e^{−β²T}     k² = (J₀² + Y₀²)(βa)/(J₁² + Y₁²)(β)
/// p̄/q = Σ 4/(β²(1 − a²)(k² − 1)) e^{−β²T}                         T = c_v t/r_e²
/// ```
///
/// The phases of the Bessel functions are within π/4 of `x − π/4` and `x − 3π/4`, so `β_m(1 − a)` lies in
/// `[mπ, (m + 1)π]`, one root in each.
#[derive(Clone, Debug, PartialEq)]
pub struct BarronFreeStrain {
    cylinder: Cylinder,
    /// `β` and `1/(k² − 1)`, of those that a sum has needed.
    modes: Vec<OnceLock<(f64, f64)>>,
}

impl BarronFreeStrain {
    pub fn new(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        Ok(Self { cylinder: Cylinder::new(parameters)?, modes: vec![OnceLock::new(); MOST_TERMS] })
    }

    /// A mode by its number.
    fn mode(&self, index: usize) -> (f64, f64) {
        let (inner, spacing) = (self.cylinder.inner, PI / self.cylinder.width);
        let found = || {
            let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
            let misfit = |root: f64| sign * (j0(root * inner) * y1(root) - y0(root * inner) * j1(root));
            let low = index as f64 * spacing;
            let root = bisected(low, low + spacing, misfit);
            let ratio = hypot(j0(root * inner), y0(root * inner)) / hypot(j1(root), y1(root));
            (root, 1.0 / ((ratio - 1.0) * (ratio + 1.0)))
        };
        *self.modes[index].get_or_init(found)
    }

    /// Sum over the modes of `term(β, 1/(k² − 1))` times the decay of the mode, smallest first.
    fn sum(&self, time_factor: f64, term: impl Fn(f64, f64) -> f64) -> Result<f64, ExactError> {
        let time = self.cylinder.time(time_factor)?;
        let modes = (0..self.terms(time_factor)?.terms).rev().map(|index| self.mode(index));
        Ok(modes.map(|(root, share)| term(root, share) * exp(-root * root * time)).sum())
    }

    fn pressure(&self, time_factor: f64, radius: f64) -> Result<f64, ExactError> {
        let inner = self.cylinder.inner;
        if radius <= inner || time_factor == 0.0 {
            return Ok(if radius <= inner { 0.0 } else { 1.0 });
        }
        self.sum(time_factor, |root, share| {
            let (drain, place) = (root * inner, root * radius);
            -PI * share * (j0(place) * y0(drain) - y0(place) * j0(drain))
        })
    }

    /// Terms, with a bound on the rest: a coefficient is at most `‖1‖/‖U‖` (Bessel), and `|U| ≤ √(ln n) β‖U‖`, for
    /// `U` vanishes at the drain and `∫ r U'² = β²‖U‖²`.
    fn terms(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let Cylinder { inner, width, .. } = self.cylinder;
        let time = self.cylinder.time(time_factor)?;
        let largest = (-ln(inner) * 0.5 * (1.0 - inner) * (1.0 + inner)).sqrt();
        terms_for(MOST_TERMS, time_factor, |terms| {
            let first = terms as f64 * PI / width;
            let decay = exp(-first * first * time);
            // Terms rise before they fall.
            if first * first * time < 0.5 {
                return f64::INFINITY;
            }
            largest * decay * (first + width / (2.0 * PI * time))
        })
    }
}

impl Solution for BarronFreeStrain {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let pressure = self.pressure(time_factor, self.cylinder.radius(zeta)?)?;
        Ok(self.cylinder.fields(pressure, pressure))
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        if time_factor == 0.0 {
            return Ok(0.0);
        }
        let area = (1.0 - self.cylinder.inner) * (1.0 + self.cylinder.inner);
        let mean = self.sum(time_factor, |root, share| 4.0 * share / (root * root * area))?;
        Ok(self.cylinder.final_settlement * (1.0 - mean))
    }

    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.cylinder.final_settlement)
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        if checked_time_factor(time_factor)? == 0.0 {
            return Ok(Accuracy::new(0, 0.0));
        }
        let accuracy = self.terms(time_factor)?;
        // A thin cylinder cancels digits of k² − 1.
        Ok(Accuracy { phase_bound: accuracy.phase_bound / self.cylinder.width, ..accuracy })
    }
}
