//! A series that approaches a limit other than zero: `e = F + C h^p`, with `C` of either sign.
//!
//! Such errors grow under refinement, or pass through zero and grow again, and yet converge, only not
//! to the reference. The differences between levels fall with an order. Three levels have
//! one such order, and any limit fits them; it takes a fourth to confirm what three suggest.
//!
//! Errors without signs, `e = |C h^p − F|`, dip where the two terms cancel and then rise to the floor. The dip is a
//! coincidence, and the rise is not divergence.

use crate::fit::two_terms::two_coefficients;
use crate::fit::{Exponent, best_power, fit_powers, minimum, order_of_differences};
use crate::series::Undefined;
use oedometer_soil::elementary::{powf, powi};

/// Orders at which differences between levels may fall; slower ones do not approach a limit.
const ORDERS: (f64, f64) = (0.4, 12.0);

/// Share of its predicted step by which the finest level may miss the prediction.
const MISS: f64 = 0.5;

/// Share of the limit by which it may.
const NEAR: f64 = 0.01;

/// A limit with the way towards it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approach {
    /// `F`, in the unit of the values.
    pub limit: f64,
    /// `C`.
    coefficient: f64,
    /// `p`.
    pub order: f64,
}

/// What the values say of a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Limit {
    /// The finest level lies where the three before it said.
    Confirmed(Approach),
    /// The three finest levels say so, and no level confirms it.
    Suggested(Approach),
    /// The three finest levels are one value, within a hundredth.
    Reached,
}

impl Approach {
    /// The value at a size.
    pub fn at(&self, size: f64) -> f64 {
        self.limit + self.coefficient * powf(size, self.order)
    }

    /// The curve through three levels whose differences fall and keep their sign.
    fn through(levels: &[(f64, f64)]) -> Option<Self> {
        let [(h1, e1), (h2, e2), (h3, e3)] = *levels else { return None };
        let order = order_of_differences((e1 - e2) / (e2 - e3), h2 / h3, h1 / h2)?;
        // Sizes in units of the coarsest keep powers in range.
        let finest = powf(h3 / h1, order);
        let scaled = (e2 - e3) / (powf(h2 / h1, order) - finest);
        let approach = Self { limit: e3 - scaled * finest, coefficient: scaled / powf(h1, order), order };
        (ORDERS.0..=ORDERS.1).contains(&order).then_some(approach)
    }

    /// The best curve for more than three levels.
    fn fitted(levels: &[(f64, f64)]) -> Option<Self> {
        let first = levels.first()?.0;
        let scaled: Vec<_> = levels.iter().map(|(size, value)| (size / first, *value)).collect();
        let weights = vec![1.0; levels.len()];
        let order = best_power(&scaled, Exponent::Between(ORDERS.0, ORDERS.1), &weights);
        let (coefficients, _) = fit_powers(&scaled, &[order], &weights)?;
        Some(Self { limit: coefficients[0], coefficient: coefficients[1] / powf(first, order), order })
    }
}

/// The limit that values approach while they move away from zero or through it; `None` where they fall
/// towards zero or approach nothing.
pub(crate) fn limit_of(values: &[(f64, f64)]) -> Option<Limit> {
    let window = values.last_chunk::<3>()?;
    let [before, finest] = [window[1].1, window[2].1];
    let four = values.last_chunk::<4>();
    let crosses = window.iter().any(|level| level.1.signum() != finest.signum());
    let grows = finest.abs() > before.abs() || crosses;
    let left = values.iter().any(|level| level.1.abs() < 0.9 * finest.abs());
    let spread = window.iter().fold(0.0_f64, |most, level| most.max((level.1 - finest).abs()));
    if four.is_some() && (grows || left) && spread <= NEAR * finest.abs() {
        return Some(Limit::Reached);
    }
    if !grows {
        return None;
    }
    if let Some(four) = four
        && let Some(predicted) = Approach::through(&four[..3])
    {
        let step = predicted.at(four[3].0) - four[2].1;
        let miss = (finest - predicted.at(four[3].0)).abs();
        if miss <= (MISS * step.abs()).max(NEAR * predicted.limit.abs()) {
            return Approach::fitted(four).map(Limit::Confirmed);
        }
    }
    Approach::through(window).map(Limit::Suggested)
}

/// The fit of a dip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CancellingFit {
    /// Order `p` of the converging part.
    pub order: f64,
    /// Its coefficient `C`.
    pub coefficient: f64,
    /// The floor `F`.
    pub floor: f64,
    /// Size at which the two cancel.
    pub cancels_at: f64,
}

/// A fit worse than this (root mean square, relative) explains nothing.
const POOR: f64 = 0.03;

/// Fits `|C h^p − F|` to (size, error) points; five levels at least, for one more free choice
/// (where the sign changes) is made than numbers are fitted.
///
/// # Errors
/// [`Undefined`] where there are fewer, or one of them cannot be used.
pub(crate) fn fit_cancelling(points: &[(f64, f64)]) -> Result<CancellingFit, Undefined> {
    let levels = points.len();
    if levels < 5 {
        return Err(Undefined::TooFewLevels { levels, needed: 5 });
    }
    let (first_size, first_error) = points[0];
    let dip = (0..levels).min_by(|a, b| points[*a].1.total_cmp(&points[*b].1)).unwrap_or(0);
    let fit = |negative_from: usize| {
        let columns = |order: f64| -> Vec<(f64, f64)> {
            let column = |(index, (size, error)): (usize, &(f64, f64))| {
                let sign = if index < negative_from { 1.0 } else { -1.0 };
                let error = sign * error / first_error;
                (1.0 / error, powf(size / first_size, order) / error)
            };
            points.iter().enumerate().map(column).collect()
        };
        let solve = |order: f64| {
            let columns = columns(order);
            let (floor, coefficient) = two_coefficients(&columns)?;
            let off = |(u, v): &(f64, f64)| powi(floor * u + coefficient * v - 1.0, 2);
            let square = columns.iter().map(off).sum::<f64>() / levels as f64;
            Some((-floor, coefficient, square.sqrt()))
        };
        let residual = |order| solve(order).map_or(f64::INFINITY, |solution| solution.2);
        let order = minimum(Exponent::Between(0.4, 6.0), residual);
        solve(order).map(|(floor, coefficient, residual)| (order, floor, coefficient, residual))
    };
    let (order, floor, coefficient, _) = [dip, dip + 1]
        .into_iter()
        .filter_map(fit)
        .filter(|solution| solution.1 > 0.0 && solution.2 > 0.0 && solution.3 < POOR)
        .min_by(|a, b| a.3.total_cmp(&b.3))
        .ok_or(Undefined::NotDetermined)?;
    Ok(CancellingFit {
        order,
        coefficient: coefficient * first_error / powf(first_size, order),
        floor: floor * first_error,
        cancels_at: first_size * powf(floor / coefficient, 1.0 / order),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(errors: &[f64]) -> Vec<(f64, f64)> {
        (0..).zip(errors).map(|(level, error)| (0.1 * 0.5_f64.powi(level), *error)).collect()
    }

    #[test]
    fn a_known_limit_is_found_from_either_side_at_any_ratio() {
        let sizes: [f64; 4] = [1.0 / 10.0, 1.0 / 15.0, 1.0 / 40.0, 1.0 / 70.0];
        for (limit, coefficient) in [(3e-3, -0.4), (-3e-3, 0.4), (2e-4, 0.1), (-2e-4, -0.1)] {
            let levels = sizes.map(|h| (h, limit + coefficient * h.powf(1.7)));
            let approach = Approach::through(&levels[1..]).expect("an approach");
            assert!(
                (approach.limit / limit - 1.0).abs() < 1e-9 && (approach.order - 1.7).abs() < 1e-9,
                "{approach:?}"
            );
            assert!((approach.at(0.1) / levels[0].1 - 1.0).abs() < 1e-9, "{approach:?}");
            let fitted = Approach::fitted(&levels).expect("a fit");
            assert!((fitted.limit / limit - 1.0).abs() < 1e-6, "{fitted:?}");
        }
    }

    #[test]
    fn it_takes_a_fourth_level_to_confirm_a_limit() {
        let all = values(&[2.70e-5, 2.29e-3, 2.85e-3, 3.00e-3, 3.03e-3]);
        assert!(matches!(limit_of(&all[..3]), Some(Limit::Suggested(_))));
        for levels in [4, 5] {
            let Some(Limit::Confirmed(approach)) = limit_of(&all[..levels]) else {
                panic!("{levels}: {:?}", limit_of(&all[..levels]));
            };
            assert!((approach.limit - 3.04e-3).abs() < 3e-5, "{approach:?}");
        }
        // A fourth level that keeps on growing refutes what three said.
        assert!(!matches!(limit_of(&values(&[1.0, 2.0, 2.5, 4.0])), Some(Limit::Confirmed(_))));
        assert!(matches!(limit_of(&values(&[1.0, 2.0, 2.5, 2.5, 2.501, 2.499])), Some(Limit::Reached)));
    }

    #[test]
    fn errors_that_fall_or_grow_without_end_have_no_limit() {
        assert_eq!(limit_of(&values(&[4e-2, 1e-2, 2.5e-3, 6e-4])), None);
        assert_eq!(limit_of(&values(&[1e-2, 2.6e-3, 2.3e-3, 2.2e-3])), None);
        assert_eq!(limit_of(&values(&[1.0, 1.1, 1.2, 1.3, 1.4])), None);
        assert_eq!(limit_of(&values(&[1.0, 2.0, 4.0, 8.0])), None);
        assert_eq!(limit_of(&values(&[1.0, -0.5, 0.7, -0.4])), None);
        assert_eq!(limit_of(&values(&[1.0, 2.0])), None);
    }

    fn points(error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        [5.0, 10.0, 20.0, 40.0, 80.0, 160.0].map(|n| (1.0 / n, error(1.0 / n))).to_vec()
    }

    #[test]
    fn a_dip_on_either_side_of_the_change_of_sign_is_found() {
        for floor in [2e-4, 5e-4, 7e-4, 1.2e-4] {
            let fit = fit_cancelling(&points(|h| (3.0 * h * h - floor).abs())).unwrap();
            assert!((fit.order - 2.0).abs() < 1e-6, "{fit:?}");
            assert!((fit.floor / floor - 1.0).abs() < 1e-6, "{fit:?}");
            assert!((fit.coefficient / 3.0 - 1.0).abs() < 1e-5, "{fit:?}");
            assert!((fit.cancels_at - (floor / 3.0).sqrt()).abs() < 1e-7);
        }
    }

    #[test]
    fn a_blow_up_is_no_dip() {
        assert!(fit_cancelling(&points(|h| h * h + 1e-6 / h / h)).is_err());
        assert!(fit_cancelling(&points(|h| h * h)[..4]).is_err());
    }
}
