//! TODO

pub mod column;
pub mod frozen;
pub mod plane;
pub mod stiffness;
