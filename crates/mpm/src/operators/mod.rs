//! The operators of a method, each sparse between points, nodes and cell centres: weights, strain gradient,
//! divergence, recovery, surface load, rigid plate, self-weight.

pub mod basis;
pub mod block_rows;
pub mod chord_mean;
pub mod corners;
pub mod line_sums;
pub mod pairs;
pub mod recovery;
pub mod rigid_plate;
pub mod row;
pub mod self_weight;
pub mod sparse_rows;
pub mod stencil;
pub mod strain_gradient;
pub mod surface_load;
pub mod volumetric;
