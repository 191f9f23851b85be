//! What a body is made of: grid, points, nodes, cells, and what cells remember.

pub mod cell_memory;
pub mod cells;
pub mod confined_points;
pub mod domains;
pub mod grid;
pub mod lanes;
pub mod nodes;
pub mod points;
pub mod stress_planes;
pub mod velocity_slopes;
pub mod water_points;
