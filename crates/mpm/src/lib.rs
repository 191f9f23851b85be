//! The solver core: the v–w material point method for saturated soil, with one set of material points or with two.
//!
//! Folders are floors; each uses only those below it, which a test keeps (`src/tests/source_order.rs` of `oedometer`). From the
//! ground up:
//!
//! - `time_limit`, `direct_solver`: deadlines and linear systems, which know nothing of points and nodes;
//! - `state`: grid, points, nodes, cells;
//! - `operators`: a method is four independent operators, each sparse between points, nodes and cell centres: shape
//!   functions, strain gradient, pressure divergence and recovery;
//! - `drag`: of a point, of a node, and what it allows as a step;
//! - `actions`: what acts on a body, each a type that the kernel calls at a named place;
//! - `kernel`: a body joins all of these; its step is that of Zheng et al. (2021), by name and in order in `kernel/step.rs`;
//! - `integrate`: ways through time: the kernel's step, the same as sparse maps where nothing moves, the water in points of
//!   its own, implicit steps of any size; with critical steps, schedules and results;
//! - `run`: chooses an integrator and drives it from output to output under watch;
//! - `scene`: the physical problems, with the names of the exact solutions that hold for each.
//!
//! Nothing here knows of studies, records or reports.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod actions;
mod direct_solver;
mod drag;
pub mod integrate;
pub mod kernel;
pub mod operators;
pub mod run;
pub mod scene;
pub mod state;
pub mod time_limit;

pub use oedometer_problem::{formulation, method};
pub(crate) use oedometer_soil::wide;

#[cfg(test)]
mod tests {
    pub(crate) mod double_point_columns;
    mod registers;
}
