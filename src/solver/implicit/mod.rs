//! Implicit integrators, on the operators of the explicit one.
//!
//! - `unknowns`: displacements of the nodes and pressures of the sites, numbered along the column,
//! - `assembly`: the frozen body as `C ẋ + K x = g`,
//! - `linear`: SDIRK2 on it, one factorisation a step size,
//! - `steps`: few distinct step sizes,
//! - `drive`: from output to output,
//! - `banded`, `sparse`: the matrices.

pub mod assembly;
pub mod banded;
pub mod drive;
pub mod linear;
pub mod sparse;
pub mod steps;
pub mod unknowns;

#[cfg(test)]
mod tests;
