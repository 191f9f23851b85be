//! From the outcome of a run to its record: errors against references, balances, oscillation, checks.

pub mod attached_record;
pub mod balances;
pub mod case_record;
pub mod dimensionless_groups;
pub mod error_contributions;
pub mod exact_fields;
pub mod field_errors;
pub mod known_references;
pub mod norms;
pub mod oscillation;
pub mod other_measures;
pub mod plane_field;
pub mod pressure_peak;
pub mod record_checks;
pub mod theory_curves;
pub mod wall_times;
