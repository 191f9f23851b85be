//! Fields of a run against exact ones: where these are taken, norms of the difference, and how it is spread.

pub mod error_contributions;
pub mod exact_fields;
pub mod field_errors;
pub mod norms;
pub mod oscillation;
pub mod plane_field;
