//! Convergence in numbers only: series of errors, observed orders, fits, classes and uncertainty. Knows no
//! solver, no study and no record.

pub mod class;
pub mod fit;
pub mod limiter;
pub mod orders;
pub mod pareto;
pub mod series;
pub mod series_demand;
pub mod student;
pub mod uncertainty;
