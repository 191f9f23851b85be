//! Why an observed order falls under refinement: which second term bends the line.
//!
//! The candidates are fits of two powers with as many free numbers as the levels allow; the one
//! with the least residual is the explanation, if it is good at all.

use crate::fit::Exponent;
use crate::fit::two_terms::{TwoTerms, fit_two_terms};

/// The second term that explains a falling order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bend {
    /// A floor: the lower exponent is 0.
    Floor(TwoTerms),
    /// A term of lower order than the one sought, or than the one seen on the coarse levels.
    Lower(TwoTerms),
    /// A term of higher order that has not died out; the lower one is the order sought.
    Higher(TwoTerms),
}

/// A fit worse than this (root mean square, relative) explains nothing.
const POOR: f64 = 0.05;

/// Lowest exponent distinguished from a floor.
const LEAST_ORDER: f64 = 0.3;

/// A second term with a smaller share of the finest error than this does not count.
const LEAST_SHARE: f64 = 0.01;

impl Bend {
    /// The fit, whatever it says.
    pub fn terms(&self) -> &TwoTerms {
        match self {
            Self::Floor(terms) | Self::Lower(terms) | Self::Higher(terms) => terms,
        }
    }
}

/// The best explanation of a falling order, with the formal order where it is known.
pub(crate) fn explain(points: &[(f64, f64)], formal: Option<f64>) -> Option<Bend> {
    let best = match formal {
        Some(formal) => about_formal(points, formal),
        None => without_formal(points),
    };
    best.filter(|bend| bend.terms().residual <= POOR)
}

fn about_formal(points: &[(f64, f64)], formal: f64) -> Option<Bend> {
    use Exponent::{Between, Fixed};
    let fit = |low, high| fit_two_terms(points, low, high).ok();
    // Three levels leave one residual to two coefficients; a fourth frees one exponent.
    let free = points.len() > 3;
    let floor_high = if free { Between(0.75 * formal, formal + 0.5) } else { Fixed(formal) };
    let next_low = if formal >= 1.5 { formal - 1.0 } else { 0.5 * formal };
    let lower_low = if free { Between(LEAST_ORDER, formal - 0.4) } else { Fixed(next_low) };
    let higher = if free { Between(formal + 0.4, formal + 4.0) } else { Fixed(formal + 1.0) };
    let has_lower = formal - 0.4 > LEAST_ORDER;
    let candidates = [
        fit(Fixed(0.0), floor_high).map(Bend::Floor),
        has_lower.then(|| fit(lower_low, Fixed(formal)).map(Bend::Lower)).flatten(),
        fit(Fixed(formal), higher).map(Bend::Higher),
    ];
    // With a second term of nothing all three are the same single power, and round-off would
    // choose among them.
    let finest = points.last()?.0;
    let real = |bend: &Bend| match bend {
        Bend::Floor(terms) | Bend::Lower(terms) => terms.low_share(finest) > LEAST_SHARE,
        Bend::Higher(_) => true,
    };
    let residual = |bend: &Bend| bend.terms().residual;
    candidates.into_iter().flatten().filter(real).min_by(|a, b| residual(a).total_cmp(&residual(b)))
}

/// Without a formal order the higher power counts as sought where it was seen first: it governs
/// the two coarsest levels at least.
fn without_formal(points: &[(f64, f64)]) -> Option<Bend> {
    let floor = fit_two_terms(points, Exponent::Fixed(0.0), Exponent::Between(0.4, 8.0)).ok();
    let low = Exponent::Between(0.4, 6.0);
    let powers = fit_two_terms(points, low, Exponent::Between(0.4, 8.0)).ok();
    match (floor, powers) {
        // The floor has one free number less, and is believed until clearly worse.
        (Some(floor), Some(powers)) if powers.residual < 0.5 * floor.residual => {
            let seen_first = points.iter().filter(|(h, _)| powers.low_share(*h) < 0.49).count() > 1;
            Some(if seen_first { Bend::Lower(powers) } else { Bend::Higher(powers) })
        }
        (Some(floor), _) => Some(Bend::Floor(floor)),
        (None, _) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(error: impl Fn(f64) -> f64, levels: usize) -> Vec<(f64, f64)> {
        (0..levels)
            .map(|level| 0.2 / 2_f64.powi(i32::try_from(level).unwrap()))
            .map(|h| (h, error(h)))
            .collect()
    }

    #[test]
    fn the_second_term_is_found_with_and_without_a_formal_order() {
        for formal in [None, Some(2.0)] {
            for levels in [5, 6, 7] {
                let bend = |error: fn(f64) -> f64| explain(&points(error, levels), formal);
                let floor = bend(|h| h * h + 2e-4);
                assert!(matches!(floor, Some(Bend::Floor(_))), "{formal:?} {levels}: {floor:?}");
                let lower = bend(|h| h * h + 0.05 * h);
                assert!(matches!(lower, Some(Bend::Lower(_))), "{formal:?} {levels}: {lower:?}");
                let higher = bend(|h| h * h + 8.0 * h.powi(3));
                assert!(matches!(higher, Some(Bend::Higher(_))), "{formal:?} {levels}: {higher:?}");
            }
        }
    }

    #[test]
    fn three_levels_suffice_where_the_formal_order_is_known() {
        let bend = |error: fn(f64) -> f64| explain(&points(error, 3), Some(2.0));
        assert!(matches!(bend(|h| h * h + 2e-3), Some(Bend::Floor(_))));
        assert!(matches!(bend(|h| h * h + 0.05 * h), Some(Bend::Lower(_))));
        assert!(matches!(bend(|h| h * h + 8.0 * h.powi(3)), Some(Bend::Higher(_))));
    }

    #[test]
    fn a_series_that_no_second_term_fits_is_not_explained() {
        let mut data = points(|h| h * h, 6);
        for (point, factor) in data.iter_mut().zip([1.0, 0.3, 2.0, 0.5, 1.0, 2.0]) {
            point.1 *= factor;
        }
        assert_eq!(explain(&data, Some(2.0)), None);
        assert_eq!(explain(&data, None), None);
    }

    #[test]
    fn noise_of_two_per_cent_does_not_change_the_answer() {
        let noise = [0.02, -0.015, 0.01, -0.02, 0.02, -0.01];
        let noisy = |error: fn(f64) -> f64| {
            let mut data = points(error, 6);
            for (point, noise) in data.iter_mut().zip(noise) {
                point.1 *= 1.0 + noise;
            }
            explain(&data, Some(2.0))
        };
        assert!(matches!(noisy(|h| h * h + 2e-4), Some(Bend::Floor(_))));
        assert!(matches!(noisy(|h| h * h + 0.05 * h), Some(Bend::Lower(_))));
        assert!(matches!(noisy(|h| h * h + 8.0 * h.powi(3)), Some(Bend::Higher(_))));
    }
}
