//! Relative errors that tell nothing of a method.

/// Relative errors up to this are round-off.
pub const ROUND_OFF: f64 = 1e-12;

/// Relative errors up to this may be those of numbers in single precision, and of iterations that stop early.
pub const SINGLE_PRECISION: f64 = 1e-6;

/// Relative errors up to this may be what the iterations of this program leave.
pub const ITERATIONS: f64 = 1e-8;
