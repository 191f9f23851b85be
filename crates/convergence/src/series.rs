//! A series of errors over levels of refinement, and why a number derived from it may be undefined.

use thiserror::Error;

/// One level of refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesLevel {
    /// What is refined: cell size in m, time step in s, or any length that falls with refinement.
    pub size: f64,
    /// The error at this level; `None` where the run is missing.
    pub error: Option<f64>,
}

/// Errors over levels of refinement, from coarse to fine.
///
/// ```
/// use oedometer_convergence::{Class, Context, ErrorSeries, classify, finest_order};
///
/// let series = ErrorSeries::from_pairs(&[0.2, 0.1, 0.05, 0.025].map(|h| (h, 0.3 * h * h)));
/// assert!((finest_order(&series)? - 2.0).abs() < 1e-12);
/// let context = Context { formal_order: Some(2.0), ..Context::default() };
/// assert_eq!(classify(&series, &context).class, Class::Asymptotic);
/// # Ok::<(), oedometer_convergence::Undefined>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSeries {
    levels: Vec<SeriesLevel>,
}

/// Why an order or a fit has no value.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Undefined {
    /// There are not enough levels.
    #[error("{levels} levels are too few: {needed} are needed")]
    TooFewLevels {
        /// Levels there are.
        levels: usize,
        /// Levels needed.
        needed: usize,
    },
    /// A size is not a positive, finite number.
    #[error("the size of level {number} is not a positive, finite number")]
    BadSize {
        /// Number of the level from the coarsest, from 1.
        number: usize,
    },
    /// Two levels have the same size.
    #[error("two levels have the size {size}")]
    SameSize {
        /// The size.
        size: f64,
    },
    /// The run of a level is missing.
    #[error("the level of size {size} is missing")]
    Missing {
        /// Size of the level.
        size: f64,
    },
    /// An error is NaN or infinite.
    #[error("the error at size {size} is not finite")]
    NotFinite {
        /// Size of the level.
        size: f64,
    },
    /// An error is negative.
    #[error("the error at size {size} is negative")]
    Negative {
        /// Size of the level.
        size: f64,
    },
    /// An error is zero or below the range of normal numbers, and has no logarithm worth taking.
    #[error("the error at size {size} is zero or subnormal")]
    Vanishing {
        /// Size of the level.
        size: f64,
    },
    /// All values are equal, so that no difference shows an order.
    #[error("all values are equal")]
    EqualValues,
    /// A fit ran to the end of the range of orders searched: the data do not determine one.
    #[error("the data do not determine an order")]
    NotDetermined,
    /// The values do not approach a limit with any order.
    #[error("the values do not converge")]
    NotConverging,
}

impl ErrorSeries {
    /// A series of these levels, put in order from coarse to fine.
    pub fn new(mut levels: Vec<SeriesLevel>) -> Self {
        levels.sort_by(|a, b| b.size.total_cmp(&a.size));
        Self { levels }
    }

    /// A series without gaps from (size, error) pairs.
    pub fn from_pairs(pairs: &[(f64, f64)]) -> Self {
        let level = |&(size, error): &(f64, f64)| SeriesLevel { size, error: Some(error) };
        Self::new(pairs.iter().map(level).collect())
    }

    /// The levels from coarse to fine.
    pub fn levels(&self) -> &[SeriesLevel] {
        &self.levels
    }

    /// The level of this size, within a relative 1e-9.
    pub fn at(&self, size: f64) -> Option<&SeriesLevel> {
        self.levels.iter().find(|level| (level.size - size).abs() <= 1e-9 * size.abs())
    }

    /// Sizes and errors from coarse to fine, when every error is a positive normal number.
    ///
    /// # Errors
    /// The first obstacle: a bad or repeated size, a missing level, an error that is not a
    /// positive normal number.
    pub fn points(&self) -> Result<Vec<(f64, f64)>, Undefined> {
        self.check_sizes()?;
        self.levels.iter().map(|level| Ok((level.size, level.positive_error()?))).collect()
    }

    /// Checks that the sizes are positive, finite and distinct.
    ///
    /// # Errors
    /// [`Undefined::BadSize`] and [`Undefined::SameSize`].
    pub fn check_sizes(&self) -> Result<(), Undefined> {
        let is_bad = |level: &SeriesLevel| !(level.size.is_normal() && level.size > 0.0);
        if let Some(index) = self.levels.iter().position(is_bad) {
            return Err(Undefined::BadSize { number: index + 1 });
        }
        let same = self.levels.windows(2).find(|pair| pair[0].size <= pair[1].size * (1.0 + 1e-9));
        same.map_or(Ok(()), |pair| Err(Undefined::SameSize { size: pair[1].size }))
    }
}

impl SeriesLevel {
    /// The error as a positive normal number.
    ///
    /// # Errors
    /// Why it is none.
    pub fn positive_error(&self) -> Result<f64, Undefined> {
        let size = self.size;
        match self.error {
            None => Err(Undefined::Missing { size }),
            Some(error) if !error.is_finite() => Err(Undefined::NotFinite { size }),
            Some(error) if error < 0.0 => Err(Undefined::Negative { size }),
            Some(error) if !error.is_normal() => Err(Undefined::Vanishing { size }),
            Some(error) => Ok(error),
        }
    }
}

/// Sizes and values of either sign from coarse to fine.
///
/// # Errors
/// A bad or repeated size, or a value that is not finite.
pub(crate) fn finite_levels(levels: &[(f64, f64)]) -> Result<Vec<(f64, f64)>, Undefined> {
    let series = ErrorSeries::from_pairs(levels);
    series.check_sizes()?;
    let finite = |level: &SeriesLevel| level.error.filter(|value| value.is_finite());
    let pair = |level: &SeriesLevel| {
        Ok((level.size, finite(level).ok_or(Undefined::NotFinite { size: level.size })?))
    };
    series.levels.iter().map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_sorted_from_coarse_to_fine() {
        let series = ErrorSeries::from_pairs(&[(0.1, 1.0), (0.4, 3.0), (0.2, 2.0)]);
        assert_eq!(series.points().unwrap(), vec![(0.4, 3.0), (0.2, 2.0), (0.1, 1.0)]);
        assert_eq!(series.at(0.2).unwrap().error, Some(2.0));
        assert_eq!(series.at(0.3), None);
    }

    #[test]
    fn the_first_obstacle_is_named() {
        let points = |error| ErrorSeries::from_pairs(&[(1.0, 1.0), (0.5, error)]).points();
        assert_eq!(points(f64::NAN), Err(Undefined::NotFinite { size: 0.5 }));
        assert_eq!(points(f64::INFINITY), Err(Undefined::NotFinite { size: 0.5 }));
        assert_eq!(points(-1.0), Err(Undefined::Negative { size: 0.5 }));
        assert_eq!(points(0.0), Err(Undefined::Vanishing { size: 0.5 }));
        assert_eq!(points(1e-310), Err(Undefined::Vanishing { size: 0.5 }));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let series = ErrorSeries::from_pairs(&[(bad, 1.0)]);
            assert_eq!(series.points(), Err(Undefined::BadSize { number: 1 }));
        }
        let same = ErrorSeries::from_pairs(&[(0.5, 1.0), (0.5, 2.0)]);
        assert_eq!(same.points(), Err(Undefined::SameSize { size: 0.5 }));
        let gap = ErrorSeries::new(vec![SeriesLevel { size: 1.0, error: None }]);
        assert_eq!(gap.points(), Err(Undefined::Missing { size: 1.0 }));
    }
}
