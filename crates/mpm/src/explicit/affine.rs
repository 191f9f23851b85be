//! Velocities with their slopes: what points bring to the nodes where those are (Jiang, Schroeder, Selle, Teran &
//! Stomakhin 2015; with FLIP's increments Fei, Guo, Wu, Huang & Gao 2021).
//!
//! ```text
//! v_i = Σ_p N_ip m_p [v_p + ∇v_p (x_i − x_p)] / Σ_p N_ip m_p
//! ```
//!
//! Without the slope a node takes the velocity of the middle of the mass around it. Where points lie regularly that is
//! the node itself; where they have moved it is beside it, by a share of the cell that changes from node to node, and
//! the divergence of the difference does not fall with the cells. Momentum is kept, for `Σ_i N_ip (x_i − x_p) = 0`.

use crate::body::Body;
use crate::explicit::points_to_nodes::volumes_of;
use crate::operators::pairs::add_weighted;
use crate::operators::stencil::with_stencils;
use crate::state::grid::GHOST_LAYERS;
use crate::state::velocity_slopes::VelocitySlopes;
use oedometer_soil::tensor::Vector;

impl<const D: usize> Body<D> {
    /// Lets points bring the slopes of their velocities to the nodes, beginning with those of the present nodal ones.
    pub fn bring_slopes(&mut self) {
        self.slopes = Some(VelocitySlopes::at_rest(&self.grid, self.points.len()));
        self.take_slopes();
    }

    /// Takes the slopes of the nodal velocities at the points.
    pub(crate) fn take_slopes(&mut self) {
        let Some(slopes) = &mut self.slopes else { return };
        let (stride, nodes) = (*self.grid.node_stride(), &self.nodes);
        with_stencils!(&self.basis, stencils => {
            let blocks = stencils.blocks();
            for (point, [solid, water]) in slopes.slopes.iter_mut().enumerate() {
                *solid = blocks.gradient(&stride, point, &nodes.solid_velocity);
                *water = blocks.gradient(&stride, point, &nodes.water_velocity);
            }
        });
    }

    /// Adds what the slopes bring to the momenta that points have given to the nodes, at the places that the weights
    /// are of.
    pub(crate) fn add_slopes(&mut self) {
        let Some(VelocitySlopes { slopes, nodes }) = &self.slopes else { return };
        let (stride, points) = (*self.grid.node_stride(), &self.points);
        let (solid_fraction, cell_size) = (1.0 - self.material.porosity, self.grid.cell_size);
        let balances = &mut self.nodes.sums.balances;
        with_stencils!(&self.basis, stencils => {
            let blocks = stencils.blocks();
            for (point, (in_cells, slopes)) in self.cells.place.iter().zip(slopes).enumerate() {
                let place: Vector<D> =
                    std::array::from_fn(|d| (in_cells[d] - GHOST_LAYERS as f64) * cell_size);
                let volumes =
                    volumes_of(points.initial_volume[point], points.volume_ratio[point], solid_fraction);
                // What either phase brings per distance from the point, `[direction][phase][component]`.
                let brought: [[Vector<D>; 2]; D] = std::array::from_fn(|e| {
                    std::array::from_fn(|phase| std::array::from_fn(|d| volumes[phase] * slopes[phase][d][e]))
                });
                blocks.visit_filled_runs(&stride, point, |run| {
                    let places = &nodes[run.first..run.first + run.weights.len()];
                    let sums = &mut balances[run.first..run.first + run.weights.len()];
                    // Across the run all its nodes are as far from the point.
                    let mut across = [[0.0; D]; 2];
                    for e in 1..D {
                        let apart = run.across[0] * (places[0][e] - place[e]);
                        add_weighted(across.as_flattened_mut(), apart, brought[e].as_flattened());
                    }
                    for ((weight, at), sum) in run.weights.iter().zip(places).zip(sums) {
                        let mut given = across;
                        let apart = run.across[0] * (at[0] - place[0]);
                        add_weighted(given.as_flattened_mut(), apart, brought[0].as_flattened());
                        add_weighted(sum[..2].as_flattened_mut(), *weight, given.as_flattened());
                    }
                });
            }
        });
    }
}
