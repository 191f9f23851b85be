//! What a step asks of rows, block by block.

use crate::mpm::assembled::assembled_state::{FrozenState, Lanes};
use crate::soil::tensor::Vector;

/// What a step multiplies grid arrays with. Arrays hold `[MARGIN + row][component]`.
pub trait Rows<const D: usize> {
    /// Forces of the pressures, `K_p U_f`, and of the effective stresses, `K_σ U_s`, on the nodes of a
    /// block with their signs turned, N.
    fn forces(&self, block: usize, state: &FrozenState<D>) -> [[Lanes; D]; 2];

    /// Fields of both phases mapped to the points and back, `P v`, at the nodes of a block; zero where a
    /// component is held.
    fn projected(&self, block: usize, fields: &[Vec<Vector<D>>; 2]) -> [[Lanes; D]; 2];
}
