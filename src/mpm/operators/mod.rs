//! TODO

pub mod recovery;
pub mod shape;
pub mod stencil;
pub mod strain_gradient;
pub mod surface_load;
pub mod volumetric;
