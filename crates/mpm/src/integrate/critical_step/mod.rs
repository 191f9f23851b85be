//! The critical time step: by formula, predicted from the step operator, observed by runs.

mod known;
mod parts;
pub(crate) mod power;
pub mod predicted;
pub mod skeleton;
mod spectral_radius;
