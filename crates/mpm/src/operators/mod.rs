//! The operators of a method, each sparse between points, nodes and cell centres: functions of state alone.

pub mod basis;
pub mod corners;
pub mod recovery;
pub mod sparse_rows;
pub mod stacked_points;
pub mod stencil;
pub mod strain_gradient;
