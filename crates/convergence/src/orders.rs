//! Observed orders of convergence: by pairs, by a straight fit to all levels, and on the finest window.
//!
//! An interval alone cannot decide: a Student-t interval takes curvature for noise, and `h² + 8h³`
//! over the six levels h = 1/5 … 1/160 gives 2.25 ± 0.12. Whether an order means anything is decided in
//! [`classify`](crate::classify) first.

use crate::series::{ErrorSeries, SeriesLevel, Undefined};
use oedometer_soil::elementary::{exp, ln, powi};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Levels in the finest window, over which an order is judged.
pub const WINDOW: usize = 3;

/// Straight line `ln e = ln C + p ln h` through a number of levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeFit {
    /// The slope `p`.
    pub order: f64,
    /// The constant `C`, in the unit of the error over that of `h^p`.
    pub coefficient: f64,
    /// Half-width `t_{0.975,n−2} s_p` of the 95 % interval of the slope; `None` for two levels.
    /// With three levels t = 12.7 and the interval says little.
    pub half_width: Option<f64>,
    /// Number of levels.
    pub levels: usize,
}

/// The 97.5 % quantile of Student's t: `|t|` stays below it with 95 %. `None` without degrees of freedom.
pub(crate) fn quantile_975(freedom: usize) -> Option<f64> {
    StudentsT::new(0.0, 1.0, freedom as f64).ok().map(|t| t.inverse_cdf(0.975))
}

/// Orders `ln(e_c/e_f) / ln(h_c/h_f)` between all neighbouring levels, from coarse to fine.
pub fn pair_orders(series: &ErrorSeries) -> Vec<Result<f64, Undefined>> {
    let order = |levels: &[SeriesLevel]| Ok(pair_order(&ErrorSeries::new(levels.to_vec()).points()?));
    series.levels().windows(2).map(order).collect()
}

/// The order between two (size, error) points.
pub(crate) fn pair_order(pair: &[(f64, f64)]) -> f64 {
    log_ratio(pair[0].1, pair[1].1) / log_ratio(pair[0].0, pair[1].0)
}

/// `ln(a/b)` of positive numbers; the quotient keeps the digits of close numbers, the difference
/// of logarithms serves where it leaves the range of a double.
pub(crate) fn log_ratio(a: f64, b: f64) -> f64 {
    let quotient = a / b;
    if quotient.is_normal() { ln(quotient) } else { ln(a) - ln(b) }
}

/// Least-squares slope of `ln e` on `ln h` over all levels, with its Student-t 95 % interval.
///
/// # Errors
/// [`Undefined`] when there are fewer than two levels or one of them cannot be used.
pub fn slope(series: &ErrorSeries) -> Result<SlopeFit, Undefined> {
    slope_of(&series.points()?)
}

/// [`slope`] of (size, error) points.
pub(crate) fn slope_of(points: &[(f64, f64)]) -> Result<SlopeFit, Undefined> {
    let count = points.len();
    let [first, _, ..] = points else {
        return Err(Undefined::TooFewLevels { levels: count, needed: 2 });
    };
    let logs = || points.iter().map(|(size, error)| (log_ratio(*size, first.0), log_ratio(*error, first.1)));
    let mean_x = logs().map(|(x, _)| x).sum::<f64>() / count as f64;
    let mean_y = logs().map(|(_, y)| y).sum::<f64>() / count as f64;
    let spread: f64 = logs().map(|(x, _)| powi(x - mean_x, 2)).sum();
    let order = logs().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum::<f64>() / spread;
    let residual: f64 = logs().map(|(x, y)| powi(y - mean_y - order * (x - mean_x), 2)).sum();
    let freedom = count - 2;
    let half_width = quantile_975(freedom).map(|t| t * (residual / freedom as f64 / spread).sqrt());
    let coefficient = exp(mean_y - order * (mean_x + ln(first.0)) + ln(first.1));
    Ok(SlopeFit { order, coefficient, half_width, levels: count })
}

/// The order on the finest [`WINDOW`] levels of a series: the slope of `ln e` on `ln h` over them.
///
/// # Errors
/// [`Undefined`] when there are fewer levels or one of the window cannot be used.
pub fn finest_order(series: &ErrorSeries) -> Result<f64, Undefined> {
    series.check_sizes()?;
    let levels = series.levels();
    let Some(window) = levels.last_chunk::<WINDOW>() else {
        return Err(Undefined::TooFewLevels { levels: levels.len(), needed: WINDOW });
    };
    Ok(slope(&ErrorSeries::new(window.to_vec()))?.order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn halvings(error: impl Fn(f64) -> f64) -> ErrorSeries {
        let sizes = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0].map(|cells| 1.0 / cells);
        ErrorSeries::from_pairs(&sizes.map(|size| (size, error(size))))
    }

    fn all_orders(series: &ErrorSeries) -> Vec<f64> {
        let mut orders: Vec<f64> = pair_orders(series).into_iter().map(Result::unwrap).collect();
        orders.extend([slope(series).unwrap().order, finest_order(series).unwrap()]);
        orders
    }

    #[test]
    fn the_interval_takes_curvature_for_noise() {
        let fit = slope(&halvings(|h| h * h + 8.0 * h.powi(3))).unwrap();
        // Computed apart: 2.254 ± 0.119 shuts out the true order, 2.
        assert!((fit.order - 2.254_128).abs() < 1e-6, "{fit:?}");
        assert!((fit.half_width.unwrap() - 0.119_408).abs() < 1e-5, "{fit:?}");
        let finest = finest_order(&halvings(|h| h * h + 8.0 * h.powi(3))).unwrap();
        assert!((finest - 2.096).abs() < 1e-3, "{finest}");
    }

    #[test]
    #[expect(
        clippy::unreadable_literal,
        clippy::excessive_precision,
        reason = "values as they were computed"
    )]
    fn the_quantile_matches_high_precision_values() {
        // mpmath, 40 digits: root of the regularised incomplete beta function.
        for (freedom, exact) in [
            (1, 12.706204736174705),
            (2, 4.3026527297494639),
            (3, 3.1824463052837096),
            (4, 2.7764451051977944),
            (5, 2.5705818356363155),
            (10, 2.2281388519862747),
            (40, 2.0210753903062734),
            (201, 1.9718365067798593),
        ] {
            let computed = quantile_975(freedom).unwrap();
            assert!((computed / exact - 1.0).abs() < 1e-9, "{freedom}: {computed} for {exact}");
        }
        assert_eq!(quantile_975(0), None);
    }

    #[test]
    fn the_interval_is_that_of_the_textbook() {
        // x = 0, 1, 2, 3 and y = 0, 1.1, 1.9, 3.2: slope 1.04 about (1.5, 1.55), t(2) = 4.302653.
        let points = [(0.0, 0.0), (1.0, 1.1), (2.0, 1.9), (3.0, 3.2)];
        let points = points.map(|(x, y): (f64, f64)| (x.exp(), y.exp()));
        let fit = slope(&ErrorSeries::from_pairs(&points)).unwrap();
        assert!((fit.order - 1.04).abs() < 1e-12);
        let line = |x: f64| 1.55 + 1.04 * (x - 1.5);
        let sum: f64 = [(0.0, 0.0), (1.0, 1.1), (2.0, 1.9), (3.0, 3.2)]
            .iter()
            .map(|(x, y): &(f64, f64)| (y - line(*x)).powi(2))
            .sum();
        let wanted = 4.302_652_729_911_275 * (sum / 2.0 / 5.0).sqrt();
        assert!((fit.half_width.unwrap() - wanted).abs() < 1e-9, "{fit:?}");
        let two = slope(&ErrorSeries::from_pairs(&points[..2])).unwrap();
        assert_eq!(two.half_width, None);
    }

    #[test]
    fn a_window_that_cannot_be_used_is_named() {
        let two = ErrorSeries::from_pairs(&[(0.2, 1.0), (0.1, 0.5)]);
        assert_eq!(finest_order(&two), Err(Undefined::TooFewLevels { levels: 2, needed: 3 }));
        let zero = ErrorSeries::from_pairs(&[(0.4, 1.0), (0.2, 0.5), (0.1, 0.0)]);
        assert_eq!(finest_order(&zero), Err(Undefined::Vanishing { size: 0.1 }));
        assert!(slope(&zero).is_err());
        let pairs = pair_orders(&zero);
        assert!(pairs[0].is_ok() && pairs[1].is_err());
        assert!(slope(&ErrorSeries::default()).is_err());
    }

    fn sizes() -> impl Strategy<Value = Vec<f64>> {
        (prop::collection::vec(1.1..4.0_f64, 2..7), -6.0..6.0_f64).prop_map(|(ratios, start)| {
            let mut sizes = vec![start.exp()];
            for ratio in ratios {
                sizes.push(sizes[sizes.len() - 1] / ratio);
            }
            sizes
        })
    }

    proptest! {
        #[test]
        fn exact_power_laws_return_their_order(sizes in sizes(), p in -3.0..6.0_f64, c in -20.0..20.0_f64) {
            let points: Vec<_> = sizes.iter().map(|h| (*h, c.exp() * h.powf(p))).collect();
            for order in all_orders(&ErrorSeries::from_pairs(&points)) {
                prop_assert!((order - p).abs() < 1e-12, "{} for {}", order, p);
            }
            let fit = slope(&ErrorSeries::from_pairs(&points)).unwrap();
            prop_assert!((fit.coefficient / c.exp() - 1.0).abs() < 1e-10);
        }

        #[test]
        fn scaling_errors_or_sizes_leaves_orders(
            sizes in sizes(),
            logs in prop::collection::vec(-8.0..8.0_f64, 7),
            factor in -30.0..30.0_f64,
        ) {
            let points: Vec<_> = sizes.iter().zip(&logs).map(|(h, e)| (*h, e.exp())).collect();
            let orders = all_orders(&ErrorSeries::from_pairs(&points));
            let k = factor.exp();
            let errors: Vec<_> = points.iter().map(|(h, e)| (*h, k * e)).collect();
            let meshes: Vec<_> = points.iter().map(|(h, e)| (k * h, *e)).collect();
            for scaled in [errors, meshes] {
                for (a, b) in orders.iter().zip(all_orders(&ErrorSeries::from_pairs(&scaled))) {
                    prop_assert!((a - b).abs() < 1e-10 * (1.0 + a.abs()), "{} became {}", a, b);
                }
            }
        }
    }
}
