//! Saturated soil: its parameters, its stress–strain laws and the continuity of its water. Written once, for
//! the solver and for everything that describes a case.

pub mod conductivity_mean;
pub mod continuity;
pub mod law;
pub mod material;
pub mod tensor;
