//! Vectors and tensors of a dimension: the last component is the vertical one.

/// A vector, `[component]`.
pub type Vector<const D: usize> = [f64; D];

/// A tensor of second order, `[row][column]`.
pub type Tensor<const D: usize> = [[f64; D]; D];
