//! Numerical uncertainty by least squares over four or more grids.
//!
//! Eça & Hoekstra (2014), *A procedure for the estimation of the numerical uncertainty of CFD
//! calculations based on grid refinement studies*, J. Comput. Phys. 262, appendix A and B.

use serde::{Deserialize, Serialize};

use crate::fit::{Exponent, best_power, fit_powers};
use crate::series::{Undefined, finite_levels};
use oedometer_soil::elementary::powf;

/// The error models of the procedure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorModel {
    /// `δ = α h^p` with the order fitted.
    PowerLaw,
    /// `δ = α h`.
    FirstOrder,
    /// `δ = α h²`.
    SecondOrder,
    /// `δ = α₁ h + α₂ h²`.
    FirstAndSecondOrder,
}

/// The estimate for one grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridUncertainty {
    /// Size of the grid's cells.
    pub size: f64,
    /// Estimated error `δ = φ_fit − φ_0`, in the unit of the value.
    pub error: f64,
    /// Value less the fit.
    pub misfit: f64,
    /// Uncertainty `U` with 95 % coverage intended, in the unit of the value.
    pub uncertainty: f64,
}

/// The outcome of the procedure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeastSquaresUncertainty {
    /// The model that was chosen.
    pub model: ErrorModel,
    /// Whether the fit weights fine grids more (`w ∝ 1/h`).
    pub weighted: bool,
    /// Order of the power law, even where another model was chosen.
    pub observed_order: f64,
    /// Extrapolated value `φ_0`.
    pub extrapolated: f64,
    /// Standard deviation `σ` of the fit.
    pub deviation: f64,
    /// Data range parameter `Δ = (max φ − min φ)/(n − 1)`.
    pub data_range: f64,
    /// Safety factor: 1.25 for a good fit of credible order, else 3.
    pub safety_factor: f64,
    /// The grids, from coarse to fine.
    pub grids: Vec<GridUncertainty>,
}

/// Orders that the power law searches.
const ORDERS: Exponent = Exponent::Between(0.01, 8.0);

/// Fewest grids: three numbers are fitted and a deviation is needed.
const LEAST_GRIDS: usize = 4;

struct Fit {
    model: ErrorModel,
    weighted: bool,
    order: f64,
    limit: f64,
    /// Coefficients of the exponents, sizes scaled by the coarsest.
    terms: Vec<(f64, f64)>,
    deviation: f64,
}

/// The procedure for (size, value) pairs in any order, with the formal order of the method.
///
/// # Errors
/// [`Undefined`] for fewer than four grids, bad or repeated sizes, values that are not finite, and
/// [`Undefined::EqualValues`] where all values are equal to round-off, which shows no uncertainty of zero.
pub(crate) fn least_squares_uncertainty(
    grids: &[(f64, f64)],
    formal_order: f64,
) -> Result<LeastSquaresUncertainty, Undefined> {
    if grids.len() < LEAST_GRIDS {
        return Err(Undefined::TooFewLevels { levels: grids.len(), needed: LEAST_GRIDS });
    }
    if !formal_order.is_finite() || formal_order < 0.5 {
        return Err(Undefined::NotDetermined);
    }
    let grids = finite_levels(grids)?;
    let largest = grids[0].0;
    let scaled: Vec<_> = grids.iter().map(|(size, value)| (size / largest, *value)).collect();
    let highest = grids.iter().map(|grid| grid.1).fold(f64::NEG_INFINITY, f64::max);
    let lowest = grids.iter().map(|grid| grid.1).fold(f64::INFINITY, f64::min);
    let range = highest - lowest;
    if !range.is_finite() {
        return Err(Undefined::NotFinite { size: largest });
    }
    if range <= 16.0 * f64::EPSILON * highest.abs().max(lowest.abs()) {
        return Err(Undefined::EqualValues);
    }
    let data_range = range / (grids.len() - 1) as f64;
    let power = best(&scaled, &[ErrorModel::PowerLaw])?;
    let observed_order = power.order;
    let fit = match observed_order {
        order if order > formal_order => best(&scaled, &[ErrorModel::FirstOrder, ErrorModel::SecondOrder])?,
        order if order >= 0.5 => power,
        _ => best(
            &scaled,
            &[ErrorModel::FirstOrder, ErrorModel::SecondOrder, ErrorModel::FirstAndSecondOrder],
        )?,
    };
    let good = fit.deviation < data_range;
    let credible = (0.5..1.05 * formal_order).contains(&observed_order);
    let safety_factor = if good && credible { 1.25 } else { 3.0 };
    let estimate = |(size, value): &(f64, f64)| {
        let part = |(exponent, c): &(f64, f64)| c * powf(size / largest, *exponent);
        let error: f64 = fit.terms.iter().map(part).sum();
        let misfit = value - fit.limit - error;
        let uncertainty = if good {
            safety_factor * error.abs() + fit.deviation + misfit.abs()
        } else {
            3.0 * (fit.deviation / data_range) * (error.abs() + fit.deviation + misfit.abs())
        };
        GridUncertainty { size: *size, error, misfit, uncertainty }
    };
    Ok(LeastSquaresUncertainty {
        model: fit.model,
        weighted: fit.weighted,
        observed_order,
        extrapolated: fit.limit,
        deviation: fit.deviation,
        data_range,
        safety_factor,
        grids: grids.iter().map(estimate).collect(),
    })
}

/// The fit of least deviation among models, each with and without weights.
fn best(grids: &[(f64, f64)], models: &[ErrorModel]) -> Result<Fit, Undefined> {
    let fits = models.iter().flat_map(|model| [false, true].map(|weighted| fit(grids, *model, weighted)));
    fits.flatten().min_by(|a, b| a.deviation.total_cmp(&b.deviation)).ok_or(Undefined::NotDetermined)
}

fn fit(grids: &[(f64, f64)], model: ErrorModel, weighted: bool) -> Option<Fit> {
    let count = grids.len() as f64;
    let total: f64 = grids.iter().map(|(size, _)| 1.0 / size).sum();
    let weight = |(size, _): &(f64, f64)| if weighted { count / size / total } else { 1.0 };
    let weights: Vec<_> = grids.iter().map(weight).collect();
    let (exponents, freedom) = match model {
        ErrorModel::FirstOrder => (vec![1.0], count - 2.0),
        ErrorModel::SecondOrder => (vec![2.0], count - 2.0),
        ErrorModel::FirstAndSecondOrder => (vec![1.0, 2.0], count - 3.0),
        ErrorModel::PowerLaw => (vec![best_power(grids, ORDERS, &weights)], count - 3.0),
    };
    let (coefficients, square) = fit_powers(grids, &exponents, &weights)?;
    Some(Fit {
        model,
        weighted,
        order: exponents[0],
        limit: coefficients[0],
        terms: exponents.iter().copied().zip(coefficients[1..].iter().copied()).collect(),
        deviation: (square / freedom).sqrt(),
    })
}

#[cfg(test)]
mod tests;
