//! Actions on a body: loads, weight and corrections, each a type that the kernel calls at a named place of its step; none knows the kernel.
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

/// All actions on a body; `None` and empty lists where there is none.
#[derive(Clone, Debug)]
pub struct Actions<const D: usize> {
    /// Load on the surface; 0 Pa where none acts.
    pub surface: LoadedSurface<D>,
    /// Rigid plate on the upper face of the first direction.
    pub plate: Option<RigidPlate>,
    /// Weight of skeleton and water; the pressures of the points are total ones then.
    pub weight: Option<SelfWeight>,
    /// Accelerations by which the nodes hold up the weight that points off their lattice leave unbalanced, `[node][phase]`,
    /// m/s² upward positive, of the mixture and of the pore water; empty where points integrate the weight exactly.
    pub weight_carried: Vec<[Vector<D>; 2]>,
    /// Body forces and a source of water at every point.
    pub forcing: Option<Forced<D>>,
    /// Velocities that points bring to the nodes with their gradients (APIC).
    pub velocity_gradients: Option<VelocityGradients<D>>,
    /// Slopes of the stresses over the points' domains.
    pub stress_planes: Option<StressPlanes<D>>,
    /// Averages over the cells to which stresses and pressures of the points are set.
    pub cell_averages: Option<CellAverages<D>>,
}
