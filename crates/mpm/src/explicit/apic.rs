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

use crate::body::Body;
use crate::state::grid::GHOST_LAYERS;
use oedometer_soil::tensor::Tensor;

impl<const D: usize> Body<D> {
    /// Lets points bring the gradients of their velocities to the nodes, beginning with those of the present nodal ones.
    pub fn use_apic(&mut self) {
        self.velocity_gradients = vec![[[[0.0; D]; D]; 2]; self.points.len()];
        self.take_velocity_gradients();
    }

    /// Takes the gradients of the nodal velocities at the points.
    pub(crate) fn take_velocity_gradients(&mut self) {
        let (stride, nodes) = (self.grid.node_stride(), &self.nodes);
        for (point, [solid, water]) in self.velocity_gradients.iter_mut().enumerate() {
            *solid = self.basis.gradient(stride, point, &nodes.solid_velocity);
            *water = self.basis.gradient(stride, point, &nodes.water_velocity);
        }
    }

    /// Adds what the gradients bring to the momenta that points have given to the nodes, at the places that the shape
    /// functions are of.
    pub(crate) fn add_velocity_gradients(&mut self) {
        let (grid, points) = (&self.grid, &self.points);
        for (point, gradients) in self.velocity_gradients.iter().enumerate() {
            let place = self.cells.place[point];
            let place = place.map(|in_cells| (in_cells - GHOST_LAYERS as f64) * grid.cell_size);
            let volumes = points.volumes_of_phases(point);
            self.basis.visit(grid.node_stride(), point, |node, value, _| {
                let at = grid.node_position(node);
                for (phase, gradient) in gradients.iter().enumerate() {
                    let gradient: &Tensor<D> = gradient;
                    for d in 0..D {
                        let beside: f64 = (0..D).map(|e| gradient[d][e] * (at[e] - place[e])).sum();
                        self.nodes.sums.momenta[node][phase][d] += value * volumes[phase] * beside;
                    }
                }
            });
        }
    }
}
