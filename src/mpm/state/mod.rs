//! TODO

pub mod cell_memory;
pub mod cells;
pub mod grid;
pub mod nodes;
pub mod points;
