//! Saturated soil: its parameters, its stress–strain laws and the continuity of its water. Written once, for
//! the solver and for everything that describes a case.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod base;
pub mod conductivity;
pub mod continuity;
pub mod elementary;
pub mod law;
pub mod law_data;
pub mod laws;
pub mod layers;
pub mod material;
pub mod motion;
pub mod plasticity;
pub mod stiffness;
pub mod tensor;
pub mod wide;
