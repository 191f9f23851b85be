//! The floor under a converging error, `e = C h^p + F`.

use crate::fit::Exponent;
use crate::fit::bending_order::{Bend, explain};
use crate::fit::two_terms::{TwoTerms, fit_two_terms};
use crate::orders::{SlopeFit, quantile_975, slope_of};
use crate::series::{ErrorSeries, Undefined};
use oedometer_soil::elementary::{powf, powi};

/// Orders that a floor fit looks for.
const ORDERS: (f64, f64) = (0.1, 12.0);

/// A floor below this share of the finest error is round-off of the fit, and set to zero.
const NO_FLOOR: f64 = 1e-10;

/// `e = C h^p + F` fitted with relative residuals, `C > 0`, `F ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FloorFit {
    /// Order `p` of the part that converges.
    pub order: f64,
    /// Its coefficient `C`.
    pub coefficient: f64,
    /// `F`, in the unit of the error; 0 where the fit needs none.
    pub floor: f64,
    /// Whether the fit without a floor is significantly worse (F-test on the relative residuals, 95 %). A floor
    /// that is not significant should not be quoted.
    pub significant: bool,
    /// Root mean square of the relative residuals.
    pub residual: f64,
}

/// Fits order, constant and floor to (size, error) points with relative residuals; four levels at least.
///
/// # Errors
/// [`Undefined`]; [`Undefined::NotDetermined`] when the errors do not fall enough to show an
/// order, or so fast between two levels and not at all between others that any order would do.
pub(crate) fn fit_floor(points: &[(f64, f64)]) -> Result<FloorFit, Undefined> {
    let (least, most) = ORDERS;
    let fit = fit_two_terms(points, Exponent::Fixed(0.0), Exponent::Between(least, most))?;
    if fit.high <= least * 1.001 || fit.high >= most * 0.999 || fit.high_coefficient <= 0.0 {
        return Err(Undefined::NotDetermined);
    }
    // The straight fit on logarithms is the floor fit with the floor left out.
    let straight = slope_of(points)?;
    let finest = points.last().map_or(f64::NAN, |point| point.0);
    let (order, coefficient, floor, significant) = if fit.low_share(finest) < NO_FLOOR {
        (straight.order, straight.coefficient, 0.0, false)
    } else {
        (fit.high, fit.high_coefficient, fit.low_coefficient, is_significant(points, &straight, &fit)?)
    };
    Ok(FloorFit { order, coefficient, floor, significant, residual: fit.residual })
}

/// F-test of one more parameter: does the floor explain more than the straight line `C h^p` does?
fn is_significant(points: &[(f64, f64)], line: &SlopeFit, fit: &TwoTerms) -> Result<bool, Undefined> {
    /// Order, constant and floor.
    const PARAMETERS: usize = 3;
    let count = points.len() as f64;
    let off = |(h, e): &(f64, f64)| powi(line.coefficient * powf(*h, line.order) / e - 1.0, 2);
    let straight = points.iter().map(off).sum::<f64>();
    let with_floor = (fit.residual * fit.residual * count).max(count * powi(f64::EPSILON, 2));
    let ratio = (straight - with_floor) / (with_floor / (count - PARAMETERS as f64));
    // The square of Student's t is Fisher's F with one degree of freedom over as many.
    let quantile = quantile_975(points.len().saturating_sub(PARAMETERS)).ok_or(Undefined::NotDetermined)?;
    Ok(ratio.is_finite() && ratio > quantile * quantile)
}

/// The floor that bends a series without governing it yet, in the unit of the errors; 0 without one.
/// `formal` is the formal order of the method, where it is known.
pub fn hidden_floor(series: &ErrorSeries, formal: Option<f64>) -> f64 {
    let Ok(points) = series.points() else { return 0.0 };
    match (explain(&points, formal), fit_floor(&points)) {
        (Some(Bend::Floor(_)), Ok(fit)) if fit.significant => fit.floor,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let sizes = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0].map(|cells| 1.0 / cells);
        sizes.map(|size| (size, error(size))).to_vec()
    }

    #[test]
    fn a_floor_is_found() {
        let fit = fit_floor(&points(|h| h * h + 2e-4)).unwrap();
        assert!((fit.order - 2.0).abs() < 1e-9 && (fit.floor / 2e-4 - 1.0).abs() < 1e-9, "{fit:?}");
        assert!(fit.significant && (fit.coefficient - 1.0).abs() < 1e-8);
    }

    #[test]
    fn noise_alone_makes_no_significant_floor() {
        let noise = [0.03, -0.02, 0.01, -0.03, 0.02, -0.01];
        let mut levels = points(|h| h * h);
        for (level, noise) in levels.iter_mut().zip(noise) {
            level.1 *= 1.0 + noise;
        }
        let fit = fit_floor(&levels).unwrap();
        assert!(!fit.significant, "{fit:?}");
        assert_eq!(hidden_floor(&ErrorSeries::of(&levels), None), 0.0);
    }

    #[test]
    fn a_floor_that_bends_a_series_and_does_not_govern_it_is_hidden() {
        // A tenth of the finest error: the order falls from level to level, and the class is still that of the slope.
        let hidden = |error: fn(f64) -> f64, formal| hidden_floor(&ErrorSeries::of(&points(error)), formal);
        for formal in [None, Some(2.0)] {
            let found = hidden(|h| h * h + 4e-6, formal);
            assert!((found / 4e-6 - 1.0).abs() < 1e-6, "{formal:?}: {found:e}");
            assert_eq!(hidden(|h| h * h, formal), 0.0);
        }
    }

    #[test]
    fn what_has_no_order_is_undefined() {
        assert_eq!(fit_floor(&points(|h| 1.0 / h)), Err(Undefined::NotDetermined));
        assert_eq!(fit_floor(&points(|_| 1.0)), Err(Undefined::NotDetermined));
        let cliff = points(|h| if h > 0.15 { 1.0 } else { 1e-3 });
        assert_eq!(fit_floor(&cliff), Err(Undefined::NotDetermined));
        assert_eq!(fit_floor(&points(|h| h)[..3]), Err(Undefined::TooFewLevels { levels: 3, needed: 4 }));
    }

    proptest! {
        #[test]
        fn an_exact_power_law_has_its_order_and_no_floor(p in 0.3..6.0_f64, c in -9.0..9.0_f64) {
            let fit = fit_floor(&points(|h| c.exp() * h.powf(p))).unwrap();
            prop_assert!((fit.order - p).abs() < 1e-12, "{:?}", fit);
            prop_assert!(fit.floor == 0.0 && !fit.significant, "{:?}", fit);
        }

        #[test]
        fn a_floor_of_any_height_is_found(p in 0.7..4.0_f64, share in 0.05..0.95_f64, c in -9.0..9.0_f64) {
            // The floor is the given share of the error at the finest level.
            let floor = (1.0 / 160.0_f64).powf(p) * share / (1.0 - share);
            let fit = fit_floor(&points(|h| c.exp() * (h.powf(p) + floor))).unwrap();
            prop_assert!((fit.order - p).abs() < 1e-6, "{:?}", fit);
            prop_assert!((fit.floor / floor / c.exp() - 1.0).abs() < 1e-6, "{:?}", fit);
            prop_assert!(fit.significant);
        }
    }
}
