//! From the outcome of a run to its record: errors against references, balances, oscillation, checks.

pub mod attached_record;
pub mod balances;
pub mod case_record;
pub mod dimensionless_groups;
pub mod fields;
pub mod known_references;
pub mod largest;
pub mod other_measures;
pub mod pressure_peak;
pub mod record_checks;
pub mod theory_curves;
pub mod wall_times;
