//! A single level that contradicts the others: another case, output time or unit by mistake.
//!
//! The order on the finest window may not show it. It is named where no smooth curve goes through all levels and one goes
//! through all levels but this.

use crate::fit::approach_to_limit::fit_cancelling;
use crate::fit::two_terms::{TwoTerms, fit_two_terms};
use crate::fit::{Exponent, solve};
use oedometer_soil::elementary::{exp, ln};

/// A level that contradicts the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OddLevel {
    /// Size of the level.
    pub size: f64,
    /// Its error over the value that the others suggest.
    pub factor: f64,
}

/// Fewest levels: three that agree, and one that contradicts.
const LEAST_LEVELS: usize = 4;

/// A curve with a smaller residual than this (root mean square, of ln *e*) explains the levels.
const SMOOTH: f64 = 0.01;

/// Factor by which the best curve through all levels must be worse than that through the others.
const WORSE: f64 = 5.0;

/// Least factor, in ln *e*, by which a level is off: a fifth.
const OFF: f64 = 0.2;

/// Factor over the scatter of the others by which it must be off.
const CLEAR: f64 = 10.0;

/// Largest difference of the exponents of two terms; a term that vanishes after one level explains nothing.
const NEAR_EXPONENTS: f64 = 3.0;

/// The outlier among (size, error) points, if there is one.
pub(crate) fn odd_level(points: &[(f64, f64)]) -> Option<OddLevel> {
    if points.len() < LEAST_LEVELS {
        return None;
    }
    let mut without: Vec<(f64, OddLevel)> =
        (0..points.len()).filter_map(|place| without_level(points, place)).collect();
    without.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(scatter, odd), (next, _), ..] = *without.as_slice() else { return None };
    let off = ln(odd.factor).abs();
    let stands_alone = scatter * WORSE < next && off > OFF && off > CLEAR * scatter;
    // With noise in the others too, a curve through all levels need not be as good as without noise.
    (stands_alone && !is_smooth(points, SMOOTH.max(WORSE * scatter))).then_some(odd)
}

/// Scatter of all levels but one about their own curve, and how far that one is off it.
fn without_level(points: &[(f64, f64)], place: usize) -> Option<(f64, OddLevel)> {
    let (size, error) = points[place];
    let mut others = points.to_vec();
    others.remove(place);
    // One number less than there are levels, and no more than a curvature.
    let curve = Curve::through(&others, (others.len() - 1).min(3))?;
    Some((curve.scatter, OddLevel { size, factor: error / curve.at(size) }))
}

/// Whether a smooth curve goes through all levels within a scatter: curved, over a floor, through zero, or of two terms.
fn is_smooth(points: &[(f64, f64)], scatter: f64) -> bool {
    use Exponent::{Between, Fixed};
    let curved = || Curve::through(points, 3).is_some_and(|curve| curve.scatter <= scatter);
    let within = |fit: &TwoTerms| fit.residual <= scatter;
    let floor = || fit_two_terms(points, Fixed(0.0), Between(0.1, 12.0)).is_ok_and(|fit| within(&fit));
    let terms = || {
        let fit = fit_two_terms(points, Between(0.3, 6.0), Between(0.3, 8.0));
        fit.is_ok_and(|fit| within(&fit) && fit.high - fit.low <= NEAR_EXPONENTS)
    };
    curved() || floor() || fit_cancelling(points).is_ok() || terms()
}

/// A polynomial `ln e` of `ln h`.
struct Curve {
    /// Coefficients, the constant first; sizes in units of the first level's.
    coefficients: Vec<f64>,
    first: f64,
    /// Root mean square of what is left of ln *e*.
    scatter: f64,
}

impl Curve {
    /// The curve of up to three coefficients by least squares.
    fn through(points: &[(f64, f64)], coefficients: usize) -> Option<Self> {
        let first = points.first()?.0;
        let sizes: Vec<f64> = points.iter().map(|point| ln(point.0 / first)).collect();
        let power = |power: usize| match power {
            0 => vec![1.0; sizes.len()],
            1 => sizes.clone(),
            _ => sizes.iter().map(|size| size * size).collect(),
        };
        let columns: Vec<Vec<f64>> = (0..coefficients.min(3)).map(power).collect();
        let logs: Vec<f64> = points.iter().map(|point| ln(point.1)).collect();
        let (coefficients, square) = solve(&columns, &logs, &vec![1.0; points.len()])?;
        Some(Self { coefficients, first, scatter: (square / points.len() as f64).sqrt() })
    }

    fn at(&self, size: f64) -> f64 {
        let log = ln(size / self.first);
        exp(self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * log + coefficient))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(ratio: f64, levels: usize, error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0_i32..).take(levels).map(|level| 0.2 / ratio.powi(level)).map(|h| (h, error(h))).collect()
    }

    #[test]
    fn a_wrong_level_is_named_wherever_it_lies() {
        for (ratio, levels) in [(1.2, 4), (1.5, 5), (2.0, 4), (2.0, 5), (4.0, 4)] {
            for place in 0..levels {
                for factor in [0.3, 0.6, 1.6, 3.0] {
                    let mut points = points(ratio, levels, |h| h * h);
                    points[place].1 *= factor;
                    let Some(odd) = odd_level(&points) else {
                        // On the finest two levels a floor, or a passage through zero, may be as good an explanation.
                        assert!(place + 2 >= levels, "{ratio} {levels} {place} {factor}: not told");
                        continue;
                    };
                    assert_eq!(odd.size, points[place].0, "{ratio} {levels} {place} {factor}");
                    assert!((odd.factor / factor - 1.0).abs() < 1e-6, "{odd:?}");
                }
            }
        }
    }

    #[test]
    fn a_smooth_series_has_none() {
        let smooth: [fn(f64) -> f64; 9] = [
            |h| h * h,
            |h| h * h + 8.0 * h.powi(3),
            |h| h * h + 80.0 * h.powi(3),
            |h| h * h + 800.0 * h.powi(4),
            |h| h * h + 0.05 * h,
            |h| h * h + 2e-4,
            |h| h + 3e-2,
            |h| h * h * h.ln().abs(),
            |h| h * h / (1.0 + 90.0 * h * h),
        ];
        for ratio in [1.2, 2.0, 4.0] {
            for levels in 4..6 {
                for (number, error) in smooth.iter().enumerate() {
                    let odd = odd_level(&points(ratio, levels, error));
                    assert_eq!(odd, None, "{ratio} {levels} {number}");
                }
            }
        }
        assert_eq!(odd_level(&points(2.0, 3, |h| if h > 0.15 { 9.0 } else { h })), None);
    }
}
