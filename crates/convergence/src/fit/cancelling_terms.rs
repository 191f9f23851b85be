//! A converging error and a floor of opposite sign: `e = |C h^p − F|`.
//!
//! Such a series dips where the two cancel and then rises to the floor. The dip is a coincidence,
//! and the rise is no divergence.

use crate::fit::two_terms::both;
use crate::fit::{Exponent, minimum};
use crate::series::Undefined;
use oedometer_soil::elementary;

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
                (1.0 / error, elementary::powf(size / first_size, order) / error)
            };
            points.iter().enumerate().map(column).collect()
        };
        let solve = |order: f64| {
            let columns = columns(order);
            let (floor, coefficient) = both(&columns)?;
            let off = |(u, v): &(f64, f64)| elementary::powi(floor * u + coefficient * v - 1.0, 2);
            let square = columns.iter().map(off).sum::<f64>() / levels as f64;
            Some((-floor, coefficient, square.sqrt()))
        };
        let residual = |order| solve(order).map_or(f64::INFINITY, |found| found.2);
        let order = minimum(Exponent::Between(0.4, 6.0), residual);
        solve(order).map(|(floor, coefficient, residual)| (order, floor, coefficient, residual))
    };
    let (order, floor, coefficient, _) = [dip, dip + 1]
        .into_iter()
        .filter_map(fit)
        .filter(|found| found.1 > 0.0 && found.2 > 0.0 && found.3 < POOR)
        .min_by(|a, b| a.3.total_cmp(&b.3))
        .ok_or(Undefined::NotDetermined)?;
    Ok(CancellingFit {
        order,
        coefficient: coefficient * first_error / elementary::powf(first_size, order),
        floor: floor * first_error,
        cancels_at: first_size * elementary::powf(floor / coefficient, 1.0 / order),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
