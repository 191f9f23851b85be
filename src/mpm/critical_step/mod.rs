//! TODO

pub mod formula;
pub mod observed;
pub mod predicted;
pub mod spectral_radius;
