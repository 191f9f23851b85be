//! How the rows of a frozen step are stored, chosen by their structure.
//!
//! Both kinds answer the same questions about a block of rows that lie side by side: the forces on its
//! nodes, and the projection of velocities onto them. `banded` is for rows that reach only their
//! nearest neighbours, as those of a column do; `sparse` is for all others.

pub mod banded_rows;
pub mod block_products;
pub mod padded_rows;

use crate::assembled::operators::FrozenOperators;
use crate::assembled::rows::banded_rows::BandedStorage;
use crate::assembled::rows::padded_rows::SparseStorage;

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
