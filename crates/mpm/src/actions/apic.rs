//! Velocities with their gradients: what points bring to the nodes where those are (APIC: Jiang, Schroeder, Selle, Teran
//! & Stomakhin 2015; with FLIP's increments Fei, Guo, Wu, Huang & Gao 2021).
//!
//! ```text
//! v_i = Σ_p N_ip m_p [v_p + ∇v_p (x_i − x_p)] / Σ_p N_ip m_p
//! ```
//!
//! Without the gradient a node takes the velocity of the middle of the mass around it. Where points lie regularly that
//! is the node itself; where they have moved it is beside it, by a share of the cell that changes from node to node, and
//! the divergence of the difference does not fall with the cells. Momentum is kept, for `Σ_i N_ip (x_i − x_p) = 0`.

use crate::operators::stencil::PointStencils;
use crate::state::cells::Cells;
use crate::state::grid::{GHOST_LAYERS, Grid};
use crate::state::nodes::Nodes;
use crate::state::points::Points;
use oedometer_soil::tensor::{Tensor, Vector};

/// Gradients of the velocities of skeleton and water at the points, 1/s, `[point][phase]`.
#[derive(Clone, Debug)]
pub struct VelocityGradients<const D: usize>(Vec<[Tensor<D>; 2]>);

impl<const D: usize> VelocityGradients<D> {
    /// The affine velocities of the present nodal velocities at `points` points.
    pub fn new(points: usize, grid: &Grid<D>, basis: &PointStencils<D>, nodes: &Nodes<D>) -> Self {
        let mut gradients = Self(vec![[[[0.0; D]; D]; 2]; points]);
        gradients.take(grid, basis, nodes);
        gradients
    }

    /// Stores the gradients of the nodal velocities at the points.
    pub fn take(&mut self, grid: &Grid<D>, basis: &PointStencils<D>, nodes: &Nodes<D>) {
        for (point, [solid, water]) in self.0.iter_mut().enumerate() {
            *solid = basis.gradient(grid.node_stride(), point, &nodes.solid_velocity);
            *water = basis.gradient(grid.node_stride(), point, &nodes.water_velocity);
        }
    }

    /// Adds what the gradients bring to the momenta that points have given to the nodes, at the places that the shape
    /// functions are of.
    pub fn add_momenta(
        &self,
        grid: &Grid<D>,
        cells: &Cells<D>,
        points: &Points<D>,
        basis: &PointStencils<D>,
        momenta: &mut [[Vector<D>; 2]],
    ) {
        for (point, gradients) in self.0.iter().enumerate() {
            let place = cells.place[point];
            let place = place.map(|in_cells| (in_cells - GHOST_LAYERS as f64) * grid.cell_size);
            let volumes = points.volumes_of_phases(point);
            basis.visit(grid.node_stride(), point, |node, value, _| {
                let at = grid.node_position(node);
                for (phase, gradient) in gradients.iter().enumerate() {
                    let gradient: &Tensor<D> = gradient;
                    for d in 0..D {
                        let beside: f64 = (0..D).map(|e| gradient[d][e] * (at[e] - place[e])).sum();
                        momenta[node][phase][d] += value * volumes[phase] * beside;
                    }
                }
            });
        }
    }
}
