//! Fields of a run against exact ones: exact values at samples, norms of the difference, oscillation.

mod exact_fields;
mod field_errors;
mod norms;
mod oscillation;

pub use exact_fields::{ExactFields, SamplePlaces, exact_samples};
pub use field_errors::{FieldError, LONG_AFTER, resolution, settlement_error, snapshot_errors};
pub use norms::{FieldDifference, largest_contribution, relative_error};
pub use oscillation::{PlaneField, reversal};
