//! The start of consolidation: a front that has not reached the base is a function of `ζ/(2√T)`.

use nalgebra::{DMatrix, DVector};

use crate::exact_error::ExactError;
use crate::large_strain::diffusion::Diffusion;
use crate::large_strain::legendre::{Element, evaluate, integral_to_one};
use oedometer_soil::elementary;

/// Front in `η = ζ/(2√T)`: `(κ f')' + 2ηC f' = 0`, `f(0) = 0`, `f(∞) = r_0`.
#[derive(Clone, Debug)]
pub struct Front {
    /// `η` beyond which the pressure is `r_0` to round-off.
    reach: f64,
    /// Undrained pressure ratio `r_0`.
    undrained: f64,
    /// `1 − J` of the undrained start.
    undrained_shrinkage: f64,
    /// Legendre coefficients of `r` in `x = 1 − 2η/reach`.
    ratio: Vec<f64>,
    /// Those of the shrinkage's departure from the undrained one.
    shrinkage: Vec<f64>,
}

/// Newton converges in a few steps from a near enough start.
const MOST_STEPS: usize = 40;
/// `exp(−6.3²)` is below round-off.
const REACH: f64 = 6.3;
/// Front exponent at the base when the front is handed over: `erfc(5.4)` = 2e-14.
const HAND_OVER: f64 = 5.4;

impl Front {
    /// The front by collocation at `order + 1` points, from `guess` or the linear one.
    ///
    /// # Errors
    /// When Newton's iteration does not converge.
    pub fn new(diffusion: &Diffusion, order: usize, guess: Option<&Self>) -> Result<Self, ExactError> {
        let undrained = diffusion.undrained_ratio();
        let [storage, _, conductance] = diffusion.coefficients(undrained);
        let far = (storage / conductance).sqrt();
        let reach = REACH / far;
        let element = Element::new(order);
        let eta: Vec<f64> = element.points.iter().map(|x| 0.5 * reach * (1.0 - x)).collect();
        let first = element.derivative() * (-2.0 / reach);
        let mut ratio = DVector::from_iterator(
            order + 1,
            eta.iter().map(|&eta| match guess {
                Some(front) => front.ratio(eta) * undrained / front.undrained,
                None => undrained * elementary::erf(eta * far),
            }),
        );
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let slope = &first * &ratio;
            let mut flux = slope.clone();
            let mut flux_slopes = first.clone();
            let mut jacobian = DMatrix::zeros(order + 1, order + 1);
            let mut residual = DVector::zeros(order + 1);
            for i in 0..=order {
                let [[storage, _, conductance], [storage_slope, _, conductance_slope]] =
                    diffusion.with_slopes(ratio[i]);
                flux[i] *= conductance;
                flux_slopes.row_mut(i).scale_mut(conductance);
                flux_slopes[(i, i)] += conductance_slope * slope[i];
                residual[i] = 2.0 * eta[i] * storage * slope[i];
                jacobian.row_mut(i).copy_from(&(first.row(i) * (2.0 * eta[i] * storage)));
                jacobian[(i, i)] += 2.0 * eta[i] * storage_slope * slope[i];
            }
            residual += &first * flux;
            jacobian += &first * flux_slopes;
            for (row, value) in [(0, 0.0), (order, undrained)] {
                residual[row] = ratio[row] - value;
                jacobian.row_mut(row).fill(0.0);
                jacobian[(row, row)] = 1.0;
            }
            let Some(step) = jacobian.lu().solve(&residual) else {
                break;
            };
            ratio -= &step;
            let size = step.amax();
            // Round-off of the second derivative stops the iteration somewhere above 1e-14.
            if size < 1e-14 || (size < 1e-10 && size >= 0.5 * last) {
                return Ok(Self::tabulated(diffusion, &element, reach, ratio.as_slice()));
            }
            if !size.is_finite() {
                break;
            }
            last = size;
        }
        Err(ExactError::NotConverged { difference: last })
    }

    fn tabulated(diffusion: &Diffusion, element: &Element, reach: f64, ratio: &[f64]) -> Self {
        let undrained = diffusion.undrained_ratio();
        let undrained_shrinkage = diffusion.shrinkage(undrained);
        let shrinkage: Vec<f64> =
            ratio.iter().map(|&ratio| diffusion.shrinkage(ratio) - undrained_shrinkage).collect();
        Self {
            reach,
            undrained,
            undrained_shrinkage,
            ratio: element.coefficients(ratio),
            shrinkage: element.coefficients(&shrinkage),
        }
    }

    /// Time factor up to which the front has not felt the base.
    pub fn valid_until(&self) -> f64 {
        let far = REACH / self.reach;
        elementary::powi(far / (2.0 * HAND_OVER), 2)
    }

    /// Pressure ratio at `η`.
    fn ratio(&self, eta: f64) -> f64 {
        if eta >= self.reach {
            return self.undrained;
        }
        evaluate(&self.ratio, 1.0 - 2.0 * eta / self.reach)
    }

    /// Pressure ratio at a depth and an early time factor.
    pub fn pressure_ratio(&self, time_factor: f64, zeta: f64) -> f64 {
        if zeta == 0.0 {
            return 0.0;
        }
        self.ratio(zeta / (2.0 * time_factor.sqrt()))
    }

    /// `∫_ζ^1 (1 − J) dζ` at an early time factor.
    pub fn shrinkage_below(&self, time_factor: f64, zeta: f64) -> f64 {
        let undrained = self.undrained_shrinkage * (1.0 - zeta);
        if time_factor == 0.0 {
            return undrained;
        }
        let width = 2.0 * time_factor.sqrt();
        let eta = zeta / width;
        if eta >= self.reach {
            return undrained;
        }
        // From η to the reach is from x down to −1.
        let x = 1.0 - 2.0 * eta / self.reach;
        let total = integral_to_one(&self.shrinkage, -1.0);
        let part = total - integral_to_one(&self.shrinkage, x);
        undrained + width * 0.5 * self.reach * part
    }
}
