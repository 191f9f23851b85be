//! The critical time step: by formula, predicted from the step operator, observed by runs.

pub mod formula;
mod known;
mod parts;
pub(crate) mod power;
pub mod predicted;
mod spectral_radius;
