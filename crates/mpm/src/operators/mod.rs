//! The operators of a method, each sparse between points, nodes and cell centres: shape functions, strain gradient,
//! divergence, recovery, surface load; and the cell-averaged projection.

pub mod basis;
pub mod cell_averaged;
pub mod corners;
pub mod projection;
pub mod recovery;
pub mod sparse_rows;
pub mod stacked_points;
pub mod stencil;
pub mod strain_gradient;
pub mod surface_load;
pub mod volumetric;
