//! What acts on a body, each a type that the kernel calls at a named place of its step; none knows the kernel.
//!
//! | action | called where |
//! | :-- | :-- |
//! | [`surface_load`], [`rigid_plate`] | external forces, after the shape functions are built; a plate ties accelerations and velocities |
//! | [`self_weight`], [`forcing`] | forces on the nodes; a source in the pressure's rate |
//! | [`apic`] | momenta of the points, before velocities are taken of them |
//! | [`stress_slopes`] | forces of the points, before those on the nodes are taken of them |
//! | [`cell_averages`] | stresses and pressures, at the end of a step |

pub mod apic;
pub mod cell_averages;
pub mod forcing;
pub mod rigid_plate;
pub mod self_weight;
pub mod stress_slopes;
pub mod surface_load;

use crate::actions::apic::VelocityGradients;
use crate::actions::cell_averages::CellAverages;
use crate::actions::forcing::Forced;
use crate::actions::rigid_plate::RigidPlate;
use crate::actions::self_weight::SelfWeight;
use crate::actions::stress_slopes::StressPlanes;
use crate::actions::surface_load::LoadedSurface;
use oedometer_soil::tensor::Vector;

/// What acts on a body, where it does.
#[derive(Clone, Debug)]
pub struct Actions<const D: usize> {
    /// Load on the surface; 0 Pa where none acts.
    pub surface: LoadedSurface<D>,
    /// Rigid plate on the upper face of the first direction.
    pub plate: Option<RigidPlate>,
    /// Weight of skeleton and water; the pressures of the points are total ones then.
    pub weight: Option<SelfWeight>,
    /// What the weight of points off their lattice leaves unbalanced at the nodes, and they carry: `[node][phase]`, m/s²
    /// upward positive, of the mixture and of the pore water; none where points integrate it exactly.
    pub weight_carried: Vec<[Vector<D>; 2]>,
    /// Body forces and a source of water at every point.
    pub forcing: Option<Forced<D>>,
    /// Velocities that points bring to the nodes with their gradients (APIC).
    pub velocity_gradients: Option<VelocityGradients<D>>,
    /// How stresses slope over the points' domains.
    pub stress_planes: Option<StressPlanes<D>>,
    /// Means over the cells that the points follow.
    pub cell_averages: Option<CellAverages<D>>,
}
