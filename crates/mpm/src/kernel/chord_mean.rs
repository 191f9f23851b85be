//! Drag of the nodes from the chord mean of the conductivity, docs/theory.md, Eq. 17.
//!
//! ```text
//! κ_i = Σ_p ∇N_ip V_p [Φ(J_c) − Φ(J_e)] / Σ_p ∇N_ip V_p [σ'(J_c) − σ'(J_e)]      dΦ = κ dσ', κ = k/J
//! D_i = n_i V_i γ_w/(κ_i J̄_i),   J̄_i = Σ N V/Σ N V_0
//! ```
//!
//! with the mean `J_c` of the cell of each point and `σ'(J_e) = −q`: a ratio of mapped forces, which needs
//! no neighbours and holds in a cell that the surface cuts. Between two full cells it is the chord of `Φ`
//! over `σ'`; at the drained surface the chord to the state in the end. In the plane the ratio is of the
//! vertical, along which alone the water of a column flows.

use crate::kernel::body::Body;

/// Share of its terms below which a difference of stresses says nothing: the soil is uniform there.
const UNIFORM: f64 = 1e-7;

impl<const D: usize> Body<D> {
    /// Gives every node the drag of the chord mean, in the place of the sum of its points' drags. Follows
    /// the mapping of the masses; nothing is allocated.
    pub(crate) fn take_chord_drag(&mut self) {
        let (soil, law) = (&self.material, self.material.law);
        let solid_fraction = 1.0 - soil.porosity;
        let end = law.strain_under(self.actions.surface.load / soil.oedometric_modulus());
        let (end_potential, end_stress) = (law.flow_potential(end), law.uniaxial_stress_ratio(end));
        let (nodes, points, cells) = (&mut self.nodes, &self.points, &self.cells);
        nodes.sums.chords.fill([0.0; 3]);
        let sums = &mut nodes.sums.chords;
        // Neighbouring points are of one cell as a rule, and its state is theirs together.
        let (mut known, mut potential, mut stress) = (None, 0.0, 0.0);
        for (point, cell) in cells.of_point.iter().enumerate() {
            if known != Some(*cell) {
                // n_c = 1 − (1 − n_0)/J_c
                let strain = solid_fraction / (1.0 - cells.porosity[*cell]) - 1.0;
                potential = law.flow_potential(strain) - end_potential;
                stress = law.uniaxial_stress_ratio(strain) - end_stress;
                known = Some(*cell);
            }
            // The volume that the stress fills: over it the gradients of a uniform stress cancel.
            let mut volume = points.volume(point) * points.stressed_share[point];
            if self.is_pushed_forward {
                // Gradients of an earlier configuration take the volume with them.
                volume *= points.inverse_deformation[point][D - 1][D - 1];
            }
            self.operators.basis.visit(self.grid.node_stride(), point, |node, _, gradient| {
                let weight = volume * gradient[D - 1];
                let [potentials, stresses, size] = &mut sums[node];
                *potentials += weight * potential;
                *stresses += weight * stress;
                *size += (weight * stress).abs();
            });
        }
        let unit_weight = soil.unit_weight_of_water();
        for node in 0..nodes.len() {
            if !nodes.is_active(node) {
                continue;
            }
            let [[grain_volume, pore_volume, ..]] = nodes.sums.masses[node];
            let volume_ratio = nodes.volume[node] * solid_fraction / grain_volume;
            let [potential, stress, size] = nodes.sums.chords[node];
            let chord = potential / stress;
            // Without a slope, or where the points do not determine one, the mobility is that of the node.
            let is_determined = stress.abs() > UNIFORM * size && chord > 0.0 && chord.is_finite();
            let mobility = if is_determined { chord } else { law.mobility_ratio(volume_ratio) };
            nodes.drag[node] =
                pore_volume * unit_weight / (soil.hydraulic_conductivity * mobility * volume_ratio);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::grid::integer_part;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::XIE_LEO;
    use oedometer_scenes::column::Column;
    use oedometer_soil::conductivity::ConductivityMean;
    use oedometer_soil::law::Law;
    use oedometer_soil::material::Material;

    const CELLS: usize = 5;
    const LOAD: f64 = 5e5;

    /// A column whose weights stay, with a volume ratio in each cell; in the plane one cell wide.
    fn body<const D: usize>(law: Law, ratios: [f64; CELLS]) -> Body<D> {
        let soil = Material {
            law,
            porosity: 0.6,
            conductivity_mean: ConductivityMean::Chord,
            ..Material::default()
        };
        let width = 1.0 / CELLS as f64;
        let column = Column { load: LOAD, dimensions: D, ..Column::default() }.with_extent(width);
        let method = Method::named("TL-GIMP-SRI-patch").expect("a method");
        let problem = column_problem::<D>(&XIE_LEO, &column, &soil, method, CELLS, 3).expect("a column");
        let mut body = Body::new(problem);
        for point in 0..body.points.len() {
            let height = body.points.initial_position[point][D - 1];
            let ratio = ratios[integer_part(height * CELLS as f64)];
            body.points.volume_ratio[point] = ratio;
            let back = &mut body.points.inverse_deformation[point];
            back[D - 1][D - 1] = 1.0 / ratio;
        }
        body.follow_points();
        body
    }

    /// `κ` over `k_0` at a node so many cells over the base.
    fn mobility<const D: usize>(body: &Body<D>, up: usize) -> f64 {
        let (soil, nodes) = (&body.material, &body.nodes);
        let mut place = [2; D];
        place[D - 1] += up;
        let node = body.grid.flat_node(&place);
        let pores = nodes.porosity[node] * nodes.volume[node];
        let volume_ratio = (1.0 - soil.porosity) / (1.0 - nodes.porosity[node]);
        let conductivity = pores * soil.unit_weight_of_water() / nodes.drag[node];
        conductivity / soil.hydraulic_conductivity / volume_ratio
    }

    #[test]
    fn the_mean_is_the_chord_of_two_points_between_full_cells_and_that_to_the_end_at_the_surface() {
        let ratios = [0.95, 0.9, 0.8, 0.78, 0.7];
        let load = LOAD / Material::default().oedometric_modulus();
        for (law, potential, stress, end) in [
            (Law::LogLinear, (|j| j) as fn(f64) -> f64, (|j| j.ln()) as fn(f64) -> f64, (-load).exp()),
            (Law::PorosityDependent, |j| j.ln(), |j| 1.0 - 1.0 / j, 1.0 / (1.0 + load)),
        ] {
            let (body, plane) = (body::<1>(law, ratios), body::<2>(law, ratios));
            for up in 1..CELLS {
                let (a, b) = (ratios[up - 1], ratios[up]);
                let chord = (potential(b) - potential(a)) / (stress(b) - stress(a));
                for got in [mobility(&body, up), mobility(&plane, up)] {
                    assert!((got / chord - 1.0).abs() < 1e-10, "{law:?} node {up}");
                }
            }
            let surface = ratios[CELLS - 1];
            let chord = (potential(end) - potential(surface)) / (stress(end) - stress(surface));
            for got in [mobility(&body, CELLS), mobility(&plane, CELLS)] {
                assert!((got / chord - 1.0).abs() < 1e-10, "{law:?} at the surface");
            }
        }
    }

    #[test]
    fn a_uniform_soil_has_its_own_conductivity_inside() {
        let body = body::<1>(Law::LogLinear, [0.8; CELLS]);
        for up in 1..CELLS {
            assert!((mobility(&body, up) - 0.8).abs() < 1e-12, "{}", mobility(&body, up));
        }
    }
}
