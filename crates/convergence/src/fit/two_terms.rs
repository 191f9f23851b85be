//! Least-squares fit of an error by two powers, `e = A h^a + B h^b`, with `A, B ≥ 0`.
//!
//! One fit distinguishes what bends a straight line on a log-log plot: a floor (`a = 0`), a term of
//! lower order that takes over (`a` below the order sought), and a term of higher order that has
//! not died out yet. Residuals are relative, `(model − e)/e`, so that every level counts alike.
//! The coefficients are eliminated (variable projection, Golub & Pereyra 1973); only exponents
//! are searched for.

use crate::fit::{Exponent, minimum};
use crate::series::Undefined;
use oedometer_soil::elementary;

/// Two powers fitted to an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TwoTerms {
    /// The lower exponent `a`.
    pub low: f64,
    /// The higher exponent `b`.
    pub high: f64,
    /// `A`, not negative.
    pub low_coefficient: f64,
    /// `B`, not negative.
    pub high_coefficient: f64,
    /// Root mean square of the relative residuals.
    pub residual: f64,
}

impl TwoTerms {
    /// Share of the lower-order term in the fitted error at a size, from 0 to 1.
    pub fn low_share(&self, size: f64) -> f64 {
        let low = self.low_coefficient * elementary::powf(size, self.low);
        low / (low + self.high_coefficient * elementary::powf(size, self.high))
    }

    /// Size at which both terms are equal; the lower order governs below it.
    pub fn crossover(&self) -> Option<f64> {
        let are_positive = self.low_coefficient > 0.0 && self.high_coefficient > 0.0;
        are_positive.then(|| {
            elementary::powf(self.low_coefficient / self.high_coefficient, 1.0 / (self.high - self.low))
        })
    }
}

/// Fits two powers to (size, error) points, both positive; where the range of the higher exponent
/// reaches down to the lower one, it is kept above it by at least `GAP`.
///
/// # Errors
/// [`Undefined::TooFewLevels`] when there are not more points than free numbers,
/// [`Undefined::NotDetermined`] when a coefficient leaves the range of a double.
pub(crate) fn fit_two_terms(
    points: &[(f64, f64)],
    low: Exponent,
    high: Exponent,
) -> Result<TwoTerms, Undefined> {
    let free = |exponent| usize::from(matches!(exponent, Exponent::Between(..)));
    let needed = 3 + free(low) + free(high);
    let (levels, [reference, ..]) = (points.len(), points) else {
        return Err(Undefined::TooFewLevels { levels: 0, needed });
    };
    if levels < needed {
        return Err(Undefined::TooFewLevels { levels, needed });
    }
    let scaled: Vec<_> = points.iter().map(|(h, e)| (h / reference.0, e / reference.1)).collect();
    let best_high = |low: f64| {
        let high = match high {
            Exponent::Fixed(high) => Exponent::Fixed(high),
            Exponent::Between(from, to) => Exponent::Between(from.max(low + GAP), to.max(low + GAP)),
        };
        minimum(high, |high| project(&scaled, low, high).residual)
    };
    let low = minimum(low, |low| project(&scaled, low, best_high(low)).residual);
    let fit = project(&scaled, low, best_high(low));
    let unscale =
        |coefficient: f64, exponent: f64| coefficient * reference.1 / elementary::powf(reference.0, exponent);
    let fit = TwoTerms {
        low_coefficient: unscale(fit.low_coefficient, fit.low),
        high_coefficient: unscale(fit.high_coefficient, fit.high),
        ..fit
    };
    let numbers = [fit.low_coefficient, fit.high_coefficient, fit.residual];
    if numbers.iter().all(|value| value.is_finite()) { Ok(fit) } else { Err(Undefined::NotDetermined) }
}

/// Closest the two exponents may come: nearer powers look the same over a few levels.
const GAP: f64 = 0.25;

/// The best coefficients for given exponents.
fn project(points: &[(f64, f64)], low: f64, high: f64) -> TwoTerms {
    let columns: Vec<_> =
        points.iter().map(|(h, e)| (elementary::powf(*h, low) / e, elementary::powf(*h, high) / e)).collect();
    let residual = |a: f64, b: f64| {
        let sum: f64 = columns.iter().map(|(u, v)| elementary::powi(a * u + b * v - 1.0, 2)).sum();
        (sum / columns.len() as f64).sqrt()
    };
    let alone = |pick: fn(&(f64, f64)) -> f64| {
        let (sum, square) = columns.iter().map(pick).fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
        sum / square
    };
    let candidates = [
        two_coefficients(&columns).filter(|(a, b)| *a >= 0.0 && *b >= 0.0),
        Some((alone(|column| column.0), 0.0)),
        Some((0.0, alone(|column| column.1))),
    ];
    // Of the corners of the non-negative quadrant, the one with the least residual.
    let mut best =
        TwoTerms { low, high, low_coefficient: 0.0, high_coefficient: 0.0, residual: f64::INFINITY };
    for (a, b) in candidates.into_iter().flatten() {
        let residual = residual(a, b);
        if residual < best.residual {
            best = TwoTerms { low_coefficient: a, high_coefficient: b, residual, ..best };
        }
    }
    best
}

/// Unconstrained least squares of `a u + b v = 1` by orthogonalisation.
pub(crate) fn two_coefficients(columns: &[(f64, f64)]) -> Option<(f64, f64)> {
    let norm = columns.iter().map(|(u, _)| u * u).sum::<f64>().sqrt();
    let along = columns.iter().map(|(u, v)| u / norm * v).sum::<f64>();
    let rest = || columns.iter().map(|(u, v)| v - along * u / norm);
    let square: f64 = rest().map(|w| w * w).sum();
    let b = rest().sum::<f64>() / square;
    let a = (columns.iter().map(|(u, _)| u / norm).sum::<f64>() - along * b) / norm;
    (a.is_finite() && b.is_finite()).then_some((a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        [5.0, 10.0, 20.0, 40.0, 80.0, 160.0].map(|n| (1.0 / n, error(1.0 / n))).to_vec()
    }

    #[test]
    fn two_known_powers_are_found_again() {
        for (low, high, a, b) in [(1.0, 2.0, 0.05, 1.0), (2.0, 3.0, 1.0, 8.0), (0.0, 2.0, 2e-4, 1.0)] {
            let data = points(|h| a * h.powf(low) + b * h.powf(high));
            let fit = fit_two_terms(&data, Exponent::Fixed(low), Exponent::Fixed(high)).unwrap();
            assert!((fit.low_coefficient / a - 1.0).abs() < 1e-12, "{fit:?}");
            assert!((fit.high_coefficient / b - 1.0).abs() < 1e-12, "{fit:?}");
            assert!(fit.residual < 1e-14);
        }
    }

    #[test]
    fn two_unknown_exponents_are_found_again() {
        let data = points(|h| 0.05 * h + h * h);
        let range = Exponent::Between(0.4, 6.0);
        let fit = fit_two_terms(&data, range, range).unwrap();
        assert!((fit.low - 1.0).abs() < 1e-5 && (fit.high - 2.0).abs() < 1e-5, "{fit:?}");
        assert!((fit.crossover().unwrap() - 0.05).abs() < 1e-5);
        assert!((fit.low_share(0.05) - 0.5).abs() < 1e-4);
    }

    #[test]
    fn the_exponents_keep_their_distance() {
        let data = points(|h| h.powi(2) * (1.0 + 0.05 * (70.0 * h).sin()));
        let fit = fit_two_terms(&data, Exponent::Between(1.5, 6.0), Exponent::Between(0.5, 2.0));
        let fit = fit.unwrap();
        assert!(fit.high >= fit.low + GAP - 1e-12, "{fit:?}");
    }

    #[test]
    fn a_negative_term_is_left_out() {
        let data = points(|h| h * h - 0.5 * h.powi(3));
        let fit = fit_two_terms(&data, Exponent::Fixed(2.0), Exponent::Fixed(3.0)).unwrap();
        assert_eq!(fit.high_coefficient, 0.0);
        assert!(fit.low_coefficient > 0.9 && fit.crossover().is_none());
    }

    #[test]
    fn too_few_points_are_refused() {
        let data = points(|h| h);
        let free = Exponent::Between(0.5, 3.0);
        let refused = fit_two_terms(&data[..4], free, free);
        assert_eq!(refused, Err(Undefined::TooFewLevels { levels: 4, needed: 5 }));
        assert!(fit_two_terms(&[], free, free).is_err());
        assert!(fit_two_terms(&data[..3], Exponent::Fixed(0.0), Exponent::Fixed(2.0)).is_ok());
    }
}
