//! TODO

pub mod material;
