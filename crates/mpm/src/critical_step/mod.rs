//! The critical time step: by formula, predicted from the step operator, observed by runs.

pub mod formula;
pub mod observed;
pub mod predicted;
pub mod spectral_radius;
mod square;
