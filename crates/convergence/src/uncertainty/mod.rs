//! Numerical uncertainty of a value that has no exact solution, from refinement alone.
//!
//! Behaviour is decided first. Four levels and more are fitted by least squares (Eça & Hoekstra
//! 2014); three give the grid convergence index (Roache 1998; Celik et al. 2008). A value that
//! diverges, or that is equal on all levels, has no uncertainty that could pass a test.

mod eca_hoekstra;
mod grid_convergence;

pub use eca_hoekstra::{ErrorModel, GridUncertainty, LeastSquaresUncertainty};
pub use grid_convergence::{Behaviour, GridConvergence, ThreeGrids};

use crate::series::{ErrorSeries, SeriesLevel, Undefined};
pub(crate) use eca_hoekstra::least_squares_uncertainty;
use grid_convergence::SAFETY_ASSUMED;
pub(crate) use grid_convergence::three_grids;
use serde::{Deserialize, Serialize};

/// Levels that an index needs.
const LEAST_LEVELS: usize = 3;

/// One value over levels of refinement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueSeries {
    /// Sizes and values; `None` where a run has none.
    levels: Vec<(f64, Option<f64>)>,
}

/// Where the uncertainty comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// Least squares over all levels (Eça & Hoekstra 2014).
    LeastSquares,
    /// Grid convergence index of the finest three levels (Celik et al. 2008).
    GridConvergenceIndex,
    /// Three times the range of three values that go up and down (Eça & Hoekstra 2009).
    Range,
}

/// The numerical uncertainty of a value, with what it is derived from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NumericalUncertainty {
    /// Sizes and values from coarse to fine.
    pub values: Vec<(f64, f64)>,
    /// The finest three levels, classified, with their index where they converge.
    pub finest_three: ThreeGrids,
    /// Least squares over all levels, where there are enough.
    pub least_squares: Option<LeastSquaresUncertainty>,
    /// Where `uncertainty` comes from.
    pub estimator: Estimator,
    /// Uncertainty of the finest value, in its unit, with 95 % coverage intended.
    pub uncertainty: f64,
    /// Value at size zero, where there is one.
    pub extrapolated: Option<f64>,
    /// Order with which the values approach it, on the finest three levels.
    pub order: Option<f64>,
}

impl ValueSeries {
    /// The values of levels, in any order.
    pub fn new(mut levels: Vec<(f64, Option<f64>)>) -> Self {
        levels.sort_by(|a, b| b.0.total_cmp(&a.0));
        Self { levels }
    }

    /// Difference of each level from the next finer one, with the size of the coarser. Differences fall with the order
    /// of the values; those of values that go up and down change sign.
    pub fn signed_differences(&self) -> Vec<(f64, Option<f64>)> {
        let difference = |pair: &[(f64, Option<f64>)]| {
            (pair[0].0, pair[0].1.zip(pair[1].1).map(|(coarse, fine)| coarse - fine))
        };
        self.levels.windows(2).map(difference).collect()
    }

    /// The absolute differences, as a series of errors.
    pub fn differences(&self) -> ErrorSeries {
        let level = |(size, error): (f64, Option<f64>)| SeriesLevel { size, error: error.map(f64::abs) };
        ErrorSeries::new(self.signed_differences().into_iter().map(level).collect())
    }

    /// The uncertainty of the finest value, by the formal order of the method.
    ///
    /// # Errors
    /// [`Undefined`] for fewer than three levels, missing ones, bad sizes, values that are not finite, equal values,
    /// and values that do not converge.
    pub fn uncertainty(&self, formal_order: f64) -> Result<NumericalUncertainty, Undefined> {
        let values = self
            .levels
            .iter()
            .map(|(size, value)| Ok((*size, value.ok_or(Undefined::Missing { size: *size })?)))
            .collect::<Result<Vec<_>, Undefined>>()?;
        let [.., third, second, finest] = values.as_slice() else {
            return Err(Undefined::TooFewLevels { levels: values.len(), needed: LEAST_LEVELS });
        };
        let finest_three = three_grids([*third, *second, *finest], Some(formal_order))?;
        let index = finest_three.estimate;
        let least_squares = match finest_three.behaviour {
            Behaviour::Equal => return Err(Undefined::EqualValues),
            Behaviour::Divergent => return Err(Undefined::NotConverging),
            Behaviour::Monotone | Behaviour::Oscillatory if values.len() == LEAST_LEVELS => None,
            Behaviour::Monotone | Behaviour::Oscillatory => {
                Some(least_squares_uncertainty(&values, formal_order)?)
            }
        };
        let fitted = least_squares.as_ref().and_then(|fit| Some((fit.grids.last()?, fit.extrapolated)));
        let (estimator, uncertainty, extrapolated) = match (fitted, &index) {
            (Some((grid, limit)), _) => (Estimator::LeastSquares, grid.uncertainty, Some(limit)),
            (None, Some(index)) => {
                (Estimator::GridConvergenceIndex, index.index_fine, Some(index.extrapolated))
            }
            (None, None) => (Estimator::Range, SAFETY_ASSUMED * finest_three.range, None),
        };
        Ok(NumericalUncertainty {
            estimator,
            uncertainty,
            extrapolated,
            order: index.map(|index| index.order),
            finest_three,
            least_squares,
            values,
        })
    }
}

impl NumericalUncertainty {
    /// The value of the finest level.
    pub fn finest(&self) -> f64 {
        self.values.last().map_or(f64::NAN, |level| level.1)
    }

    /// Uncertainty over the size of the finest value; not finite where that is zero.
    pub fn relative(&self) -> f64 {
        self.uncertainty / self.finest().abs()
    }
}

impl Estimator {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::LeastSquares => "least squares",
            Self::GridConvergenceIndex => "index of three levels",
            Self::Range => "range of three levels",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn estimate(sizes: &[f64], value: impl Fn(f64) -> f64) -> Result<NumericalUncertainty, Undefined> {
        ValueSeries::new(sizes.iter().map(|h| (*h, Some(value(*h)))).collect()).uncertainty(2.0)
    }

    const FOUR: [f64; 4] = [0.25, 0.125, 0.0625, 0.03125];

    proptest! {
        /// The estimate must cover the unknown error: here the error is known.
        #[test]
        fn the_uncertainty_covers_the_true_error(
            exact in 0.5..2.0_f64, constant in -1.0..1.0_f64, bend in -0.2..0.2_f64, levels in 3..=4_usize,
        ) {
            prop_assume!(constant.abs() > 0.05);
            let value = |h: f64| exact + constant * (h * h + bend * h * h * h);
            let uncertainty = estimate(&FOUR[..levels], value);
            let uncertainty = uncertainty.expect("it converges");
            let error = (uncertainty.finest() - exact).abs();
            prop_assert!(uncertainty.uncertainty >= error, "{} for {error}", uncertainty.uncertainty);
            prop_assert!(uncertainty.uncertainty <= 4.0 * error, "{} for {error}", uncertainty.uncertainty);
        }

        #[test]
        fn differences_of_a_power_law_have_its_order(order in 0.6..3.0_f64, constant in 0.1..2.0_f64) {
            let values = FOUR.map(|h| (h, Some(1.0 + constant * h.powf(order)))).to_vec();
            let points = ValueSeries::new(values).differences().points().expect("numbers");
            for pair in points.windows(2) {
                prop_assert!(((pair[0].1 / pair[1].1).log2() - order).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_estimator_follows_the_levels_and_the_behaviour() {
        let smooth = |h: f64| 1.0 + h * h;
        assert_eq!(
            estimate(&FOUR[..3], smooth).map(|uncertainty| uncertainty.estimator),
            Ok(Estimator::GridConvergenceIndex)
        );
        assert_eq!(
            estimate(&FOUR, smooth).map(|uncertainty| uncertainty.estimator),
            Ok(Estimator::LeastSquares)
        );
        let to_and_fro = |h: f64| if h == 0.125 { 0.9 } else { 1.0 + h };
        assert_eq!(
            estimate(&FOUR[..3], to_and_fro).map(|uncertainty| uncertainty.estimator),
            Ok(Estimator::Range)
        );
    }

    /// Values on a way of first or second order whose middle one is off, so that they go to and fro: half their range
    /// misses the error of the finest by up to a factor of 4.5, three times the range covers it.
    #[test]
    fn three_oscillating_values_are_covered() {
        let (mut cases, mut by_half_the_range) = (0, 0);
        for ratio in [1.2, 1.5, 2.0_f64, 4.0] {
            for order in [1, 2] {
                for off in [-3.0, -1.0, -0.6, -0.3, 0.3, 0.6, 1.0, 3.0] {
                    let sizes = [ratio * ratio, ratio, 1.0];
                    let value = |h: f64| 5.0 + h.powi(order) * if h == ratio { 1.0 + off } else { 1.0 };
                    let Ok(uncertainty) = estimate(&sizes, value) else { continue };
                    if uncertainty.finest_three.behaviour != Behaviour::Oscillatory {
                        continue;
                    }
                    assert_eq!(uncertainty.estimator, Estimator::Range);
                    let error = (uncertainty.finest() - 5.0).abs();
                    assert!(
                        uncertainty.uncertainty >= error,
                        "{ratio} {order} {off}: {}",
                        uncertainty.uncertainty
                    );
                    cases += 1;
                    by_half_the_range += usize::from(0.5 * uncertainty.finest_three.range >= error);
                }
            }
        }
        assert!(cases > 30 && by_half_the_range < cases / 2 + 10, "{by_half_the_range} of {cases}");
    }

    #[test]
    fn unusable_values_have_no_uncertainty_and_a_reason() {
        assert_eq!(estimate(&FOUR, |_| 1.0), Err(Undefined::EqualValues));
        assert_eq!(estimate(&FOUR, |h| 1.0 / h), Err(Undefined::NotConverging));
        assert_eq!(estimate(&FOUR[..2], |h| h), Err(Undefined::TooFewLevels { levels: 2, needed: 3 }));
        assert!(matches!(
            estimate(&FOUR, |h| if h == 0.125 { f64::NAN } else { h }),
            Err(Undefined::NotFinite { .. })
        ));
        let hole = ValueSeries::new(vec![(0.5, Some(1.0)), (0.25, None), (0.125, Some(2.0))]);
        assert_eq!(hole.uncertainty(2.0), Err(Undefined::Missing { size: 0.25 }));
        assert_eq!(hole.differences().levels()[0].error, None);
        assert!(!estimate(&FOUR, |h| h * h).expect("it converges").relative().is_nan());
    }
}
