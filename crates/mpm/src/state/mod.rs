//! State of a body: grid, points, nodes, cells.

pub mod cells;
pub mod grid;
pub mod nodes;
pub mod points;
