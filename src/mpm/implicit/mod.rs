//! Implicit integrators, on the operators of the explicit one.
//!
//! - `unknowns`: displacements of the nodes and pressures of the sites, numbered along the column,
//! - `assembly`: the frozen body as `C ẋ + K x = g`; `linear`: SDIRK2 on it, one factorisation a
//!   step size,
//! - `trial`: what the balances of a moving or inertial body leave at a trial state; `tangent`:
//!   its differences; `newton`: SDIRK2 with Newton's iteration on it,
//! - `steps`: few distinct step sizes; `march`, `drive`: from output to output,
//! - `banded`, `sparse`, `tensor`: the algebra.

pub mod assembly;
pub mod banded;
pub mod drive;
pub mod linear;
pub mod march;
pub mod newton;
pub mod sparse;
pub mod steps;
pub mod tangent;
pub mod trial;
pub mod unknowns;

#[cfg(test)]
#[path = "../../../tests/unit/mpm_implicit.rs"]
mod tests;
