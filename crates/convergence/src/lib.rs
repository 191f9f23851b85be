//! Convergence in numbers only: series of errors, observed orders, fits, classes and uncertainty.
//!
//! The crate knows no solver, no study and no record. Every method has its source:
//!
//! | item | what it does | source |
//! | :-- | :-- | :-- |
//! | [`pair_orders`], [`slope`], [`finest_order`] | observed orders, with a Student-t interval | least squares on logarithms; Oberkampf & Roy (2010), *Verification and Validation in Scientific Computing* |
//! | [`classify`] | class of a series, before any order is quoted | the rules are listed at [`classify`] |
//! | [`hidden_floor`] | floor of `e = C h^p + F` | variable projection (Golub & Pereyra 1973), F-test |
//! | [`ValueSeries::uncertainty`] | uncertainty of a value without an exact solution | grid convergence index: Roache (1998), Celik et al. (2008); least squares: Eça & Hoekstra (2014) |
//! | [`reached`] | level from which on a tolerance is kept, and whether a finer one confirms it: the rule of every recommendation | – |
//! | [`front`] | Pareto front of error and cost | – |
//! | [`SeriesDemand`] | what a study expects of a series | – |

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod class;
mod demand;
mod fit;
mod orders;
mod pareto;
mod reached;
mod series;
mod uncertainty;

pub use class::{Class, Classification, Context, FLOOR_LEVELS, Floor, classify};
pub use demand::{DemandProblem, ErrorBound, FloorBand, KnownFailure, OrderBand, SeriesDemand};
pub use fit::floor::{Limiter, LimiterKind, hidden_floor};
pub use orders::{SlopeFit, WINDOW, finest_order, pair_orders, slope};
pub use pareto::{CostPoint, ParetoChange, front};
pub use reached::{Reached, reached};
pub use series::{ErrorSeries, SeriesLevel, Undefined};
pub use uncertainty::{
    Behaviour, ErrorModel, Estimator, GridConvergence, GridUncertainty, LeastSquaresUncertainty,
    NumericalUncertainty, ThreeGrids, ValueSeries,
};

/// The example of the front page, run as a test.
#[doc = include_str!("../README.md")]
#[cfg(doctest)]
struct ReadmeExample;

#[cfg(test)]
mod tests {
    mod classes;
    mod known_truth;
    mod second_opinion;
    mod whole_answers;
}
