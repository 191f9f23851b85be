//! What a matrix without factors is told by.

/// The matrix has no inverse to working precision: the row without a pivot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The row.
    pub row: usize,
}
