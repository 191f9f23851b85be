//! The floor under a converging error, `e = C h^p + F`.

use crate::fit::two_terms::{Exponent, TwoTerms, fit_two_terms};
use crate::orders::slope_of;
use crate::series::{ErrorSeries, Undefined};
use crate::student::quantile_975;
use oedometer_soil::elementary;

/// Orders looked for in a floor fit.
pub const ORDER_RANGE: (f64, f64) = (0.1, 12.0);

/// A floor this small a share of the finest error is round-off of the fit, and set to zero.
const NO_FLOOR: f64 = 1e-10;

/// `e = C h^p + F` fitted with relative residuals, `C > 0`, `F ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorFit {
    /// `p` of the part that converges.
    pub order: f64,
    /// `C`.
    pub coefficient: f64,
    /// `F`, in the unit of the error; 0 where the fit needs none.
    pub floor: f64,
    /// Whether a fit without the floor is worse by more than chance would have it (F-test on the
    /// relative residuals, 95 %). A floor that is not significant should not be quoted.
    pub significant: bool,
    /// Root mean square of the relative residuals.
    pub residual: f64,
}

impl FloorFit {
    /// The floor where it is significant, else 0.
    pub fn significant_floor(&self) -> f64 {
        if self.significant { self.floor } else { 0.0 }
    }

    /// Share of the floor in the fitted error at a size.
    pub fn share(&self, size: f64) -> f64 {
        self.floor / (self.floor + self.coefficient * elementary::powf(size, self.order))
    }
}

/// Fits order, constant and floor with relative residuals; four levels at least.
///
/// # Errors
/// [`Undefined`]; [`Undefined::NotDetermined`] when the errors do not fall enough to show an
/// order, or so fast between two levels and not at all between others that any order would do.
pub fn fit_floor(series: &ErrorSeries) -> Result<FloorFit, Undefined> {
    let points = series.points()?;
    let (least, most) = ORDER_RANGE;
    let fit = fit_two_terms(&points, Exponent::Fixed(0.0), Exponent::Between(least, most))?;
    if fit.high <= least * 1.001 || fit.high >= most * 0.999 {
        return Err(Undefined::NotDetermined);
    }
    if fit.high_coefficient <= 0.0 {
        return Err(Undefined::NotDetermined);
    }
    let finest = points.last().map_or(f64::NAN, |point| point.0);
    let mut fit = FloorFit {
        order: fit.high,
        coefficient: fit.high_coefficient,
        floor: fit.low_coefficient,
        significant: is_significant(&points, &fit)?,
        residual: fit.residual,
    };
    if fit.share(finest) < NO_FLOOR {
        let straight = slope_of(&points)?;
        (fit.order, fit.coefficient) = (straight.order, straight.coefficient);
        (fit.floor, fit.significant) = (0.0, false);
    }
    Ok(fit)
}

/// F-test of one more parameter: does the floor explain more than a straight line does?
fn is_significant(points: &[(f64, f64)], fit: &TwoTerms) -> Result<bool, Undefined> {
    /// Order, constant and floor.
    const PARAMETERS: usize = 3;
    let count = points.len() as f64;
    // The straight fit on logarithms is the floor fit with the floor left out.
    let line = slope_of(points)?;
    let off = |(h, e): &(f64, f64)| {
        elementary::powi(line.coefficient * elementary::powf(*h, line.order) / e - 1.0, 2)
    };
    let straight = points.iter().map(off).sum::<f64>();
    let with_floor = (fit.residual * fit.residual * count).max(count * elementary::powi(f64::EPSILON, 2));
    let ratio = (straight - with_floor) / (with_floor / (count - PARAMETERS as f64));
    let quantile = quantile_975(points.len().saturating_sub(PARAMETERS)).ok_or(Undefined::NotDetermined)?;
    Ok(ratio.is_finite() && ratio > quantile * quantile)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn series(error: impl Fn(f64) -> f64) -> ErrorSeries {
        let sizes = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0].map(|cells| 1.0 / cells);
        ErrorSeries::of(&sizes.map(|size| (size, error(size))))
    }

    #[test]
    fn a_floor_is_found() {
        let fit = fit_floor(&series(|h| h * h + 2e-4)).unwrap();
        assert!((fit.order - 2.0).abs() < 1e-9 && (fit.floor / 2e-4 - 1.0).abs() < 1e-9, "{fit:?}");
        assert!(fit.significant && (fit.coefficient - 1.0).abs() < 1e-8);
    }

    #[test]
    fn noise_alone_makes_no_significant_floor() {
        let noise = [0.03, -0.02, 0.01, -0.03, 0.02, -0.01];
        let mut levels = series(|h| h * h).levels().to_vec();
        for (level, noise) in levels.iter_mut().zip(noise) {
            level.error = level.error.map(|error| error * (1.0 + noise));
        }
        let fit = fit_floor(&ErrorSeries::new(levels)).unwrap();
        assert!(!fit.significant && fit.significant_floor() == 0.0, "{fit:?}");
    }

    #[test]
    fn what_has_no_order_is_undefined() {
        assert_eq!(fit_floor(&series(|h| 1.0 / h)), Err(Undefined::NotDetermined));
        assert_eq!(fit_floor(&series(|_| 1.0)), Err(Undefined::NotDetermined));
        let cliff = series(|h| if h > 0.15 { 1.0 } else { 1e-3 });
        assert_eq!(fit_floor(&cliff), Err(Undefined::NotDetermined));
        let short = ErrorSeries::new(series(|h| h).levels()[..3].to_vec());
        assert_eq!(fit_floor(&short), Err(Undefined::TooFewLevels { levels: 3, needed: 4 }));
    }

    proptest! {
        #[test]
        fn an_exact_power_law_has_its_order_and_no_floor(p in 0.3..6.0_f64, c in -9.0..9.0_f64) {
            let fit = fit_floor(&series(|h| c.exp() * h.powf(p))).unwrap();
            prop_assert!((fit.order - p).abs() < 1e-12, "{:?}", fit);
            prop_assert!(fit.floor == 0.0 && !fit.significant, "{:?}", fit);
        }

        #[test]
        fn a_floor_of_any_height_is_found(p in 0.7..4.0_f64, share in 0.05..0.95_f64, c in -9.0..9.0_f64) {
            // The floor is the given share of the error at the finest level.
            let floor = (1.0 / 160.0_f64).powf(p) * share / (1.0 - share);
            let fit = fit_floor(&series(|h| c.exp() * (h.powf(p) + floor))).unwrap();
            prop_assert!((fit.order - p).abs() < 1e-6, "{:?}", fit);
            prop_assert!((fit.floor / floor / c.exp() - 1.0).abs() < 1e-6, "{:?}", fit);
            prop_assert!(fit.significant);
        }
    }
}
