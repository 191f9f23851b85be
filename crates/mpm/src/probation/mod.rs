//! Own inventions on probation: each is kept only if the fair race shows a situation where it is best or alone survives,
//! and has as few hooks into the step as possible. `cell_averaged` has its own for soil that strains vertically only,
//! `confined_points`; `pressure_lines` and `sliver_nodes` are of double-point MPM.

pub(crate) mod cell_averaged;
pub(crate) mod confined_points;
pub(crate) mod pressure_lines;
pub(crate) mod sliver_nodes;
pub(crate) mod stress_slopes;
