//! How the rows of a frozen step are stored, chosen by their structure.
//!
//! Both kinds answer the same questions about a block of rows that lie side by side: the forces on its
//! nodes, and the projection of velocities onto them. `banded` is for rows that reach only their
//! nearest neighbours, as those of a column do; `sparse` is for all others.

pub mod banded;
pub mod sparse;

use crate::mpm::assembled::operators::FrozenOperators;
use crate::mpm::assembled::rows::banded::BandedStorage;
use crate::mpm::assembled::rows::sparse::SparseStorage;
use crate::soil::tensor::Vector;

/// Rows in a block.
pub const LANES: usize = 4;
/// Rows to either side that a band reaches: basis (1) + patch (1) + centre or composite (1).
pub const REACH: usize = 3;

/// One value per row of a block.
pub type Lanes = [f64; LANES];

/// What a step multiplies grid arrays with. Arrays hold `[REACH + row][component]`.
pub trait Rows<const D: usize> {
    /// Force of the pressures on the nodes of a block with its sign turned, N, `K_p U_f`.
    fn pressure_forces(&self, block: usize, flux_displacement: &[Vector<D>], dilation: &[f64]) -> [Lanes; D];

    /// Force of the effective stresses on the nodes of a block with its sign turned, N, `K_σ U_s`.
    fn skeleton_forces(&self, block: usize, strain_displacement: &[Vector<D>]) -> [Lanes; D];

    /// Fields of both phases mapped to the points and back, `P v`, at the nodes of a block.
    fn projected(&self, block: usize, fields: &[Vec<Vector<D>>; 2]) -> [[Lanes; D]; 2];
}

/// Rows in the way that suits them.
#[derive(Clone, Debug)]
pub enum RowStorage<const D: usize> {
    /// Every row reaches its nearest neighbours only.
    Banded(BandedStorage<D>),
    /// Rows reach anywhere.
    Sparse(SparseStorage<D>),
}

impl<const D: usize> RowStorage<D> {
    /// Takes the rows of a frozen body.
    pub fn of(operators: &FrozenOperators<D>) -> Self {
        BandedStorage::of(operators).map_or_else(|| Self::Sparse(SparseStorage::of(operators)), Self::Banded)
    }
}
