//! What a matrix without factors is told by.

/// The matrix has no inverse to working precision: the row without a pivot. Or its factors were given up there because
/// the time of the run was over, which whoever gave the time asks then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The row.
    pub row: usize,
}
