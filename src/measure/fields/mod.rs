//! Fields of a run against exact ones: exact values at samples, norms of the difference, oscillation.

mod digits;
mod exact_fields;
mod field_errors;
mod norms;
mod oscillation;

pub use digits::half_a_digit;
pub use exact_fields::{ExactFields, SamplePlaces, exact_samples};
pub use field_errors::{FieldError, LONG_AFTER, resolution, settlement_error, snapshot_errors, start_of};
pub use norms::{FieldDifference, largest_contribution, relative_error};
pub use oscillation::{PlaneField, reversal};
