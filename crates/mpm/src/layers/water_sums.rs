//! What water points give to the nodes, while it is summed.

use oedometer_soil::tensor::Vector;

/// What the water points give to each node, while it is summed; `[node]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaterSums<const D: usize> {
    /// Mass and mass per volume of water `A` (kg), drag (N s/m), and nothing.
    pub masses: Vec<[f64; 4]>,
    /// Momentum, kg m/s.
    pub momenta: Vec<Vector<D>>,
    /// What the water points give to each cell: weight times pressure, and weight, of its points, and the same of the
    /// domains that reach into it, or of its points a second time; m^D Pa and m^D.
    pub cells: Vec<[f64; 4]>,
    /// Middle of what the soil fills of each cell with water points, m; `[cell]`.
    pub middles: Vec<Vector<D>>,
    /// Slope over each of these cells of what is looked at, per m; `[cell]`.
    pub slopes: Vec<Vector<D>>,
}

impl<const D: usize> WaterSums<D> {
    /// Room for so many nodes and cells.
    pub fn with_nodes(count: usize, cells: usize) -> Self {
        Self {
            masses: vec![[0.0; 4]; count],
            momenta: vec![[0.0; D]; count],
            cells: vec![[0.0; 4]; cells],
            middles: vec![[0.0; D]; cells],
            slopes: vec![[0.0; D]; cells],
        }
    }
}
