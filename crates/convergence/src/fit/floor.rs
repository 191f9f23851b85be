//! The floor under a converging error, `e = C h^p + F`: its possible causes, which of them fits, and what to do about it.

use crate::fit::Exponent;
use crate::fit::bending_order::{Bend, explain};
use crate::fit::two_terms::{TwoTerms, fit_two_terms};
use crate::orders::{SlopeFit, quantile_975, slope_of};
use crate::series::{ErrorSeries, Undefined};
use oedometer_soil::elementary;
use oedometer_soil::elementary::{powf, powi};
use oedometer_wording::rounded;
use serde::{Deserialize, Serialize};

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

/// Kinds of limits that refining the mesh does not move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimiterKind {
    /// The time step.
    Step,
    /// The cell size, in a series over something else.
    Mesh,
    /// The number of points per cell.
    PointsPerCell,
    /// The accuracy of the reference solution.
    Reference,
    /// The equations solved are not those of the reference.
    Model,
    /// Round-off.
    RoundOff,
}

/// A candidate for the cause of a floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limiter {
    /// Its kind.
    pub kind: LimiterKind,
    /// Its name in words, such as "the water's storage"; for a step rule, what one would lower.
    pub name: String,
    /// The floor it is known to cause, in the unit of the errors.
    pub magnitude: Option<f64>,
    /// The order at which the floor falls when the cause is refined; 1 where unknown.
    pub order: Option<f64>,
}

impl Limiter {
    /// A candidate of unknown height and order.
    pub fn new(kind: LimiterKind, name: &str) -> Self {
        Self { kind, name: name.to_owned(), magnitude: None, order: None }
    }
}

/// A floor and a candidate agree when they are within this factor.
const AGREEMENT: f64 = 3.0;

/// The candidate that fits a floor: the nearest in height, or the only one of unknown height.
pub(crate) fn identify(floor: f64, candidates: &[Limiter]) -> Option<&Limiter> {
    let distance = |candidate: &&Limiter| {
        let ratio = elementary::ln(candidate.magnitude? / floor).abs();
        ratio.is_finite().then_some(ratio)
    };
    let near = candidates
        .iter()
        .filter_map(|candidate| Some((distance(&candidate)?, candidate)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(distance, _)| *distance <= elementary::ln(AGREEMENT));
    if let Some((_, candidate)) = near {
        return Some(candidate);
    }
    let mut unknown = candidates.iter().filter(|candidate| candidate.magnitude.is_none());
    match (unknown.next(), unknown.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    }
}

/// What to change so that the floor falls to `target`, or how to find out what causes it.
pub(crate) fn advice(
    floor: f64,
    target: Option<f64>,
    limiter: Option<&Limiter>,
    candidates: &[Limiter],
) -> String {
    let Some(limiter) = limiter else {
        let names: Vec<_> = candidates.iter().map(|candidate| candidate.name.as_str()).collect();
        let suspects = if names.is_empty() {
            "the time step, the points per cell, the reference and the model".to_owned()
        } else {
            names.join(", ")
        };
        return format!("no known cause fits: vary {suspects}, one at a time");
    };
    let order = limiter.order.filter(|order| order.is_finite() && *order > 0.0).unwrap_or(1.0);
    let factor = target.map_or(4.0, |target| elementary::powf(floor / target, 1.0 / order));
    // Rounded up to a power of two, as people halve things.
    let factor = elementary::exp2(elementary::log2(factor.clamp(2.0, 1e9)).ceil());
    match limiter.kind {
        LimiterKind::Step => format!("lower {} by {factor}", limiter.name),
        LimiterKind::Mesh => format!("refine the mesh by {factor}"),
        LimiterKind::PointsPerCell => format!("raise the points per cell by {factor}"),
        LimiterKind::Reference => {
            let accuracy = rounded(target.unwrap_or(0.1 * floor));
            format!("use a reference that is accurate to {accuracy}, or stop refining")
        }
        LimiterKind::Model => format!(
            "compare the run with the reference for its own equations: {} makes the difference",
            limiter.name
        ),
        LimiterKind::RoundOff => "drop the finest levels: they show round-off".to_owned(),
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
        assert_eq!(hidden_floor(&ErrorSeries::from_pairs(&levels), None), 0.0);
    }

    #[test]
    fn a_floor_that_bends_a_series_and_does_not_govern_it_is_hidden() {
        // A tenth of the finest error: the order falls from level to level, and the class is still that of the slope.
        let hidden =
            |error: fn(f64) -> f64, formal| hidden_floor(&ErrorSeries::from_pairs(&points(error)), formal);
        for formal in [None, Some(2.0)] {
            let floor = hidden(|h| h * h + 4e-6, formal);
            assert!((floor / 4e-6 - 1.0).abs() < 1e-6, "{formal:?}: {floor:e}");
            assert_eq!(hidden(|h| h * h, formal), 0.0);
        }
    }

    #[test]
    fn series_without_an_order_are_undefined() {
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

    fn candidate(kind: LimiterKind, magnitude: Option<f64>) -> Limiter {
        Limiter { kind, name: format!("{kind:?}"), magnitude, order: None }
    }

    #[test]
    fn the_nearest_candidate_is_taken_and_a_far_one_is_not() {
        let step = candidate(LimiterKind::Step, Some(2e-4));
        let model = candidate(LimiterKind::Model, Some(5e-5));
        let candidates = [step.clone(), model.clone()];
        assert_eq!(identify(1.5e-4, &candidates), Some(&step));
        assert_eq!(identify(6e-5, &candidates), Some(&model));
        assert_eq!(identify(1e-2, &candidates), None);
        let unknown = candidate(LimiterKind::PointsPerCell, None);
        assert_eq!(identify(1e-2, &[step.clone(), unknown.clone()]), Some(&unknown));
        assert_eq!(identify(1e-2, &[unknown.clone(), unknown]), None);
        let nonsense = candidate(LimiterKind::Step, Some(f64::NAN));
        assert_eq!(identify(1e-2, &[nonsense]), None);
    }

    #[test]
    fn the_advice_counts_with_the_order_of_the_cause() {
        let mut step = candidate(LimiterKind::Step, None);
        step.name = "the time step".to_owned();
        assert_eq!(advice(4e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 4");
        assert_eq!(advice(5e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 8");
        step.order = Some(2.0);
        assert_eq!(advice(4e-4, Some(1e-4), Some(&step), &[]), "lower the time step by 2");
        assert_eq!(advice(4e-4, None, Some(&step), &[]), "lower the time step by 4");
        assert!(advice(1.0, None, None, &[step]).contains("the time step"));
    }
}
