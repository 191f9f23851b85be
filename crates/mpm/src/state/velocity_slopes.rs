//! Slopes of the points' velocities, where points bring them to the nodes.

use crate::state::grid::Grid;
use oedometer_soil::tensor::{Tensor, Vector};

/// Slopes of the velocities of both phases at the points.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocitySlopes<const D: usize> {
    /// Of skeleton and water, 1/s, `[point][phase]`.
    pub slopes: Vec<[Tensor<D>; 2]>,
    /// Places of the nodes, m.
    pub nodes: Vec<Vector<D>>,
}

impl<const D: usize> VelocitySlopes<D> {
    /// Of points at rest on a grid.
    pub fn at_rest(grid: &Grid<D>, points: usize) -> Self {
        Self {
            slopes: vec![[[[0.0; D]; D]; 2]; points],
            nodes: (0..grid.node_count()).map(|node| grid.node_position(node)).collect(),
        }
    }
}
