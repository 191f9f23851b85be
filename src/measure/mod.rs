//! From the outcome of a run to its record: errors against references, balances, oscillation, checks.

pub mod case_record;
pub mod error_contributions;
pub mod norms;
pub mod oscillation;
pub mod plane_field;
pub mod record_checks;
pub mod theory_curves;
pub mod wall_times;
