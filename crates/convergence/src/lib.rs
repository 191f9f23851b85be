//! Convergence in numbers only: series of errors, observed orders, fits, classes and uncertainty. Knows no
//! solver, no study and no record.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod class;
pub mod fit;
pub mod limiter;
pub mod orders;
pub mod pareto;
pub mod series;
pub mod series_demand;
pub mod student;
pub mod uncertainty;

#[cfg(test)]
mod tests {
    mod classes;
    mod known_truth;
    mod second_opinion;
}
