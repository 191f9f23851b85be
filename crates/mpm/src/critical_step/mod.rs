//! The critical time step: by formula, predicted from the step operator, observed by runs.

pub mod formula;
pub mod observed;
mod power;
pub mod predicted;
mod spectral_radius;
