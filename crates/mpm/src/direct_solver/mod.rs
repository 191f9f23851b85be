//! Direct solution of the linear systems of implicit steps and of the undrained start.
//!
//! A column's matrix is a narrow band ([`banded`]). The matrix of a body in the plane is sparse and is factored front by
//! front in the order of nested dissection ([`frontal`]), which costs `N^1.5` operations where a band costs `N^2`.
//! [`system`] chooses between the two and adds the row and column of a rigid plate.

mod banded;
mod frontal;
mod sparse_matrix;
pub mod system;

/// A matrix that has no inverse to working precision. A factorisation that was given up because the time of the run was
/// over ends with it too; the caller, who knows the time limit, tells the two apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The row without a pivot.
    pub row: usize,
}
