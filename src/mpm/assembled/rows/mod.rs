//! How the rows of a frozen step are stored, chosen by their structure.
//!
//! Both kinds answer the same questions about a block of rows that lie side by side: the forces on its
//! nodes, and the projection of velocities onto them. `banded` is for rows that reach only their
//! nearest neighbours, as those of a column do; `sparse` is for all others.

pub mod banded_rows;
pub mod padded_rows;

use crate::mpm::assembled::operators::FrozenOperators;
use crate::mpm::assembled::rows::banded_rows::BandedStorage;
use crate::mpm::assembled::rows::padded_rows::SparseStorage;
use crate::mpm::assembled::state::FrozenState;
use crate::soil::tensor::Vector;

/// Rows in a block.
pub const LANES: usize = 4;
/// Rows to either side that a band reaches: basis (1) + patch (1) + centre or composite (1).
pub const REACH: usize = 3;
/// Empty places at both ends of a grid array: a band reaches there. As long as a block, so that blocks do
/// not straddle cache lines.
pub const MARGIN: usize = LANES;

/// One value per row of a block.
pub type Lanes = [f64; LANES];

/// What a step multiplies grid arrays with. Arrays hold `[MARGIN + row][component]`.
pub trait Rows<const D: usize> {
    /// Forces of the pressures, `K_p U_f`, and of the effective stresses, `K_σ U_s`, on the nodes of a
    /// block with their signs turned, N.
    fn forces(&self, block: usize, state: &FrozenState<D>) -> [[Lanes; D]; 2];

    /// Fields of both phases mapped to the points and back, `P v`, at the nodes of a block; zero where a
    /// component is held.
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
