//! The step of a body whose weights are frozen, as sparse maps between grid arrays.

pub mod column;
pub mod frozen;
pub mod plane;
pub mod stiffness;
