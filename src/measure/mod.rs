//! From the outcome of a run to its record: errors against references, balances, oscillation, checks.

pub mod balances;
pub mod dimensionless_groups;
pub mod fields;
pub mod other_measures;
pub mod record;
pub mod record_checks;
pub mod round_off;
pub mod soundness;
pub mod statistics;
pub mod theory;
