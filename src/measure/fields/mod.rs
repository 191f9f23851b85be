//! Fields of a run against exact ones: exact values at samples, norms of the difference, oscillation.

pub mod exact_fields;
pub mod field_errors;
pub mod norms;
pub mod oscillation;
