//! A body and its explicit step.
//!
//! [`body`] joins state, operators, soils and actions; [`step`] is the step of Zheng et al. by name and in order, on the
//! passes of `points_to_nodes`, `nodes_to_points` and `stresses`. `volumetric` and `projection` are its divergence and
//! recovery in place and as rows, `chord_mean` a drag of nodes; `loaded_body`, `weighing_body` and `forced_body` call the
//! actions on a body, `energy` takes its balance. `rhythm` is how long its kicks are.

pub mod body;
mod chord_mean;
pub(crate) mod energy;
mod forced_body;
pub(crate) mod loaded_body;
pub(crate) mod nodes_to_points;
pub(crate) mod points_to_nodes;
pub mod projection;
pub mod rhythm;
pub mod step;
pub(crate) mod stresses;
pub mod volumetric;
pub(crate) mod weighing_body;

pub(crate) use crate::kernel::nodes_to_points::Motion;
