//! The solver core: the v–w material point method for saturated soil, with one set of material points or with two.
//!
//! A method is four independent operators (`method`), each sparse between points, nodes and cell centres: shape
//! functions, strain gradient, pressure divergence and recovery (`operators`). A `body` joins them with points, nodes and
//! cells (`state`); `explicit` is the step of Zheng et al. (2021); `assembled` is the same step as one banded map where
//! nothing moves; `double_point` puts the water into points of its own; `implicit` takes steps of any size on the same
//! operators, with the linear systems of `direct_solver`; `run` drives any of them from output to output. `drag` is the
//! drag of a point, of a node, and what it allows as a step. `forcing` is what acts on every point from outside.
//! Loops over points and dense fronts run in the widest
//! registers that `wide` finds. `scene` describes the physical problems and names the exact solutions that hold for each;
//! the solver itself uses neither.
//!
//! Nothing here knows of studies, records or reports.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod assembled;
pub mod body;
pub mod critical_step;
mod direct_solver;
mod double_point;
mod drag;
pub mod explicit;
mod forced_body;
pub mod forcing;
pub mod implicit;
mod loaded_body;
pub mod method;
pub mod operators;
pub mod run;
pub mod scene;
pub mod state;
pub mod time_limit;
mod undrained_start;
mod weighing_body;
mod wide;

#[cfg(test)]
mod tests {
    pub(crate) mod double_point_columns;
    mod registers;
}
