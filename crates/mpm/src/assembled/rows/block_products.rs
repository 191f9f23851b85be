//! What a step asks of rows, block by block.

use crate::assembled::assembled_state::Lanes;
use oedometer_soil::tensor::Vector;

/// What forces come from: slices that a step takes once, for a vector would be asked for its place after every store.
#[derive(Clone, Copy, Debug)]
pub struct Displacements<'a, const D: usize> {
    /// What strained the skeleton, m, `[MARGIN + row][component]`.
    pub strained: &'a [Vector<D>],
    /// That of the flux, m, by row too.
    pub flux: &'a [Vector<D>],
    /// Dilation at the sites, where rows ask for it.
    pub dilation: &'a [f64],
}

/// What a step multiplies grid arrays with. Arrays hold `[MARGIN + row][component]`.
pub trait Rows<const D: usize> {
    /// Forces of the pressures, `K_p U_f`, and of the effective stresses, `K_σ U_s`, on the nodes of a
    /// block with their signs turned, N.
    fn forces(&self, block: usize, displacements: Displacements<'_, D>) -> [[Lanes; D]; 2];

    /// Fields of both phases mapped to the points and back, `P v`, at the nodes of a block; zero where a
    /// component is held.
    fn projected(&self, block: usize, fields: [&[Vector<D>]; 2]) -> [[Lanes; D]; 2];
}
