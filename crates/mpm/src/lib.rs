//! The solver core: the v–w material point method for saturated soil, in one layer of points or in two.
//!
//! A method is four independent operators (`method`), each sparse between points, nodes and cell
//! centres: weights (`shape`, `stencil`), strain gradient (`stencil`), pressure divergence
//! (`cells`) and recovery (`recovery`). A `body` joins them with points and nodes; `explicit` is
//! the step of Zheng et al. (2021); `assembled` is the same step as one banded map where nothing
//! moves; `layers` puts the water into points of its own; `run` drives any of them from output to
//! output; `forcing` is what acts on every point from outside, `forced_body` what that does to a
//! body; `implicit` takes steps of any size on the same operators, with the linear systems of
//! `direct_solver`. Loops over points and dense fronts run in the widest registers that `wide` finds.
//! `scene` describes the physical problems, and names the exact solutions that hold for each; the
//! solver itself uses neither.
//!
//! Nothing here knows of studies, records or reports.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod assembled;
pub mod body;
pub mod critical_step;
pub mod direct_solver;
mod energy_of_body;
pub mod explicit;
pub mod forced_body;
pub mod forcing;
pub mod formulation;
pub mod implicit;
pub mod layers;
pub mod loaded_body;
pub mod method;
pub mod momentum;
pub mod operators;
pub mod run;
pub mod scene;
pub mod state;
pub mod time_limit;
pub mod undrained_start;
pub mod weighing_body;
pub mod wide;

#[cfg(test)]
mod tests {
    mod registers;
    pub(crate) mod two_layer_columns;
}
