//! The solver core: the v–w single-layer material point method for saturated soil.
//!
//! A method is four independent operators (`method`), each sparse between points, nodes and cell
//! centres: weights (`shape`, `stencil`), strain gradient (`stencil`), pressure divergence
//! (`cells`) and recovery (`recovery`). A `body` joins them with points and nodes; `explicit` is
//! the step of Zheng et al. (2021); `assembled` is the same step as one banded map where nothing
//! moves; `run` drives either from output to output; `implicit` takes steps of any size on the same
//! operators.
//!
//! Nothing here knows of studies, references or reports.

pub mod assembled;
pub mod assembled_plane;
pub mod body;
pub mod bounds;
pub mod cells;
pub mod critical;
pub mod explicit;
pub mod frozen;
pub mod grid;
pub mod implicit;
pub mod integrator;
pub mod limits;
pub mod mapping;
pub mod material;
pub mod memory;
pub mod method;
pub mod nodes;
pub mod outcome;
pub mod points;
pub mod prediction;
pub mod profile;
pub mod recovered;
pub mod recovery;
pub mod run;
pub mod scheme;
pub mod shape;
pub mod snapshot;
pub mod stability;
pub mod stencil;
pub mod stiffness;
pub mod strain;
pub mod surface;
pub mod undrained;
pub mod volumetric;
