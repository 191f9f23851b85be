//! What five and more levels show that the finest three hide: a floor, a term of lower order, a logarithm, an order that
//! runs away.
//!
//! Each candidate is fitted to all levels, with relative residuals. A candidate counts where it explains the levels far
//! better than a power alone and better than a term of higher order that dies out, which is harmless.

use crate::class::evaluable_series::EvaluableSeries;
use crate::class::{Class, Classification};
use crate::fit::Exponent;
use crate::fit::two_terms::two_coefficients;
use crate::orders::quantile_975;
use oedometer_soil::elementary::{exp, ln, powf, powi};
use oedometer_wording::{order, orders, rounded};

/// Levels from which on a second term shows beside the first.
const LEAST_LEVELS: usize = 5;

/// Shares of the finest error from which on a floor or a lower order governs it.
const GOVERNS: f64 = 0.2;

/// By how much a logarithm must lower the order at the finest level to count.
const LOWERS: f64 = 0.07;

/// A fit worse than this (root mean square, relative) explains nothing.
const POOR: f64 = 0.03;

/// Fits that are better than this are equal: errors are written with few digits.
const DIGITS: f64 = 1e-4;

/// A term of higher order with a larger share of the finest error than this has not died out.
const DYING: f64 = 0.3;

/// Scatters within this factor are equal, and the fit with fewer numbers is believed.
const EQUAL: f64 = 1.5;

/// Factor in the scatter by which a candidate must beat what is harmless.
const BETTER: f64 = 2.0;

/// Factor over the 95 % quantile of Fisher's F by which a candidate must beat a power alone: noise of a few per cent
/// on five levels is taken for a curve in one series of a hundred.
const CLEARLY: f64 = 5.0;

/// Factor from one change of the order to the next from which on it does not slow down.
const GROWS: f64 = 1.1;

/// How far an order has risen over four levels before it counts, beyond what noise of a per cent of the errors does.
const GONE: f64 = 0.1;

/// The second term of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Second {
    Floor,
    Lower,
    Higher,
    Logarithm,
}

/// `C h^p` with a second term, fitted to all levels.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    second: Second,
    /// Exponent `p` of the first term.
    first_order: f64,
    /// Exponent of the second term.
    second_order: f64,
    /// Coefficients of both, sizes in units of the coarsest.
    coefficients: [f64; 2],
    /// Sum of squares of the relative residuals.
    square: f64,
    /// Numbers fitted.
    numbers: usize,
}

impl Candidate {
    /// Scatter about the fit, with the degrees of freedom that it leaves.
    fn scatter(&self, levels: usize) -> f64 {
        let freedom = levels.saturating_sub(self.numbers).max(1) as f64;
        (self.square / freedom).sqrt().max(DIGITS)
    }

    /// Share of the second term in the finest error; `size` in units of the coarsest.
    fn share(&self, size: f64) -> f64 {
        let [first, second] = self.coefficients;
        let terms = [first * powf(size, self.first_order), second * powf(size, self.second_order)];
        terms[1] / (terms[0] + terms[1])
    }

    /// Whether the second term governs the finest level.
    fn governs(&self, finest: f64) -> bool {
        let [first, second] = self.coefficients;
        match self.second {
            Second::Floor | Second::Lower => first > 0.0 && second > 0.0 && self.share(finest) >= GOVERNS,
            Second::Logarithm => second > 0.0 && self.lowering(finest) >= LOWERS,
            Second::Higher => false,
        }
    }

    /// By how much a logarithm lowers the order at a size.
    fn lowering(&self, size: f64) -> f64 {
        let [first, second] = self.coefficients;
        second / (first - second * ln(size))
    }
}

/// The classification of the finest window, unless all levels show a second term that it hides.
pub fn judge_all_levels(case: &EvaluableSeries, window_class: Classification) -> Classification {
    let judged = matches!(window_class.class, Class::Asymptotic | Class::PreAsymptotic);
    if !judged || case.points.len() < LEAST_LEVELS {
        return window_class;
    }
    let classification = hidden(case).and_then(|candidate| classified(case, &candidate));
    classification
        .or_else(|| runs_away(case).filter(|_| window_class.class == Class::Asymptotic))
        .unwrap_or(window_class)
}

/// An order that rises faster from level to level: what settles slows down. A term of lower order and of the other sign
/// takes off more and more of the error, which changes sign below.
fn runs_away(case: &EvaluableSeries) -> Option<Classification> {
    let changes: Vec<f64> = case.pairs.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let [.., first, second, last] = *changes.as_slice() else { return None };
    let grows = |from: f64, to: f64| from > 0.0 && to > GROWS * from;
    (grows(first, second) && grows(second, last) && first + second + last >= GONE).then(|| {
        let reason = format!("the orders {} rise faster and faster", orders(&case.pairs));
        let classification = Classification::new(Class::PreAsymptotic, reason)
            .advise("add a finer level: a second term of opposite sign takes over");
        Classification { order: Some(case.order), ..classification }
    })
}

/// The second term that all levels show, where one governs the finest.
fn hidden(case: &EvaluableSeries) -> Option<Candidate> {
    let levels = Levels::new(case.points);
    let count = case.points.len();
    let size = |place: usize| case.points[place].0 / case.points[0].0;
    let [first, second, finest] = [0, 1, count - 1].map(size);
    // Without a formal order a term is the lower one where the higher one was seen first.
    let is_seen_later = |candidate: &Candidate| {
        candidate.second != Second::Lower
            || case.formal.is_some()
            || [first, second].iter().all(|h| candidate.share(*h) < 0.49)
    };
    let best = [Second::Floor, Second::Logarithm, Second::Lower]
        .into_iter()
        .filter_map(|second| levels.best(second, case.formal, case.order))
        .filter(|candidate| candidate.governs(finest) && is_seen_later(candidate))
        .min_by(|a, b| a.scatter(count).total_cmp(&b.scatter(count)))?;
    let scatter = best.scatter(count);
    let dies_out = |other: &Candidate| other.coefficients[0] > 0.0 && other.share(finest).abs() <= DYING;
    let harmless = levels.best(Second::Higher, case.formal, case.order).filter(dies_out);
    let is_better = harmless.is_none_or(|other| {
        BETTER * scatter < other.scatter(count)
            || best.numbers < other.numbers && scatter < EQUAL * other.scatter(count)
    });
    let quantile = quantile_975(count.checked_sub(best.numbers)?)?;
    let gain = (levels.power_alone() - best.square) / (best.numbers as f64 - 2.0).max(1.0);
    let is_clear = gain > CLEARLY * quantile * quantile * scatter * scatter;
    (scatter < POOR && is_better && is_clear).then_some(best)
}

/// Levels prepared for fits of powers.
struct Levels {
    /// Logarithms of the sizes, in units of the coarsest.
    logarithms: Vec<f64>,
    /// Errors in units of the coarsest.
    errors: Vec<f64>,
}

impl Levels {
    fn new(points: &[(f64, f64)]) -> Self {
        let first = points[0];
        let logarithms = points.iter().map(|point| ln(point.0 / first.0)).collect();
        Self { logarithms, errors: points.iter().map(|point| point.1 / first.1).collect() }
    }

    /// Each level's power of the size over its error.
    fn power(&self, exponent: f64) -> Vec<f64> {
        let level = |(log, error): (&f64, &f64)| exp(exponent * log) / error;
        self.logarithms.iter().zip(&self.errors).map(level).collect()
    }

    /// Sum of squares that the best single power leaves.
    fn power_alone(&self) -> f64 {
        let square = |p: f64| {
            let column = self.power(p);
            let (sum, square) = column.iter().fold((0.0, 0.0), |(sum, square), x| (sum + x, square + x * x));
            column.iter().map(|x| powi(x * sum / square - 1.0, 2)).sum::<f64>()
        };
        square(least(Exponent::Between(0.1, 12.0), square))
    }

    /// Coefficients of a power and a second term, and the sum of squares of the relative residuals.
    fn two_term_fit(&self, second: Second, p: f64, q: f64) -> Option<([f64; 2], f64)> {
        let first = self.power(p);
        let other: Vec<f64> = match second {
            Second::Logarithm => {
                first.iter().zip(&self.logarithms).map(|(power, log)| -log * power).collect()
            }
            _ => self.power(q),
        };
        let columns: Vec<(f64, f64)> = first.into_iter().zip(other).collect();
        let (a, b) = two_coefficients(&columns)?;
        Some(([a, b], columns.iter().map(|(u, v)| powi(a * u + b * v - 1.0, 2)).sum()))
    }

    /// The best fit with a second term of a kind.
    fn best(&self, second: Second, formal: Option<f64>, window_class: f64) -> Option<Candidate> {
        use Exponent::{Between, Fixed};
        let of_first = match (formal, second) {
            (Some(formal), Second::Floor) => Between(0.75 * formal, formal + 0.5),
            (Some(formal), _) => Fixed(formal),
            // The order that a logarithm lowers is a half or a whole one; a free one would fit any curve.
            (None, Second::Logarithm) => return self.best_logarithm(),
            (None, Second::Higher) => Between((window_class - 0.6).max(0.2), window_class + 0.6),
            (None, _) => Between(0.4, 6.0),
        };
        let of_second = |p: f64| match second {
            Second::Floor => Fixed(0.0),
            Second::Lower => Between(0.3_f64.min(0.5 * p), (p - 0.4).max(0.5 * p)),
            Second::Higher => Between(p + 0.5, p + 3.0),
            Second::Logarithm => Fixed(p),
        };
        let square = |p: f64, q: f64| self.two_term_fit(second, p, q).map_or(f64::INFINITY, |fit| fit.1);
        let best_second = |p: f64| least(of_second(p), |q| square(p, q));
        let first_order = least(of_first, |p| square(p, best_second(p)));
        let second_order = best_second(first_order);
        let (coefficients, square) = self.two_term_fit(second, first_order, second_order)?;
        let free = |exponent: Exponent| usize::from(matches!(exponent, Between(..)));
        let numbers = 2 + free(of_first) + free(of_second(first_order));
        Some(Candidate { second, first_order, second_order, coefficients, square, numbers })
    }

    /// The best logarithm of a half or a whole order.
    fn best_logarithm(&self) -> Option<Candidate> {
        let with = |halves: u32| {
            let p = 0.5 * f64::from(halves);
            let candidate = self.best(Second::Logarithm, Some(p), p)?;
            Some(Candidate { numbers: candidate.numbers + 1, ..candidate })
        };
        (1..=8).filter_map(with).min_by(|a, b| a.square.total_cmp(&b.square))
    }
}

/// The best exponent to four digits: a scan, then ever narrower ones about the best place.
fn least(exponent: Exponent, value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 12;
    let (mut from, mut to) = match exponent {
        Exponent::Fixed(exponent) => return exponent,
        Exponent::Between(from, to) => (from, to),
    };
    let (lowest, highest) = (from, to);
    let mut best = (f64::INFINITY, from);
    for _ in 0..6 {
        let width = (to - from) / f64::from(STEPS);
        for step in 0..=STEPS {
            let place = from + width * f64::from(step);
            let least = value(place);
            if least < best.0 {
                best = (least, place);
            }
        }
        (from, to) = ((best.1 - 1.2 * width).max(lowest), (best.1 + 1.2 * width).min(highest));
    }
    best.1
}

fn classified(case: &EvaluableSeries, candidate: &Candidate) -> Option<Classification> {
    let window = &case.pairs[case.pairs.len() - 2..];
    let window = format!("order {} on the three finest levels ({})", order(case.order), orders(window));
    let finest = case.finest().0 / case.coarsest().0;
    let percent = 100.0 * candidate.share(finest);
    let levels = case.points.len();
    match candidate.second {
        Second::Floor => {
            let reason = format!(
                "{window}, and over all {levels} levels an error plateau makes up {percent:.0} % of the finest error"
            );
            Some(case.limited(&reason))
        }
        Second::Lower => {
            let reason = format!(
                "{window}, and over all {levels} levels a term of order {} makes up {percent:.0} % of the finest error",
                order(candidate.second_order)
            );
            let advice = "look for a boundary, a recovery, an integrator or a refinement path of lower order";
            let classification = Classification::new(Class::Contaminated, reason).advise(advice);
            Some(Classification { order: Some(case.order), ..classification })
        }
        Second::Logarithm => {
            let reason = format!(
                "{window}, and all {levels} levels follow h^{} ln(1/h): the order is {} below its limit at size {}",
                order(candidate.first_order),
                order(candidate.lowering(finest)),
                rounded(case.finest().0)
            );
            let advice = "look for a singular point or a sudden load: a logarithmic term fades slowly";
            let classification = Classification::new(Class::PreAsymptotic, reason).advise(advice);
            Some(Classification { order: Some(case.order), ..classification })
        }
        Second::Higher => None,
    }
}
