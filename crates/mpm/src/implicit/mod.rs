//! Implicit integrators, on the operators of the explicit one.
//!
//! - `unknowns`: displacements of the nodes and pressures of the sites, numbered along the column,
//! - `sdirk`: the two stages of every step, and the scales of its error,
//! - `linear_system`: the frozen body as `C ẋ + K x = g`; `linear`: SDIRK2 on it, one
//!   factorisation per step size,
//! - `trial`: a moving or inertial body at a trial state; `residual`: what its balances leave there;
//!   `tangent`: the residual's differences, by the groups of `unknown_groups`; `secants`: what corrections tell beyond it;
//!   `guess`: where a stage's iteration begins; `newton`: SDIRK2 with Newton's iteration on it.
//!
//! The systems are solved by `direct_solver`.

pub mod guess;
pub mod linear;
pub mod linear_system;
pub mod newton;
pub mod residual;
pub mod sdirk;
pub mod secants;
mod straining;
pub mod tangent;
pub mod trial;
mod unknown_groups;
pub mod unknowns;

#[cfg(test)]
mod tests;
