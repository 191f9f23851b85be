//! Direct solution of the linear systems of implicit steps and of the undrained start.
//!
//! A column's matrix is a narrow band. That of a body in the plane is kept sparse and factored front by
//! front in the order of nested dissection, which costs `N^1.5` where the band costs `N^2`. Large ones are worked on in
//! parts, side by side where a run has threads, with the same bits whatever their number.

mod banded;
pub mod bordered;
mod branch;
mod desk;
mod dissection;
mod elimination;
mod front;
mod frontal_lu;
pub mod singular;
mod sparse_matrix;
mod substitution;
mod system;
