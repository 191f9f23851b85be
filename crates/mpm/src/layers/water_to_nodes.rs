//! From the water points to the nodes: mass, inertia, drag, and the force of the pressure.
//!
//! ```text
//! M_w = Σ_w N_iw m_w      A_i = Σ_w N_iw m_w/n_w      D_i = Σ_w N_iw (n_w γ_w/k) V_w      f_i = Σ_w ∇N_iw p_w V_w
//! ```

use crate::layers::two_layers::TwoLayers;
use crate::operators::pairs::add_weighted;
use crate::operators::stencil::with_stencils;

impl<const D: usize> TwoLayers<D> {
    /// Puts mass, inertia and drag of the water on the nodes with soil.
    pub fn map_water_masses(&mut self) {
        let (stride, soil) = (*self.body.grid.node_stride(), self.body.material);
        let (solid_fraction, unit_weight) = (1.0 - soil.porosity, soil.unit_weight_of_water());
        let (water, sums) = (&self.water, &mut self.sums.masses);
        sums.fill([0.0; 4]);
        with_stencils!(&self.basis, stencils => {
            for point in 0..water.len() {
                let (porosity, mass) = (water.porosity[point], water.mass_inside(point));
                let conductivity = soil.hydraulic_conductivity_at(solid_fraction / (1.0 - porosity));
                let drag = porosity * unit_weight / conductivity * water.volume_inside(point);
                let masses = [mass, mass / porosity, drag, 0.0];
                stencils.visit(&stride, point, |node, weight, _| add_weighted(&mut sums[node], weight, &masses));
            }
        });
        let nodes = &mut self.body.nodes;
        for (node, [mass, inertia, drag, _]) in sums.iter().enumerate() {
            let is_wet = nodes.is_active(node) && *mass > 0.0;
            nodes.water_mass[node] = if is_wet { *mass } else { 0.0 };
            nodes.per_water_mass[node] = if is_wet { 1.0 / mass } else { 0.0 };
            nodes.drag[node] = if is_wet { *drag } else { 0.0 };
            // A node without water has no say in it: any inertia will do.
            self.inertia[node] = if is_wet { *inertia } else { soil.water_density * nodes.volume[node] };
        }
    }

    /// Adds the force of the water's pressure to those of the skeleton's stress: to the mixture and to the water.
    pub fn map_forces(&mut self) {
        self.body.map_forces();
        if self.presses_by_cells {
            self.map_cell_forces();
            self.slivers.merge_forces(&mut self.body.nodes);
            return;
        }
        let stride = *self.body.grid.node_stride();
        let (water, nodes) = (&self.water, &mut self.body.nodes);
        let (mixture_force, water_force) = (&mut nodes.mixture_force, &mut nodes.water_force);
        with_stencils!(&self.basis, stencils => {
            for (point, pressure) in water.pressure.iter().enumerate() {
                let pressure = water.volume_inside(point) * pressure;
                stencils.visit(&stride, point, |node, _, gradient| {
                    for d in 0..D {
                        let force = pressure * gradient[d];
                        mixture_force[node][d] += force;
                        water_force[node][d] += force;
                    }
                });
            }
        });
        self.slivers.merge_forces(&mut self.body.nodes);
    }
}
