//! Body forces and a water source that make a motion which was chosen.

use crate::formulation::Formulation;
use oedometer_soil::tensor::Vector;
use std::fmt::Debug;

/// Force on the mixture, N per m^D of mixture, and on the water, N per m^D of water.
pub type BodyForces<const D: usize> = [Vector<D>; 2];

/// Body forces and a source of water on a motion that is known. Places `X` are those of the initial configuration, m,
/// times s; sites are the numbers of those places that are asked for.
pub trait Forcing<const D: usize>: Debug + Send + Sync {
    /// The forces at points of the skeleton that a formulation's balances want, `[point]`.
    fn body_forces(
        &self,
        formulation: Formulation,
        places: &[Vector<D>],
        time: f64,
        forces: &mut [BodyForces<D>],
    );

    /// Volume of water that is added at the places of some sites, per volume of mixture and second, `[site]`.
    fn sources(
        &self,
        places: &[Vector<D>],
        sites: &mut dyn Iterator<Item = usize>,
        time: f64,
        sources: &mut [f64],
    );

    /// The points of the skeleton that are at the present places of some sites, looked for from guesses, which they
    /// take the place of; `[site]`.
    fn material_places(
        &self,
        present: &dyn Fn(usize) -> Vector<D>,
        sites: &mut dyn Iterator<Item = usize>,
        time: f64,
        places: &mut [Vector<D>],
    );
}
